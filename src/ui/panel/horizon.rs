//! The artificial horizon and the attitude in numbers.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::Widget as _;
use ratatui::widgets::canvas::{Canvas, Points};

use crate::ui::formatting::{compass, fixed, signed};
use crate::ui::shared::Shared;
use crate::ui::theme::Role;

use crate::ui::area::row;

/// The columns and rows of the horizon.
pub(super) const SIZE: (u16, u16) = (21, 5);
/// Degrees of pitch per row.
const DEGREES_A_ROW: f64 = 10.0;

/// Draws the horizon on the left of the area, and roll, pitch and heading to its right.
pub(super) fn draw(state: &Shared, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let (estimate, truth) = (&state.view.vehicle.estimate, &state.view.vehicle.truth);
    // Values that the firmware does not report come from the simulator.
    let roll = estimate.roll_deg.or(truth.map(|truth| truth.roll_deg)).filter(|deg| deg.is_finite());
    let pitch = estimate.pitch_deg.or(truth.map(|truth| truth.pitch_deg)).filter(|deg| deg.is_finite());
    let heading = estimate.heading_deg.or(truth.map(|truth| truth.heading_deg));
    let place = Rect { width: SIZE.0.min(area.width), height: SIZE.1.min(area.height), ..area };
    if let (Some(roll), Some(pitch)) = (roll, pitch) {
        let (half_width, half_height) = (f64::from(SIZE.0) / 2.0, f64::from(SIZE.1) / 2.0);
        let points = horizon(roll, pitch, half_width, half_height);
        Canvas::default()
            .marker(theme.marker())
            .x_bounds([-half_width, half_width])
            .y_bounds([-half_height, half_height])
            .paint(|context| context.draw(&Points { coords: &points, color: theme.colour(Role::Key) }))
            .render(place, buffer);
    }
    let middle = Rect { x: place.x + SIZE.0 / 2 - 2, y: place.y + SIZE.1 / 2, width: 5, height: 1 };
    if middle.intersection(place) == middle {
        row(buffer, middle, 0, theme, Role::Craft, "──●──");
    }
    let numbers = Rect { x: place.x + SIZE.0 + 2, width: area.width.saturating_sub(SIZE.0 + 2), ..place };
    for (at, text) in [
        (1, format!("roll    {}°", signed(roll, 6, 1))),
        (2, format!("pitch   {}°", signed(pitch, 6, 1))),
        (3, format!("heading {}°", fixed(heading.map(compass), 6, 0))),
    ] {
        row(buffer, numbers, at, theme, Role::Text, &text);
    }
}

/// Returns the points of the horizon relative to the craft, right and up. A row is as high as two columns are wide.
fn horizon(roll_deg: f64, pitch_deg: f64, half_width: f64, half_height: f64) -> Vec<(f64, f64)> {
    let (sin, cos) = roll_deg.to_radians().sin_cos();
    let reach = (half_width * 5.0) as i32;
    (-reach..=reach)
        .map(|step| f64::from(step) / 4.0)
        // Right wing down: the horizon rises at the right. Nose up: it sinks.
        .map(|along| (along * cos, along * sin / 2.0 - pitch_deg / DEGREES_A_ROW))
        .filter(|(x, y)| x.abs() <= half_width && y.abs() <= half_height)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_horizon_rises_on_the_side_of_the_low_wing_and_sinks_with_the_nose_up() {
        let right = |roll, pitch| {
            let points = horizon(roll, pitch, 10.5, 2.5);
            points.iter().copied().max_by(|a, b| a.0.total_cmp(&b.0)).expect("points")
        };
        assert!(right(15.0, 0.0).1 > 1.0 && right(-15.0, 0.0).1 < -1.0);
        assert!((right(0.0, 10.0).1 + 1.0).abs() < 1e-9);
        assert!(horizon(0.0, 80.0, 10.5, 2.5).is_empty(), "out of sight");
        assert!(horizon(90.0, 0.0, 10.5, 2.5).iter().all(|point| point.0.abs() < 1e-9), "upright");
    }
}
