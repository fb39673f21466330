//! Curves of dots: values over a time or a distance, with a stroke that identifies each without its colour.

use super::raster::Raster;
use super::theme::Charset;

/// The stroke of a curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stroke {
    Solid,
    Dashed,
    Dotted,
}

impl Stroke {
    /// All strokes, in the order in which curves are drawn over each other: a sparse one leaves the one below it
    /// visible.
    pub(super) const BY_DENSITY: [Self; 3] = [Self::Solid, Self::Dashed, Self::Dotted];

    /// Returns the sign of the stroke in a legend.
    pub(super) fn sign(self, charset: Charset) -> &'static str {
        match (charset, self) {
            (Charset::Unicode, Self::Solid) => "──",
            (Charset::Unicode, Self::Dashed) => "╌╌",
            (Charset::Unicode, Self::Dotted) => "┈┈",
            (Charset::Ascii, Self::Solid) => "**",
            (Charset::Ascii, Self::Dashed) => "++",
            (Charset::Ascii, Self::Dotted) => "..",
        }
    }

    /// Returns the character of the stroke in ASCII.
    pub(super) fn plain(self) -> char {
        match self {
            Self::Solid => '*',
            Self::Dashed => '+',
            Self::Dotted => '.',
        }
    }

    fn is_drawn(self, column: usize) -> bool {
        match self {
            Self::Solid => true,
            Self::Dashed => column % 8 < 4,
            Self::Dotted => column.is_multiple_of(4),
        }
    }
}

/// The values at a time or a distance: the least and the greatest. They are `None` where nothing is known.
pub(super) type Point = (f64, Option<(f64, f64)>);

/// The limits of a picture: times or distances from left to right, and values from bottom to top.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    pub(super) along: (f64, f64),
    pub(super) values: (f64, f64),
}

/// Sets the dots of a curve. The points are in order.
pub(super) fn draw(raster: &mut Raster, limits: Limits, stroke: Stroke, points: &[Point]) {
    let (columns, rows) = raster.dots();
    let last_row = rows.saturating_sub(1) as f64;
    let (low, high) = limits.values;
    let row = |value: f64| (high - value) / (high - low) * last_row;
    for Column { column, least, greatest } in filled(points, limits.along, columns) {
        if stroke.is_drawn(column) {
            raster.line((column as f64, row(greatest)), (column as f64, row(least)));
        }
    }
}

/// A column of dots, with the least and the greatest value in it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Column {
    column: usize,
    least: f64,
    greatest: f64,
}

/// Returns the columns of a curve that have dots, each connected to the one before it unless there is a gap between
/// the points.
fn filled(points: &[Point], (from, to): (f64, f64), columns: usize) -> Vec<Column> {
    let last_column = columns.saturating_sub(1) as f64;
    let column_of = |along: f64| ((along - from) / (to - from) * last_column).round() as usize;
    let mut filled: Vec<Column> = Vec::new();
    // The newest column, and its last value.
    let mut open: Option<(Column, f64)> = None;
    for &(along, values) in points {
        let Some((least, greatest)) = values else {
            filled.extend(open.take().map(|(column, _)| column));
            continue;
        };
        let (column, middle) = (column_of(along), f64::midpoint(least, greatest));
        let mut new = Column { column, least, greatest };
        if let Some((before, last)) = open.take() {
            if before.column == column {
                new.least = least.min(before.least).min(last);
                new.greatest = greatest.max(before.greatest).max(last);
            } else {
                filled.push(before);
                // Points may be several columns apart.
                let steps = column.saturating_sub(before.column).clamp(1, 2 * columns);
                let mix = |step: usize| last + (middle - last) * step as f64 / steps as f64;
                filled.extend((1..steps).map(|step| {
                    let (a, b) = (mix(step - 1), mix(step));
                    Column { column: before.column + step, least: a.min(b), greatest: a.max(b) }
                }));
                new.least = least.min(mix(steps - 1));
                new.greatest = greatest.max(mix(steps - 1));
            }
        }
        open = Some((new, middle));
    }
    filled.extend(open.map(|(column, _)| column));
    filled
}

#[cfg(test)]
mod tests {
    use super::*;
    use ratatui::buffer::Buffer;
    use ratatui::layout::Rect;
    use ratatui::style::Style;

    #[test]
    fn each_column_between_two_points_is_filled_and_a_gap_is_not() {
        let at = |at: f64| (at, Some((at, at)));
        let filled = filled(&[at(0.0), at(5.0), (6.0, None), at(9.0)], (0.0, 9.0), 10);
        let columns: Vec<_> = filled.iter().map(|column| column.column).collect();
        assert_eq!(columns, [0, 1, 2, 3, 4, 5, 9]);
    }

    #[test]
    fn the_extremes_of_a_step_are_drawn() {
        let points = [(0.0, Some((0.0, 0.0))), (1.0, Some((-3.0, 7.0))), (1.01, Some((1.0, 1.0)))];
        assert_eq!(filled(&points, (0.0, 9.0), 10)[1], Column { column: 1, least: -3.0, greatest: 7.0 });
    }

    #[test]
    fn a_steep_curve_has_no_gap() {
        let points = [(0.0, Some((0.0, 0.0))), (2.0, Some((10.0, 10.0)))];
        let spans: Vec<_> = filled(&points, (0.0, 9.0), 10).iter().map(|c| (c.least, c.greatest)).collect();
        assert_eq!(spans, [(0.0, 0.0), (0.0, 5.0), (5.0, 10.0)]);
    }

    #[test]
    fn a_dotted_curve_leaves_the_solid_one_below_it_visible() {
        let area = Rect::new(0, 0, 4, 1);
        let limits = Limits { along: (0.0, 1.0), values: (-1.0, 1.0) };
        let mut buffer = Buffer::empty(area);
        let points = [(0.0, Some((0.0, 0.0))), (1.0, Some((0.0, 0.0)))];
        for (stroke, bold) in [(Stroke::Solid, false), (Stroke::Dotted, true)] {
            let mut raster = Raster::new(area);
            draw(&mut raster, limits, stroke, &points);
            let style = if bold { Style::new().bold() } else { Style::new() };
            raster.add(style, Charset::Unicode, stroke.plain(), &mut buffer);
        }
        let row: String = (0..4).map(|x| buffer[(x, 0)].symbol()).collect();
        assert_eq!(row, "⠤⠤⠤⠤");
        let is_bold = |x: u16| buffer[(x, 0)].modifier.contains(ratatui::style::Modifier::BOLD);
        assert_eq!([0, 1, 2, 3].map(is_bold), [true, false, true, false]);
    }
}
