//! The altitude profile: the altitudes of the plan over its length.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::plan::estimate::estimate;
use crate::ui::drawing;
use crate::ui::editor::{findings, settings_in_force};
use crate::ui::shared::Shared;
use crate::ui::theme::Role;

mod flown;
mod ground_line;

use flown::{FlownPoint, flown};
use ground_line::{GroundPoint, ground_line};

/// The width of the scale on the left.
const SCALE: u16 = 6;
/// The marks of the lines.
const PLANNED: (&str, Role) = ("·", Role::Text);
const ESTIMATED: (&str, Role) = ("˙", Role::Predicted);
const FLOWN: (&str, Role) = ("•", Role::Track);
const GROUND: (&str, Role) = ("▁", Role::Dim);

/// A point of the profile: metres flown, metres above home, index of the waypoint.
struct Point {
    along_m: f64,
    alt_m: f64,
    index: usize,
}

fn points(state: &Shared) -> Vec<Point> {
    let document = state.editor.document();
    let Some(home) = findings::home(state) else { return Vec::new() };
    let mut plan = document.plan.clone();
    if let Some((index, altitude)) = state.editor.dragged_altitude()
        && let Some(wp) = plan.waypoints.get_mut(index)
    {
        wp.altitude = altitude;
    }
    let estimated = estimate(&plan, home, &settings_in_force::assumptions(state, document));
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

/// The scales of the profile.
struct Axes {
    area: Rect,
    length_m: f64,
    low_m: f64,
    high_m: f64,
}

impl Axes {
    /// Returns the scales for the open plan; `None` if there is nothing to show, or no room.
    fn of_plan(state: &Shared, points: &[Point], area: Rect) -> Option<Self> {
        let flown = flown(state, points);
        Self::of(points, &flown, &ground_line(state, points, &flown), area)
    }

    /// Returns `None` if there is nothing to show, or no room.
    fn of(points: &[Point], flown: &[FlownPoint], ground: &[GroundPoint], area: Rect) -> Option<Self> {
        let has_room = area.width > SCALE + 8 && area.height > 3;
        let length_m = points.last().filter(|_| has_room)?.along_m.max(1.0);
        let altitudes = || {
            points
                .iter()
                .map(|point| point.alt_m)
                .chain(flown.iter().map(|point| point.alt_m))
                .chain(ground.iter().map(|point| point.alt_m))
        };
        let high_m = altitudes().fold(1.0, f64::max);
        let low_m = altitudes().fold(0.0, f64::min);
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

/// Returns the waypoint whose number is at a cell.
pub(super) fn waypoint_at(state: &Shared, area: Rect, (column, row): (u16, u16)) -> Option<usize> {
    let points = points(state);
    let axes = Axes::of_plan(state, &points, area)?;
    let here =
        |point: &&Point| axes.row(point.alt_m) == row && axes.column(point.along_m).abs_diff(column) <= 1;
    points.iter().rev().find(here).map(|point| point.index)
}

/// Returns the height of a row of the profile, m.
pub(super) fn metres_per_row(state: &Shared, area: Rect) -> Option<f64> {
    let points = points(state);
    Axes::of_plan(state, &points, area).map(|axes| axes.metres_per_row())
}

/// Draws the profile: a rule with its legend, then the altitudes, the waypoint under the cursor marked.
pub(super) fn draw(state: &Shared, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let points = points(state);
    let flown = flown(state, &points);
    let ground = ground_line(state, &points, &flown);
    legend(state, !flown.is_empty(), !ground.is_empty(), area, buffer);
    let Some(axes) = Axes::of(&points, &flown, &ground, area) else { return };
    for (alt_m, mark) in [(axes.high_m, '┤'), (axes.low_m, '┼')] {
        let text = format!("{:>4.0} {mark}", state.units.length(alt_m));
        drawing::text(buffer, area.x, axes.row(alt_m), text, theme.style(Role::Dim));
    }
    let mut put = |column: u16, alt_m: f64, (symbol, role): (&str, Role)| {
        if let Some(cell) = buffer.cell_mut((column, axes.row(alt_m))) {
            cell.set_symbol(symbol).set_style(theme.style(role));
        }
    };
    for point in &ground {
        put(axes.column(point.along_m.min(axes.length_m)), point.alt_m, GROUND);
    }
    // The estimated altitudes, below the plan itself.
    for point in state.forecast.estimate().iter().flat_map(|forecast| &forecast.path) {
        if point.along_m >= 0.0 && point.alt.is_finite() {
            let column = axes.column(point.along_m.min(axes.length_m));
            put(column, point.alt.clamp(axes.low_m, axes.high_m), ESTIMATED);
        }
    }
    let mut from = Point { along_m: 0.0, alt_m: 0.0_f64.clamp(axes.low_m, axes.high_m), index: 0 };
    for point in &points {
        let (x0, x1) = (axes.column(from.along_m), axes.column(point.along_m));
        for x in x0..=x1 {
            let share = if x1 > x0 { f64::from(x - x0) / f64::from(x1 - x0) } else { 1.0 };
            let alt_m = from.alt_m + (point.alt_m - from.alt_m) * share;
            put(x, alt_m, PLANNED);
        }
        from = Point { ..*point };
    }
    for point in &flown {
        put(axes.column(point.along_m), point.alt_m, FLOWN);
    }
    for point in &points {
        let role = if point.index == state.editor.row() { Role::Focus } else { Role::Title };
        let (x, y) = (axes.column(point.along_m), axes.row(point.alt_m));
        drawing::text(buffer, x, y, point.index.to_string(), theme.style(role));
    }
}

/// Draws the rule above the profile: the unit, and the meaning of the marks.
fn legend(state: &Shared, has_flown: bool, has_ground: bool, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let rule = "─".repeat(usize::from(area.width));
    drawing::text(buffer, area.x, area.y, rule, theme.style(Role::Dim));
    let mut x = area.x + 1;
    let mut write = |text: &str, role| {
        let room = usize::from(area.right().saturating_sub(x));
        x = drawing::text_within(buffer, x, area.y, text, room, theme.style(role));
    };
    write(&format!("altitude {}", state.units.length_unit()), Role::Dim);
    let lines = [
        (true, PLANNED, "plan"),
        (state.forecast.estimate().is_some(), ESTIMATED, "flown estimate"),
        (has_flown, FLOWN, "flown"),
        (has_ground, GROUND, "ground"),
    ];
    for (_, (mark, role), name) in lines.into_iter().filter(|(is_there, ..)| *is_there) {
        write(&format!(" {mark}"), role);
        write(&format!(" {name}"), Role::Dim);
    }
    write(" ", Role::Dim);
}
