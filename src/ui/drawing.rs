//! Writes text into a buffer. Text outside the buffer is left out, because a window may be smaller than anything in it.
#![allow(clippy::disallowed_methods, reason = "this is the one place that checks the cell before it writes")]

use std::borrow::Cow;

use ratatui::buffer::Buffer;
use ratatui::style::Style;
use ratatui::text::Line;

/// Writes text starting at a cell.
pub(super) fn text(buffer: &mut Buffer, x: u16, y: u16, text: impl AsRef<str>, style: Style) {
    text_within(buffer, x, y, text, usize::MAX, style);
}

/// Writes at most `width` columns of a text starting at a cell. Returns the column after it.
pub(super) fn text_within(
    buffer: &mut Buffer,
    x: u16,
    y: u16,
    text: impl AsRef<str>,
    width: usize,
    style: Style,
) -> u16 {
    if !buffer.area.contains((x, y).into()) {
        return x;
    }
    buffer.set_stringn(x, y, without_emoji(text.as_ref()), width, style).0
}

/// Writes at most `width` columns of a styled line starting at a cell.
pub(super) fn line(buffer: &mut Buffer, x: u16, y: u16, line: &Line<'_>, width: u16) {
    if !buffer.area.contains((x, y).into()) {
        return;
    }
    if line.spans.iter().all(|span| matches!(without_emoji(&span.content), Cow::Borrowed(_))) {
        buffer.set_line(x, y, line, width);
        return;
    }
    let mut plain = line.clone();
    for span in &mut plain.spans {
        span.content = without_emoji(&span.content).into_owned().into();
    }
    buffer.set_line(x, y, &plain, width);
}

/// Returns a text with a question mark for each emoji. Terminals disagree about the width of emoji, above all of joined
/// ones, and a wrong width shifts the rest of the row.
fn without_emoji(text: &str) -> Cow<'_, str> {
    let is_part =
        |c: char| matches!(c, '\u{200d}' | '\u{20e3}' | '\u{fe00}'..='\u{fe0f}' | '\u{1f3fb}'..='\u{1f3ff}');
    let is_emoji = |c: char| matches!(c, '\u{1f000}'..='\u{1faff}');
    // Scripts of India join letters with the same character. Signs such as the heart are emoji only after a joiner.
    let is_joinable = |c: char| is_emoji(c) || matches!(c, '\u{2190}'..='\u{2bff}');
    if !text.chars().any(|c| is_part(c) || is_emoji(c)) {
        return Cow::Borrowed(text);
    }
    let mut plain = String::with_capacity(text.len());
    let mut is_joined = false;
    for c in text.chars() {
        let goes_on = std::mem::replace(&mut is_joined, c == '\u{200d}');
        if !(is_part(c) || goes_on && is_joinable(c)) {
            plain.push(if is_emoji(c) { '?' } else { c });
        }
    }
    Cow::Owned(plain)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ratatui::layout::Rect;

    #[test]
    fn an_emoji_in_a_name_is_one_question_mark_however_it_is_joined() {
        for (name, drawn) in [
            ("👨\u{200d}👩\u{200d}👧 plan.toml", "? plan.toml"),
            ("a👍\u{1f3fd}b", "a?b"),
            ("👨\u{200d}⚕\u{fe0f} plan", "? plan"),
            ("क्\u{200d}ष", "क्ष"),
            ("ශ්\u{200d}රී", "ශ්රී"),
            ("🚁🚁", "??"),
            ("✓ ⌂ ▸ äé名", "✓ ⌂ ▸ äé名"),
        ] {
            assert_eq!(without_emoji(name), drawn);
            let mut buffer = Buffer::empty(Rect::new(0, 0, 20, 1));
            line(&mut buffer, 0, 0, &Line::from(name), 20);
            assert!(drawn.starts_with(buffer[(0, 0)].symbol()), "{drawn}: {}", buffer[(0, 0)].symbol());
        }
    }

    #[test]
    fn text_outside_the_buffer_is_left_out() {
        let area = Rect::new(2, 3, 4, 2);
        let mut buffer = Buffer::empty(area);
        for (x, y) in [(0, 3), (2, 2), (6, 3), (2, 5), (u16::MAX, u16::MAX)] {
            text(&mut buffer, x, y, "text", Style::new());
            line(&mut buffer, x, y, &Line::from("text"), 4);
        }
        assert_eq!(buffer, Buffer::empty(area));
        assert_eq!(text_within(&mut buffer, 4, 3, "text", 9, Style::new()), 6);
        line(&mut buffer, 3, 4, &Line::from("line"), 2);
        let row = |y| (2..6).map(|x| buffer[(x, y)].symbol()).collect::<String>();
        assert_eq!([row(3), row(4)], ["  te", " li "]);
    }
}
