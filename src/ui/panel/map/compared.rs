//! The map of the open plan and of another version of it.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::Widget as _;
use ratatui::widgets::canvas::Canvas;

use super::labels::Labels;
use super::marks::glyph;
use super::{PlacedWaypoint, lines, spots_of};
use crate::plan::FlightPlan;
use crate::ui::acts::map_edit;
use crate::ui::acts::origin::origin;
use crate::ui::acts::viewport::Viewport;
use crate::ui::shared::Shared;
use crate::ui::theme::Role;

/// The distance from which two places are different ones, m.
const APART_M: f64 = 0.05;

/// Draws the open plan dashed with filled marks, and `other` dotted with rings, north up. `names` are their names, the
/// other one first.
pub(in crate::ui) fn draw_compared(
    state: &Shared,
    other: &FlightPlan,
    names: (&str, &str),
    area: Rect,
    buffer: &mut Buffer,
) {
    let current = &state.plan().waypoints;
    let Some(frame) = origin(state).filter(|_| area.width >= 8 && area.height >= 4) else { return };
    let home = map_edit::home(state).unwrap_or_default();
    let [other, current] = [&other.waypoints, current].map(|waypoints| spots_of(waypoints, 0, &frame, home));
    let places = [&other, &current].into_iter().flatten().map(|spot| spot.place);
    let view = Viewport::around((area, 0.0), None, places.chain([home]));
    Canvas::default()
        .marker(state.theme.marker())
        .x_bounds(view.across())
        .y_bounds(view.upward())
        .paint(|context| lines::paint_two(state, (view, home), [&other, &current], context))
        .render(area, buffer);
    let mut labels = Labels::new(&state.theme, view, buffer);
    labels.top(&format!("╌╌ {}   ··· ○ {}", names.1, names.0), Role::Title);
    labels.mark(home, "⌂", Role::Title);
    let is_elsewhere = |spot: &&PlacedWaypoint| {
        !current
            .iter()
            .any(|there| there.wp.kind == spot.wp.kind && there.place.distance(spot.place) < APART_M)
    };
    for spot in &current {
        labels.mark(spot.place, glyph(spot.wp.kind), Role::Track);
    }
    for spot in other.iter().filter(is_elsewhere) {
        labels.mark(spot.place, "○", Role::Predicted);
    }
    for spot in &current {
        let number = spot.index.to_string();
        labels.beside(spot.place, &format!("{number} {}", spot.wp.kind), &number, Role::Track);
    }
    for spot in other.iter().filter(is_elsewhere) {
        let number = spot.index.to_string();
        labels.beside(spot.place, &format!("○{number} {}", spot.wp.kind), &number, Role::Predicted);
    }
}
