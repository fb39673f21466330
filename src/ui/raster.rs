//! The dots of lines, one bit each, in the cells of a part of the screen.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

use crate::ui::theme::Charset;

/// The dots of a cell in columns and rows.
const COLUMNS: usize = 2;
const ROWS: usize = 4;
/// The bits of a Braille character, from the top left by rows.
const BITS: [[u8; COLUMNS]; ROWS] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];
/// The Braille character without dots.
const BLANK: u32 = 0x2800;
/// The most dots that are set, so that a hostile file cannot stop the screen. They fill a window of 200x60 five times.
const MAX_DOTS: usize = 500_000;

/// The dots of a window.
pub(in crate::ui) struct Raster {
    area: Rect,
    cells: Vec<u8>,
    /// The last column and the last row of dots.
    limits: (f64, f64),
    /// The number of dots that may still be set.
    left: usize,
}

impl Raster {
    pub(in crate::ui) fn new(area: Rect) -> Self {
        let cells = vec![0; usize::from(area.width) * usize::from(area.height)];
        let last = |cells: u16, dots: usize| (usize::from(cells) * dots).saturating_sub(1) as f64;
        let limits = (last(area.width, COLUMNS), last(area.height, ROWS));
        Self { area, cells, limits, left: MAX_DOTS }
    }

    /// Returns the number of columns and of rows of dots.
    pub(in crate::ui) fn dots(&self) -> (usize, usize) {
        (usize::from(self.area.width) * COLUMNS, usize::from(self.area.height) * ROWS)
    }

    /// Sets the dots of a line between two places, in dots from the middle of the top left dot.
    pub(in crate::ui) fn line(&mut self, from: (f64, f64), to: (f64, f64)) {
        if self.left == 0 || self.cells.is_empty() {
            return;
        }
        let limits = self.limits;
        let is_inside = |(x, y): (f64, f64)| x >= 0.0 && y >= 0.0 && x <= limits.0 && y <= limits.1;
        // Most lines of a backdrop are short and inside.
        let (from, to) = if is_inside(from) && is_inside(to) {
            (from, to)
        } else if let Some(ends) = clipped(from, to, limits) {
            ends
        } else {
            return;
        };
        let (x, y) = nearest(from);
        let end = nearest(to);
        self.set(x, y);
        let steps = x.abs_diff(end.0).max(y.abs_diff(end.1));
        if steps > 1 {
            let step = |from: usize, to: usize| (to as f64 - from as f64) / steps as f64;
            let (dx, dy) = (step(x, end.0), step(y, end.1));
            for done in 1..steps {
                let at = |from: usize, by: f64| (from as f64 + by * done as f64 + 0.5) as usize;
                self.set(at(x, dx), at(y, dy));
            }
        }
        self.set(end.0, end.1);
        self.left = self.left.saturating_sub(steps + 1);
    }

    fn set(&mut self, x: usize, y: usize) {
        let cell = y / ROWS * usize::from(self.area.width) + x / COLUMNS;
        if let Some(cell) = self.cells.get_mut(cell) {
            *cell |= BITS[y % ROWS][x % COLUMNS];
        }
    }

    /// Sets the nearest dot to a place.
    pub(in crate::ui) fn dot(&mut self, place: (f64, f64)) {
        self.line(place, place);
    }

    /// Writes the cells that have dots, over everything.
    pub(in crate::ui) fn write(&self, style: Style, charset: Charset, buffer: &mut Buffer) {
        let plain = (charset == Charset::Ascii).then_some('.');
        self.cells(|place, bits| {
            if let Some(cell) = buffer.cell_mut(place) {
                cell.set_char(plain.unwrap_or(braille(bits))).set_style(style);
            }
        });
    }

    /// Adds the dots to those that a cell has already. `plain` is the character of a cell in ASCII.
    pub(in crate::ui) fn add(&self, style: Style, charset: Charset, plain: char, buffer: &mut Buffer) {
        self.cells(|place, bits| {
            let Some(cell) = buffer.cell_mut(place) else { return };
            let there = cell.symbol().chars().next().map_or(0, |there| u32::from(there).wrapping_sub(BLANK));
            let symbol = match charset {
                Charset::Unicode => braille(bits | u8::try_from(there).unwrap_or(0)),
                Charset::Ascii => plain,
            };
            cell.set_char(symbol).set_style(style);
        });
    }

    /// Calls `write` with the screen cell and the bits of each cell that has dots.
    fn cells(&self, mut write: impl FnMut((u16, u16), u8)) {
        let width = usize::from(self.area.width);
        for (index, &bits) in self.cells.iter().enumerate().filter(|(_, bits)| **bits != 0) {
            write((self.area.x + (index % width) as u16, self.area.y + (index / width) as u16), bits);
        }
    }
}

/// Returns the Braille character with these dots.
fn braille(bits: u8) -> char {
    char::from_u32(BLANK + u32::from(bits)).unwrap_or(' ')
}

/// Returns the dot nearest to a place inside.
fn nearest((x, y): (f64, f64)) -> (usize, usize) {
    ((x + 0.5) as usize, (y + 0.5) as usize)
}

