//! The panels as lines of text, for use without a screen.

use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;

use crate::ui::ascii;
use crate::ui::formatting::{fixed, signed};
use crate::ui::shared::Shared;
use crate::ui::theme::Charset;

/// The width of a drawn line.
pub(super) const WIDTH: u16 = 120;

/// Returns the text that `draw` draws into this many rows, without empty lines.
pub(in crate::ui) fn drawn(state: &Shared, rows: u16, draw: impl FnOnce(Rect, &mut Buffer)) -> Vec<String> {
    let area = Rect::new(0, 0, WIDTH, rows);
    let mut buffer = Buffer::empty(area);
    draw(area, &mut buffer);
    if state.theme.charset == Charset::Ascii {
        ascii::replace(&mut buffer);
    }
    let cells = buffer.content.chunks(usize::from(WIDTH));
    let lines = cells.map(|row| row.iter().map(Cell::symbol).collect::<String>());
    lines.map(|line| line.trim_end().to_owned()).filter(|line| !line.is_empty()).collect()
}

/// The width for which a number is formatted before its blanks are left out.
const NUMBER: usize = 24;

/// Returns a number without blanks; a dash if it is unknown.
pub(in crate::ui) fn number(value: Option<f64>, decimals: usize) -> String {
    fixed(value, NUMBER, decimals).trim().to_owned()
}

/// Returns a number with its sign and without blanks; a dash if it is unknown.
pub(in crate::ui) fn signed_number(value: Option<f64>, decimals: usize) -> String {
    signed(value, NUMBER, decimals).trim().to_owned()
}
