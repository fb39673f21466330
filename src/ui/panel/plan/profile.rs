//! The altitude profile: the altitudes of the plan over its length, with axes.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::plan::estimate::estimate;
use crate::ui::acts::{findings, settings_in_force};
use crate::ui::axis::ticks;
use crate::ui::curve::{self, Limits, Point as CurvePoint, Stroke};
use crate::ui::drawing;
use crate::ui::raster::Raster;
use crate::ui::shared::Shared;
use crate::ui::theme::Role;

mod flown;
mod ground_line;

use flown::{FlownPoint, flown};
use ground_line::{GroundPoint, ground_line};

/// The width of the axis on the left.
const AXIS: u16 = 6;
/// The columns right of the curves, for the number of the last waypoint.
const MARGIN: u16 = 2;
/// The rows above and below the curves: the legend, and the axis of distances.
const FRAME_ROWS: u16 = 2;
/// The least distance between two ticks: rows, and columns.
const TICK_GAP: (u16, u16) = (3, 12);
/// The dots of a column of the ground that are left out between two that are set.
const GROUND_GAP: f64 = 3.0;

/// The curves with their strokes.
const PLANNED: (Stroke, Role) = (Stroke::Dashed, Role::Text);
const ESTIMATED: (Stroke, Role) = (Stroke::Dotted, Role::Predicted);
const FLOWN: (Stroke, Role) = (Stroke::Solid, Role::Track);
/// The ground, which is filled with dots.
const GROUND: (&str, Role) = ("▒▒", Role::Dim);
/// The ground in ASCII.
const PLAIN_GROUND: char = '_';

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
    /// The cells of the curves.
    plot: Rect,
    limits: Limits,
}

impl Axes {
    /// Returns the scales for the open plan; `None` if there is nothing to show, or no room.
    fn from_plan(state: &Shared, points: &[Point], area: Rect) -> Option<Self> {
        let flown = flown(state, points);
        Self::of(points, &flown, &ground_line(state, points, &flown), area)
    }

    /// Returns the scales for these points; `None` if there are no points, or no room.
    fn of(points: &[Point], flown: &[FlownPoint], ground: &[GroundPoint], area: Rect) -> Option<Self> {
        let has_room = area.width > AXIS + MARGIN + 8 && area.height > FRAME_ROWS + 1;
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
        let plot = Rect {
            x: area.x + AXIS,
            y: area.y + 1,
            width: area.width - AXIS - MARGIN,
            height: area.height - FRAME_ROWS,
        };
        Some(Self { plot, limits: Limits { along: (0.0, length_m), values: (low_m, high_m) } })
    }

    fn column(&self, along_m: f64) -> u16 {
        let share = along_m / self.limits.along.1;
        self.plot.x + (share * f64::from(self.plot.width - 1)).round() as u16
    }

    fn metres_per_row(&self) -> f64 {
        (self.limits.values.1 - self.limits.values.0) / f64::from(self.plot.height - 1)
    }

    fn row(&self, alt_m: f64) -> u16 {
        let rows = ((self.limits.values.1 - alt_m) / self.metres_per_row()).round();
        self.plot.y + (rows as u16).min(self.plot.height - 1)
    }

    /// Returns an altitude within the limits, or the nearest limit.
    fn limited(&self, alt_m: f64) -> f64 {
        alt_m.clamp(self.limits.values.0, self.limits.values.1)
    }
}

/// Returns the waypoint whose number is at a cell.
pub(super) fn waypoint_at(state: &Shared, area: Rect, (column, row): (u16, u16)) -> Option<usize> {
    let points = points(state);
    let axes = Axes::from_plan(state, &points, area)?;
    let here =
        |point: &&Point| axes.row(point.alt_m) == row && axes.column(point.along_m).abs_diff(column) <= 1;
    points.iter().rev().find(here).map(|point| point.index)
}

/// Returns the height of a row of the profile, m.
pub(super) fn metres_per_row(state: &Shared, area: Rect) -> Option<f64> {
    let points = points(state);
    Axes::from_plan(state, &points, area).map(|axes| axes.metres_per_row())
}