/// Returns the part of a line from (0, 0) to `limits`, by the method of Liang and Barsky. `None` if it is outside.
fn clipped(from: (f64, f64), to: (f64, f64), limits: (f64, f64)) -> Option<((f64, f64), (f64, f64))> {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    if !(dx.is_finite() && dy.is_finite() && from.0.is_finite() && from.1.is_finite()) {
        return None;
    }
    let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
    for (direction, inside) in
        [(-dx, from.0), (dx, limits.0 - from.0), (-dy, from.1), (dy, limits.1 - from.1)]
    {
        if direction == 0.0 {
            if inside < 0.0 {
                return None;
            }
        } else if direction < 0.0 {
            enters = enters.max(inside / direction);
        } else {
            leaves = leaves.min(inside / direction);
        }
    }
    let at = |t: f64| ((from.0 + t * dx).clamp(0.0, limits.0), (from.1 + t * dy).clamp(0.0, limits.1));
    (enters <= leaves).then(|| (at(enters), at(leaves)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn dots(raster: &Raster) -> usize {
        raster.cells.iter().map(|bits| bits.count_ones() as usize).sum()
    }

    #[test]
    fn a_line_across_the_window_has_a_dot_in_every_column() {
        let mut raster = Raster::new(Rect::new(3, 2, 10, 5));
        raster.line((-50.0, 10.0), (70.0, 10.0));
        assert_eq!(dots(&raster), 20);
        raster.line((-50.0, 30.0), (70.0, 30.0));
        assert_eq!(dots(&raster), 20, "below the window");
        raster.line((f64::NAN, 1.0), (2.0, f64::INFINITY));
        assert_eq!(dots(&raster), 20);
        let mut buffer = Buffer::empty(Rect::new(0, 0, 20, 10));
        raster.write(Style::new(), Charset::Ascii, &mut buffer);
        let row: String = (0..20).map(|x| buffer[(x, 4)].symbol()).collect();
        assert_eq!(row, "   ..........       ");
    }

    #[test]
    fn added_lines_leave_the_dots_below_them() {
        let area = Rect::new(0, 0, 1, 1);
        let mut buffer = Buffer::empty(area);
        for (place, symbol) in [((0.0, 0.0), "⠁"), ((1.0, 3.0), "⢁")] {
            let mut raster = Raster::new(area);
            raster.dot(place);
            raster.add(Style::new(), Charset::Unicode, '*', &mut buffer);
            assert_eq!(buffer[(0, 0)].symbol(), symbol);
        }
        let mut raster = Raster::new(area);
        raster.dot((0.0, 0.0));
        raster.add(Style::new(), Charset::Ascii, '*', &mut buffer);
        assert_eq!(buffer[(0, 0)].symbol(), "*");
    }

    #[test]
    fn an_empty_window_takes_lines() {
        let mut raster = Raster::new(Rect::new(0, 0, 0, 4));
        raster.line((0.0, 0.0), (5.0, 5.0));
        assert_eq!(dots(&raster), 0);
    }

    proptest! {
        #[test]
        fn a_clipped_line_is_the_part_inside(
            from in (-300.0..300.0_f64, -300.0..300.0_f64), to in (-300.0..300.0_f64, -300.0..300.0_f64),
            limits in (1.0..200.0_f64, 1.0..200.0_f64),
        ) {
            let is_inside = |(x, y): (f64, f64)| (0.0..=limits.0).contains(&x) && (0.0..=limits.1).contains(&y);
            let sample = |t: f64| (from.0 + t * (to.0 - from.0), from.1 + t * (to.1 - from.1));
            match clipped(from, to, limits) {
                None => prop_assert!((0..=100).all(|step| !is_inside(sample(f64::from(step) / 100.0)))),
                Some((a, b)) => {
                    prop_assert!(is_inside(a) && is_inside(b));
                    let length = (to.0 - from.0).hypot(to.1 - from.1).max(1e-9);
                    for place in [a, b] {
                        let off = (to.0 - from.0) * (place.1 - from.1) - (to.1 - from.1) * (place.0 - from.0);
                        prop_assert!((off / length).abs() < 1e-6);
                    }
                    // All samples inside are between the two ends.
                    let along = |(x, y): (f64, f64)| {
                        ((x - from.0) * (to.0 - from.0) + (y - from.1) * (to.1 - from.1)) / length
                    };
                    for step in 0..=100 {
                        let place = sample(f64::from(step) / 100.0);
                        let between = along(a) - 1e-6 <= along(place) && along(place) <= along(b) + 1e-6;
                        prop_assert!(!is_inside(place) || between);
                    }
                }
            }
        }

        #[test]
        fn the_dots_of_a_line_are_next_to_each_other(
            from in (0.0..79.0_f64, 0.0..79.0_f64), to in (0.0..79.0_f64, 0.0..79.0_f64),
        ) {
            let mut raster = Raster::new(Rect::new(0, 0, 40, 20));
            raster.line(from, to);
            let (dx, dy) = ((to.0.round() - from.0.round()).abs(), (to.1.round() - from.1.round()).abs());
            prop_assert_eq!(dots(&raster), dx.max(dy) as usize + 1);
        }
    }
}
