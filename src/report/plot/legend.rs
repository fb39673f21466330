//! The names of the lines of a picture.

use super::canvas::{Anchor, Area, Height, stroke, text, text_width};
use super::{Colour, Point};

/// Height of a row, px.
pub(super) const ROW: f64 = 18.0;
/// Size of the names, px.
const SIZE: f64 = 12.0;
/// Length of the sample of a line, px.
const SAMPLE: f64 = 20.0;
/// The gap after a sample and after a name, px.
const GAPS: (f64, f64) = (6.0, 16.0);

/// The names of a legend in rows.
#[derive(Debug, Clone)]
pub(super) struct Legend {
    /// The left end of each entry and the number of its row.
    entries: Vec<(f64, usize, Colour, f64, String)>,
    rows: usize,
}

impl Legend {
    /// Places these names with the widths of their lines in rows of this width, px.
    pub(super) fn new(names: &[(Colour, f64, String)], width: f64) -> Self {
        let (mut x, mut row) = (0.0, 0);
        let mut entries = Vec::new();
        for (colour, stroke, name) in names {
            let length = SAMPLE + GAPS.0 + text_width(name, SIZE);
            if x > 0.0 && x + length > width {
                (x, row) = (0.0, row + 1);
            }
            entries.push((x, row, *colour, *stroke, name.clone()));
            x += length + GAPS.1;
        }
        let rows = if entries.is_empty() { 0 } else { row + 1 };
        Self { entries, rows }
    }

    /// Returns the height, px.
    pub(super) fn height(&self) -> f64 {
        self.rows as f64 * ROW
    }

    /// Draws the names from this corner on, px.
    pub(super) fn draw(&self, area: &mut Area, (left, top): Point) {
        for (x, row, colour, width, name) in &self.entries {
            let (x, y) = (left + x, top + (*row as f64 + 0.5) * ROW);
            area.line(&[(x, y), (x + SAMPLE, y)], &stroke(*colour, *width));
            let style = text(SIZE, Colour::Ink, Anchor::Start, Height::Middle);
            area.text(name, (x + SAMPLE + GAPS.0, y), &style);
        }
    }
}
