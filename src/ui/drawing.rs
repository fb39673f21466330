//! Writes text into a buffer. Text outside the buffer is left out, because a window may be smaller than anything in it.
#![allow(clippy::disallowed_methods, reason = "this is the one place that checks the cell before it writes")]

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
    buffer.set_stringn(x, y, text, width, style).0
}

/// Writes at most `width` columns of a styled line starting at a cell.
pub(super) fn line(buffer: &mut Buffer, x: u16, y: u16, line: &Line<'_>, width: u16) {
    if buffer.area.contains((x, y).into()) {
        buffer.set_line(x, y, line, width);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ratatui::layout::Rect;

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
