//! The flown track as a canvas shape: a line through thousands of points.

use ratatui::style::Color;
use ratatui::widgets::canvas::{Line, Painter, Shape};

use crate::ui::acts::viewport::Viewport;
use crate::ui::model::map_point::MapPoint;
use crate::ui::model::track::TrackPoint;

/// Points closer than this to the last drawn one are left out, dots.
const NEAR_DOTS: f64 = 0.7;

/// A line through the points. Dense points are set as dots, without lines between them.
pub(super) struct TrackLine<'a> {
    pub(super) points: &'a [TrackPoint],
    pub(super) view: Viewport,
    pub(super) colour: Color,
    /// The width of a dot, m.
    pub(super) dot_m: f64,
}

impl Shape for TrackLine<'_> {
    fn draw(&self, painter: &mut Painter<'_, '_>) {
        let Some((first, rest)) = self.points.split_first() else { return };
        let near_m2 = (NEAR_DOTS * self.dot_m).powi(2);
        let mut from = first;
        let place = |point: &TrackPoint| self.view.relative(MapPoint::new(point.n, point.e));
        let dot = |painter: &Painter<'_, '_>, point: &TrackPoint| {
            let place = place(point);
            painter.get_point(place.e, place.n)
        };
        let mut from_dot = dot(painter, first);
        if let Some((x, y)) = from_dot {
            painter.paint(x, y, self.colour);
        }
        let mut rest = rest.iter().peekable();
        while let Some(to) = rest.next() {
            let (north_m, east_m) = (to.n - from.n, to.e - from.e);
            if north_m * north_m + east_m * east_m < near_m2 && rest.peek().is_some() {
                continue;
            }
            let to_dot = dot(painter, to);
            match (from_dot, to_dot) {
                (Some(a), Some(b)) if a.0.abs_diff(b.0) <= 1 && a.1.abs_diff(b.1) <= 1 => {
                    painter.paint(b.0, b.1, self.colour);
                }
                // Clipped at the edge of the window.
                _ => {
                    let (a, b) = (place(from), place(to));
                    Line::new(a.e, a.n, b.e, b.n, self.colour).draw(painter);
                }
            }
            (from, from_dot) = (to, to_dot);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ratatui::buffer::Buffer;
    use ratatui::layout::Rect;
    use ratatui::widgets::Widget as _;
    use ratatui::widgets::canvas::Canvas;

    /// Returns the Braille rows of a window of 40 m by 40 m.
    fn drawn(shape: &impl Shape) -> Buffer {
        let area = Rect::new(0, 0, 20, 10);
        let mut buffer = Buffer::empty(area);
        let canvas = Canvas::default().x_bounds([-20.0, 20.0]).y_bounds([-20.0, 20.0]);
        canvas.paint(|context| context.draw(shape)).render(area, &mut buffer);
        buffer
    }

    fn track(points: &[TrackPoint]) -> Buffer {
        let view =
            Viewport { area: Rect::new(0, 0, 20, 10), centre: MapPoint::default(), scale: 2.0, up_rad: 0.0 };
        drawn(&TrackLine { points, view, colour: Color::Green, dot_m: 1.0 })
    }

    fn at(n: f64, e: f64) -> TrackPoint {
        TrackPoint { n, e, engaged: true, ..TrackPoint::default() }
    }

    #[test]
    fn dense_and_sparse_points_make_the_same_line() {
        let dense: Vec<TrackPoint> = (0..=40_000).map(|k| at(3.0, -20.0 + f64::from(k) / 1000.0)).collect();
        let sparse = [at(3.0, -20.0), at(3.0, 20.0)];
        assert_eq!(track(&dense), track(&sparse));
        let line = Line::new(-20.0, 3.0, 20.0, 3.0, Color::Green);
        assert_eq!(track(&sparse), drawn(&line));
    }

    #[test]
    fn a_line_between_two_places_outside_crosses_the_window() {
        let crossing = track(&[at(-50.0, 5.0), at(50.0, 5.0)]);
        assert_eq!(crossing, drawn(&Line::new(5.0, -50.0, 5.0, 50.0, Color::Green)));
        assert_ne!(crossing, track(&[]));
        assert_eq!(track(&[at(100.0, 100.0), at(100.0, 120.0)]), track(&[]));
        assert_ne!(track(&[at(0.0, 0.0)]), track(&[]), "one place is a dot");
    }
}
