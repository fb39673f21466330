//! The panels, one file each: `draw(state, area, buffer)` fills the inside, `title(state)` stands on the frame.

pub mod cli;
pub mod help;
pub mod log;
pub mod machine;
pub mod map;
pub mod plan;
pub mod rc;
pub mod state;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};

use super::quantity::cut;
use super::theme::{Role, Theme};

/// A span in a role.
pub fn span(theme: &Theme, role: Role, text: impl Into<String>) -> Span<'static> {
    Span::styled(text.into(), theme.style(role))
}

/// Writes `text` at a row of the area, cut to its width.
pub fn row(buffer: &mut Buffer, area: Rect, row: u16, theme: &Theme, role: Role, text: &str) {
    if row < area.height {
        let text = cut(text, usize::from(area.width));
        buffer.set_string(area.x, area.y + row, text, theme.style(role));
    }
}

/// Writes a styled line at a row of the area.
pub fn line(buffer: &mut Buffer, area: Rect, row: u16, line: &Line<'_>) {
    if row < area.height {
        buffer.set_line(area.x, area.y + row, line, area.width);
    }
}

/// `text` in lines of at most `width` columns, broken at blanks; a word that is longer is broken anywhere.
pub fn wrapped(text: &str, width: usize) -> Vec<String> {
    use unicode_width::UnicodeWidthStr as _;
    let mut lines: Vec<String> = Vec::new();
    let mut current = String::new();
    for word in text.split_whitespace() {
        if !current.is_empty() && current.width() + 1 + word.width() > width {
            lines.push(std::mem::take(&mut current));
        }
        if !current.is_empty() {
            current.push(' ');
        }
        for c in word.chars() {
            if width > 0 && current.width() >= width {
                lines.push(std::mem::take(&mut current));
            }
            current.push(c);
        }
    }
    if !current.is_empty() {
        lines.push(current);
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_wraps_at_blanks_and_never_exceeds_the_width() {
        assert_eq!(wrapped("one two three", 7), ["one two", "three"]);
        assert_eq!(wrapped("abcdefgh", 3), ["abc", "def", "gh"]);
        assert!(wrapped("", 3).is_empty());
    }
}
