//! 2 Plan: the waypoints of the open plan, with what is wrong beside them.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::geo::{Degrees7, LatLon, distance_bearing};
use crate::plan::{FlightPlan, Waypoint, WaypointType};
use crate::ui::app_state::AppState;
use crate::ui::forecast;
use crate::ui::panel::Panel;
use crate::ui::theme::Role;

use super::{line, row};
use crate::ui::text_wrap::wrapped;

/// Rows of problems at most, below the waypoints.
const PROBLEM_ROWS: usize = 2;

/// The title: name of the plan, and whether the craft has it.
pub(crate) fn title(state: &AppState) -> String {
    let name = Panel::Plan.title();
    if state.plan.plan.waypoints.is_empty() {
        return name.to_owned();
    }
    let where_it_is = match &state.view.vehicle.stored_plan {
        Some(stored) if *stored == state.plan.plan => "✓ on the craft",
        Some(_) => "● not on the craft",
        None => "— on the craft?",
    };
    format!("{name} — {} {where_it_is}", state.plan.name)
}

/// Home and the radius of the fence, m, when both are known.
fn fence(state: &AppState) -> Option<(LatLon, f64)> {
    let vehicle = &state.view.vehicle;
    vehicle.craft.home.zip(vehicle.settings.and_then(|settings| settings.fence_m))
}

/// What is wrong with each waypoint that has something wrong.
fn problems(state: &AppState) -> Vec<String> {
    let plan = &state.plan.plan;
    let fence = fence(state);
    (0..plan.waypoints.len()).filter_map(|index| waypoint_problem(plan, index, fence)).collect()
}

/// What is wrong with a waypoint of a plan, or worth knowing.
fn waypoint_problem(plan: &FlightPlan, index: usize, fence: Option<(LatLon, f64)>) -> Option<String> {
    let wp = plan.waypoints.get(index)?;
    if !wp.kind.uses_position() {
        return None;
    }
    if !wp.position.is_on_globe() {
        return Some(format!("WP{index}: latitude or longitude is not on the globe."));
    }
    let (home, limit_m) = fence?;
    let (distance_m, _) = distance_bearing(home, wp.position);
    (distance_m > limit_m)
        .then(|| format!("WP{index} is {distance_m:.0} m from home, the fence is {limit_m:.0} m."))
}

/// Rows of waypoints: what the head, the problems and the estimate leave.
fn waypoint_rows(area: Rect, problems: &[String]) -> usize {
    usize::from(area.height).saturating_sub(2 + problems.len().min(PROBLEM_ROWS))
}

/// The furthest that the panel scrolls: then the last waypoint is the last on the screen.
pub(crate) fn last_scroll(state: &AppState, area: Rect) -> usize {
    state.plan.plan.waypoints.len().saturating_sub(waypoint_rows(area, &problems(state)))
}

/// Draws the inside.
pub(crate) fn draw(state: &AppState, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let plan = &state.plan.plan;
    if plan.waypoints.is_empty() {
        row(buffer, area, 0, theme, Role::Dim, "No waypoints are open.");
        row(buffer, area, 1, theme, Role::Dim, "`waypoint insert …` in the CLI (5) adds one to the craft.");
        return;
    }
    let wide = area.width >= 70;
    let head = if wide {
        "  # type        latitude    longitude    alt m  m/s  time s pattern"
    } else {
        "  # type       latitude    longitude   alt m time s"
    };
    row(buffer, area, 0, theme, Role::Title, head);
    let vehicle = &state.view.vehicle;
    let fence = fence(state);
    let problems = problems(state);
    let below = problems.len().min(PROBLEM_ROWS) as u16;
    let rows = waypoint_rows(area, &problems);
    let first = state.scrolls.plan.min(plan.waypoints.len().saturating_sub(rows));
    let flying = vehicle.nav.as_ref().filter(|nav| nav.engaged && vehicle.active_plan.as_ref() == Some(plan));
    for (at, (index, wp)) in plan.waypoints.iter().enumerate().skip(first).take(rows).enumerate() {
        let current = flying.is_some_and(|nav| index == usize::from(nav.wp));
        let problem = waypoint_problem(plan, index, fence).is_some();
        let (mark, role) = match (problem, current) {
            (true, _) => ('✗', Role::Fault),
            (false, true) => ('▸', Role::Target),
            (false, false) => (' ', Role::Text),
        };
        row(buffer, area, at as u16 + 1, theme, role, &format!("{mark}{}", waypoint_row(index, wp, wide)));
    }
    let width = usize::from(area.width);
    for (at, problem) in problems.iter().take(usize::from(below)).enumerate() {
        let text = wrapped(&format!("✗ {problem}"), width).join(" ");
        row(buffer, area, area.height - 1 - below + at as u16, theme, Role::Fault, &text);
    }
    line(buffer, area, area.height - 1, &forecast::estimate_line(state, area.width));
}

fn waypoint_row(index: usize, wp: &Waypoint, wide: bool) -> String {
    let kind = wp.kind.to_string();
    let place = |e7: i32| if wp.kind.uses_position() { Degrees7(e7).to_string() } else { "—".to_owned() };
    let (lat, lon) = (place(wp.position.lat_e7), place(wp.position.lon_e7));
    let alt = match wp.kind {
        WaypointType::Delay | WaypointType::YawRate => "—".to_owned(),
        _ => format!("{:.1}", f64::from(wp.alt_cm) / 100.0),
    };
    let time = match (wp.duration_ds, wp.kind) {
        (0, WaypointType::Hold) => "∞".to_owned(),
        (0, _) => "—".to_owned(),
        (ds, _) => format!("{:.1}", f64::from(ds) / 10.0),
    };
    if !wide {
        return format!("{index:>2} {kind:<10}{lat:>11} {lon:>12} {alt:>7} {time:>6}");
    }
    let speed = match wp.speed_cms {
        0 => "—".to_owned(),
        cms => format!("{:.1}", f64::from(cms) / 100.0),
    };
    let pattern = if wp.kind == WaypointType::Hold { wp.pattern.to_string() } else { "—".to_owned() };
    format!("{index:>2} {kind:<10} {lat:>11} {lon:>12} {alt:>8} {speed:>4} {time:>7} {pattern}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_takeoff_far_from_home_is_no_problem_for_it_has_no_place() {
        let mut plan = FlightPlan::default();
        plan.waypoints.push(Waypoint { kind: WaypointType::Takeoff, ..Waypoint::default() });
        plan.waypoints.push(Waypoint { kind: WaypointType::Flyover, ..Waypoint::default() });
        let fence = Some((LatLon::new(404_635_000, -795_182_000), 500.0));
        assert_eq!(waypoint_problem(&plan, 0, fence), None);
        assert!(waypoint_problem(&plan, 1, fence).is_some_and(|text| text.contains("the fence is 500 m")));
        assert!(!waypoint_row(0, &plan.waypoints[0], true).contains("0.0000000"));
    }
}
