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
    let mut plan = document.plan.clone();
    if let Some((index, alt_cm)) = state.editor.dragged_altitude()
        && let Some(wp) = plan.waypoints.get_mut(index)
    {
        wp.alt_cm = alt_cm;
    }
    let estimated = estimate(&plan, home, &findings::assumptions(state, document));
    let mut along_m = 0.0;
    let legs = estimated
        .legs
        .iter()
        .enumerate()
        .filter(|(index, _)| plan.waypoints.get(*index).is_some_and(|wp| wp.kind.is_positional()));
    legs.map(|(index, leg)| {
        along_m += leg.distance_m.unwrap_or(0.0);
        Point { along_m, alt_m: leg.alt_m, index }
    })
    .collect()
}

/// Where metres stand in the panel.
struct Axes {
    area: Rect,
    length_m: f64,
    low_m: f64,
    high_m: f64,
}

impl Axes {
    /// `None` when there is nothing to show, or no room.
    fn of(points: &[Point], area: Rect) -> Option<Self> {
        let has_room = area.width > SCALE + 8 && area.height > 3;
        let length_m = points.last().filter(|_| has_room)?.along_m.max(1.0);
        let high_m = points.iter().map(|point| point.alt_m).fold(1.0, f64::max);
        let low_m = points.iter().map(|point| point.alt_m).fold(0.0, f64::min);
        Some(Self { area, length_m, low_m, high_m })
    }

    fn column(&self, along_m: f64) -> u16 {
        let columns = f64::from(self.area.width - SCALE - 3);
        self.area.x + SCALE + (along_m / self.length_m * columns).round() as u16
    }

    fn metres_per_row(&self) -> f64 {
        (self.high_m - self.low_m) / f64::from(self.area.height - 2)
    }

    fn row(&self, alt_m: f64) -> u16 {
        self.area.y + self.area.height - 1 - ((alt_m - self.low_m) / self.metres_per_row()).round() as u16
    }
}

/// The waypoint whose number stands at a cell.
pub(super) fn waypoint_at(state: &AppState, area: Rect, (column, row): (u16, u16)) -> Option<usize> {
    let points = points(state);
    let axes = Axes::of(&points, area)?;
    let here =
        |point: &&Point| axes.row(point.alt_m) == row && axes.column(point.along_m).abs_diff(column) <= 1;
    points.iter().rev().find(here).map(|point| point.index)
}

/// What a row of the profile is worth, m.
pub(super) fn metres_per_row(state: &AppState, area: Rect) -> Option<f64> {
    Axes::of(&points(state), area).map(|axes| axes.metres_per_row())
}

/// Draws the profile: a rule with its name, then the altitudes, the waypoint under the cursor marked.
pub(super) fn draw(state: &AppState, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let name = if state.forecast.estimate().is_some() {
        "─altitude · plan ˙ flown estimate"
    } else {
        "─altitude"
    };
    let rule = format!("{name}{}", "─".repeat(usize::from(area.width).saturating_sub(name.chars().count())));
    buffer.set_string(area.x, area.y, rule, theme.style(Role::Dim));
    let points = points(state);
    let Some(axes) = Axes::of(&points, area) else { return };
    for (alt_m, mark) in [(axes.high_m, '┤'), (axes.low_m, '┼')] {
        let text = format!("{alt_m:>4.0} {mark}");
        buffer.set_string(area.x, axes.row(alt_m), text, theme.style(Role::Dim));
    }
    // What the craft makes of it, below the plan itself.
    for flown in state.forecast.estimate().iter().flat_map(|forecast| &forecast.path) {
        let (along_m, alt_m) = (flown.along_m.min(axes.length_m), flown.alt.clamp(axes.low_m, axes.high_m));
        let cell = buffer.cell_mut((axes.column(along_m), axes.row(alt_m)));
        if let Some(cell) = cell.filter(|_| along_m >= 0.0 && alt_m.is_finite()) {
            cell.set_symbol("˙").set_style(theme.style(Role::Dim));
        }
    }
    let mut from = Point { along_m: 0.0, alt_m: 0.0_f64.clamp(axes.low_m, axes.high_m), index: 0 };
    for point in &points {
        let (x0, x1) = (axes.column(from.along_m), axes.column(point.along_m));
        for x in x0..=x1 {
            let share = if x1 > x0 { f64::from(x - x0) / f64::from(x1 - x0) } else { 1.0 };
            let alt_m = from.alt_m + (point.alt_m - from.alt_m) * share;
            if let Some(cell) = buffer.cell_mut((x, axes.row(alt_m))) {
                cell.set_symbol("·").set_style(theme.style(Role::Track));
            }
        }
        from = Point { ..*point };
    }
    for point in &points {
        let role = if point.index == state.editor.row() { Role::Focus } else { Role::Title };
        let (x, y) = (axes.column(point.along_m), axes.row(point.alt_m));
        buffer.set_string(x, y, point.index.to_string(), theme.style(role));
    }
}
