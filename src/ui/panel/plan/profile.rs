//! The altitudes of the plan over its length.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::plan::estimate::estimate;
use crate::ui::app_state::AppState;
use crate::ui::editor::findings;
use crate::ui::theme::Role;

/// Columns of the scale at the left.
const SCALE: u16 = 6;

/// A place of the profile: metres flown, metres above home, waypoint.
struct Point {
    along_m: f64,
    alt_m: f64,
    index: usize,
}

fn points(state: &AppState) -> Vec<Point> {
    let document = state.editor.document();
    let Some(home) = findings::home(state) else { return Vec::new() };
    let estimated = estimate(&document.plan, home, &findings::assumptions(state, document));
    let mut along_m = 0.0;
    let legs =
        estimated.legs.iter().enumerate().filter(|(index, _)| {
            document.plan.waypoints.get(*index).is_some_and(|wp| wp.kind.is_positional())
        });
    legs.map(|(index, leg)| {
        along_m += leg.distance_m.unwrap_or(0.0);
        Point { along_m, alt_m: leg.alt_m, index }
    })
    .collect()
}

/// Draws the profile: a rule with its name, then the altitudes, the waypoint under the cursor marked.
pub(super) fn draw(state: &AppState, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let rule = format!("─altitude{}", "─".repeat(usize::from(area.width.saturating_sub(9))));
    buffer.set_string(area.x, area.y, rule, theme.style(Role::Dim));
    let points = points(state);
    let (Some(last), true) = (points.last(), area.width > SCALE + 8 && area.height > 3) else { return };
    let length_m = last.along_m.max(1.0);
    let high = points.iter().map(|point| point.alt_m).fold(1.0, f64::max);
    let low = points.iter().map(|point| point.alt_m).fold(0.0, f64::min);
    let (columns, rows) = (f64::from(area.width - SCALE - 3), f64::from(area.height - 2));
    let column = |along_m: f64| SCALE + (along_m / length_m * columns).round() as u16;
    let line = |alt_m: f64| (area.height - 1) - ((alt_m - low) / (high - low) * rows).round() as u16;
    for (alt_m, mark) in [(high, '┤'), (low, '┼')] {
        let text = format!("{alt_m:>4.0} {mark}");
        buffer.set_string(area.x, area.y + line(alt_m), text, theme.style(Role::Dim));
    }
    let marks: Vec<(u16, u16, usize)> =
        points.iter().map(|point| (column(point.along_m), line(point.alt_m), point.index)).collect();
    let mut from = Point { along_m: 0.0, alt_m: 0.0_f64.clamp(low, high), index: 0 };
    for point in points {
        let (x0, x1) = (column(from.along_m), column(point.along_m));
        for x in x0..=x1 {
            let share = if x1 > x0 { f64::from(x - x0) / f64::from(x1 - x0) } else { 1.0 };
            let alt_m = from.alt_m + (point.alt_m - from.alt_m) * share;
            if let Some(cell) = buffer.cell_mut((area.x + x, area.y + line(alt_m))) {
                cell.set_symbol("·").set_style(theme.style(Role::Track));
            }
        }
        from = point;
    }
    for (x, y, index) in marks {
        let role = if index == state.editor.row() { Role::Focus } else { Role::Title };
        buffer.set_string(area.x + x, area.y + y, index.to_string(), theme.style(role));
    }
}
