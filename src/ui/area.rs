//! Text in the rows of an area.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};

use super::drawing;
use super::formatting::cut;
use super::theme::{Role, Theme};

/// Returns a span in the style of a role.
pub(super) fn span(theme: &Theme, role: Role, text: impl Into<String>) -> Span<'static> {
    Span::styled(text.into(), theme.style(role))
}

/// Writes `text` in a row of the area, cut to its width.
pub(super) fn row(buffer: &mut Buffer, area: Rect, row: u16, theme: &Theme, role: Role, text: &str) {
    if row < area.height {
        let text = cut(text, usize::from(area.width));
        drawing::text(buffer, area.x, area.y + row, text, theme.style(role));
    }
}

/// Writes a styled line in a row of the area.
pub(super) fn line(buffer: &mut Buffer, area: Rect, row: u16, line: &Line<'_>) {
    if row < area.height {
        drawing::line(buffer, area.x, area.y + row, line, area.width);
    }
}
