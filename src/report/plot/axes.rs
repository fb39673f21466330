//! The field of a chart with its axes.

use super::canvas::{Anchor, Area, Height, stroke, text};
use super::{Colour, Point, range};

/// Width of a chart, px.
pub(super) const WIDTH: f64 = 560.0;
/// Width left of the axis, px.
pub(super) const LEFT: f64 = 48.0;
/// Width of the field, px.
pub(super) const ACROSS: f64 = WIDTH - LEFT - 14.0;
/// Height below the axis, px.
pub(super) const BELOW: f64 = 22.0;
/// Size of numbers, px.
pub(super) const SMALL: f64 = 11.0;
/// Length of the line at a number, and the distance of the number from the axis, px.
const TICK: (f64, f64) = (3.0, 6.0);

/// The field of a chart.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axes {
    /// The first and the last value to the right.
    pub(super) x: (f64, f64),
    /// The lowest and the highest value.
    pub(super) y: (f64, f64),
    /// The upper edge, px.
    pub(super) top: f64,
    /// Height of the field, px.
    pub(super) height: f64,
}

impl Axes {
    /// Converts values to px to the right and down. A value outside moves to the edge.
    pub(super) fn px(&self, (x, y): Point) -> Point {
        let share = |value: f64, (low, high): Point| (value.max(low).min(high) - low) / (high - low);
        (LEFT + share(x, self.x) * ACROSS, self.top + (1.0 - share(y, self.y)) * self.height)
    }

    /// Draws the axis below with at most so many numbers.
    pub(super) fn below(&self, area: &mut Area, most: usize) {
        let y = self.top + self.height;
        let style = text(SMALL, Colour::Label, Anchor::Middle, Height::Top);
        area.line(&[(LEFT, y), (LEFT + ACROSS, y)], &stroke(Colour::Axis, 1.0));
        for value in range::ticks(self.x, most) {
            let (x, _) = self.px((value, self.y.0));
            area.line(&[(x, y), (x, y + TICK.0)], &stroke(Colour::Axis, 1.0));
            area.text(&number(value), (x, y + TICK.1), &style);
        }
    }

    /// Draws a grid and both axes with at most so many numbers. `unit` follows those at the left.
    pub(super) fn draw(&self, area: &mut Area, (across, up): (usize, usize), unit: &str) {
        let (top, bottom, right) = (self.top, self.top + self.height, LEFT + ACROSS);
        for value in range::ticks(self.x, across) {
            let (x, _) = self.px((value, self.y.0));
            area.line(&[(x, bottom), (x, top)], &stroke(Colour::Grid, 1.0));
        }
        let rows = range::ticks(self.y, up).into_iter().map(|value| (value, self.px((self.x.0, value)).1));
        for (_, y) in rows.clone() {
            area.line(&[(LEFT, y), (right, y)], &stroke(Colour::Grid, 1.0));
        }
        let style = text(SMALL, Colour::Label, Anchor::End, Height::Middle);
        area.line(&[(LEFT, top), (LEFT, bottom)], &stroke(Colour::Axis, 1.0));
        for (value, y) in rows {
            area.line(&[(LEFT - TICK.0, y), (LEFT, y)], &stroke(Colour::Axis, 1.0));
            area.text(&format!("{}{unit}", number(value)), (LEFT - TICK.1, y), &style);
        }
        self.below(area, across);
    }
}

/// Returns a number at an axis, with the decimals that it needs.
fn number(value: f64) -> String {
    let rounded = (value * 1000.0).round() / 1000.0 + 0.0;
    rounded.to_string()
}