/// Draws the profile: a rule with its legend, the altitudes, and the axes. The number of the waypoint under the cursor
/// is marked.
pub(super) fn draw(state: &Shared, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let points = points(state);
    let flown = flown(state, &points);
    let ground = ground_line(state, &points, &flown);
    legend(state, !flown.is_empty(), !ground.is_empty(), area, buffer);
    let Some(axes) = Axes::of(&points, &flown, &ground, area) else { return };
    draw_axes(state, &axes, area, buffer);
    draw_ground(state, &axes, &ground, buffer);
    let at = |along_m: f64, alt_m: f64| -> CurvePoint { (along_m, Some((alt_m, alt_m))) };
    let length_m = axes.limits.along.1;
    let estimate = state.forecast.estimate().into_iter().flat_map(|forecast| &forecast.path);
    let estimated = estimate.filter(|point| point.along_m >= 0.0 && point.alt.is_finite());
    let start = at(0.0, axes.limited(0.0));
    let planned = points.iter().map(|point| at(point.along_m, point.alt_m));
    let curves: [((Stroke, Role), Vec<CurvePoint>); 3] = [
        (FLOWN, flown.iter().map(|point| at(point.along_m.min(length_m), point.alt_m)).collect()),
        (PLANNED, std::iter::once(start).chain(planned).collect()),
        (
            ESTIMATED,
            estimated.map(|point| at(point.along_m.min(length_m), axes.limited(point.alt))).collect(),
        ),
    ];
    for ((stroke, role), points) in curves {
        let mut raster = Raster::new(axes.plot);
        curve::draw(&mut raster, axes.limits, stroke, &points);
        raster.add(theme.style(role), theme.charset, stroke.plain(), buffer);
    }
    for point in &points {
        let role = if point.index == state.editor.row() { Role::Focus } else { Role::Title };
        let (x, y) = (axes.column(point.along_m), axes.row(point.alt_m));
        drawing::text(buffer, x, y, point.index.to_string(), theme.style(role));
    }
}

/// Fills the ground from the lowest altitude to its height with dots.
fn draw_ground(state: &Shared, axes: &Axes, ground: &[GroundPoint], buffer: &mut Buffer) {
    let mut raster = Raster::new(axes.plot);
    let (columns, rows) = raster.dots();
    let (low_m, high_m) = axes.limits.values;
    let last = |dots: usize| dots.saturating_sub(1) as f64;
    for point in ground {
        let x = (point.along_m / axes.limits.along.1).min(1.0) * last(columns);
        let top = (high_m - point.alt_m) / (high_m - low_m) * last(rows);
        // Neighbours are shifted against each other, so that the dots do not form lines.
        let shift = if x.round() as i64 % 2 == 0 { 0.0 } else { 2.0 };
        raster.dot((x, top));
        let mut y = last(rows) - shift;
        while y > top {
            raster.dot((x, y));
            y -= 1.0 + GROUND_GAP;
        }
    }
    raster.add(state.theme.style(GROUND.1), state.theme.charset, PLAIN_GROUND, buffer);
}

/// Draws the axis of altitudes on the left, and the one of distances below.
fn draw_axes(state: &Shared, axes: &Axes, area: Rect, buffer: &mut Buffer) {
    let dim = state.theme.style(Role::Dim);
    let plot = axes.plot;
    let axis_x = plot.x - 1;
    for y in plot.y..plot.bottom() {
        drawing::text(buffer, axis_x, y, "│", dim);
    }
    let shown = |metres: f64| state.units.length(metres);
    let (low_m, high_m) = axes.limits.values;
    for tick in ticks(shown(low_m), shown(high_m), usize::from(plot.height / TICK_GAP.0).max(2)) {
        let y = axes.row(axes.limited(state.units.metres(tick)));
        drawing::text(buffer, area.x, y, format!("{tick:>4.0} ┤"), dim);
    }
    let y = plot.bottom();
    let line = format!("└{}", "─".repeat(usize::from(plot.width)));
    drawing::text(buffer, axis_x, y, line, dim);
    let length = shown(axes.limits.along.1);
    for tick in ticks(0.0, length, usize::from(plot.width / TICK_GAP.1).max(2)) {
        let text = format!("{tick:.0}");
        let x = axes.column(state.units.metres(tick));
        // The last one ends at the edge.
        let from = (x - text.len() as u16 / 2).min(area.right().saturating_sub(text.len() as u16));
        drawing::text(buffer, from.max(plot.x), y, text, dim);
    }
}

/// Draws the rule above the profile: the unit, and the meaning of the curves.
fn legend(state: &Shared, has_flown: bool, has_ground: bool, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let rule = "─".repeat(usize::from(area.width));
    drawing::text(buffer, area.x, area.y, rule, theme.style(Role::Dim));
    let mut x = area.x + 1;
    let mut write = |text: &str, role| {
        let room = usize::from(area.right().saturating_sub(x));
        x = drawing::text_within(buffer, x, area.y, text, room, theme.style(role));
    };
    let unit = state.units.length_unit();
    write(&format!("altitude and distance in {unit}"), Role::Dim);
    let sign = |(stroke, role): (Stroke, Role)| (stroke.sign(theme.charset), role);
    let lines = [
        (true, sign(PLANNED), "plan"),
        (state.forecast.estimate().is_some(), sign(ESTIMATED), "flown estimate"),
        (has_flown, sign(FLOWN), "flown"),
        (has_ground, GROUND, "ground"),
    ];
    for (_, (mark, role), name) in lines.into_iter().filter(|(is_there, ..)| *is_there) {
        write(&format!(" {mark}"), role);
        write(&format!(" {name}"), Role::Dim);
    }
    write(" ", Role::Dim);
}
