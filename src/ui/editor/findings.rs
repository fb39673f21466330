//! What is wrong with the open plan or worth knowing, with the craft's settings and the edit that takes it away.

use crate::geo::LatLon;
use crate::plan::edit::PlanDocument;
use crate::plan::edit::fix::{Fix, fix, waypoint_of};
use crate::plan::estimate::Assumptions;
use crate::plan::review::{Finding, review};
use crate::ui::app_state::AppState;

/// Home as far as it is known: of the craft, of the plan, of the map.
#[must_use]
pub(crate) fn home(state: &AppState) -> Option<LatLon> {
    let document = state.editor.document();
    let planned = document.home.map(|home| home.position);
    let first = || document.plan.waypoints.iter().find(|wp| wp.kind.uses_position()).map(|wp| wp.position);
    let map = crate::ui::map_point::origin(state);
    let map = map.map(|frame| LatLon::from_degrees(frame.lat_deg, frame.lon_deg));
    state.view.vehicle.craft.home.or(planned).or(map).or_else(first)
}

/// The limits the plan is judged by: its own settings, else those of the craft.
#[must_use]
pub(crate) fn assumptions(state: &AppState, document: &PlanDocument) -> Assumptions {
    let mut lines = Vec::new();
    if let Some(settings) = &state.view.vehicle.settings {
        lines.push(format!("ap_max_velocity = {:.0}", settings.max_velocity_mps * 100.0));
        lines.push(format!("ap_max_angle = {:.0}", settings.max_angle_deg));
        lines.push(format!("ap_waypoint_arrival_radius = {:.0}", settings.arrival_radius_m * 100.0));
        lines.push(format!("ap_waypoint_hold_radius = {:.0}", settings.hold_radius_m * 100.0));
        lines.push(format!("ap_hold_orbit_radius = {:.0}", settings.orbit_radius_m * 100.0));
        lines.push(format!("alt_hold_climb_rate = {:.0}", settings.climb_mps * 10.0));
        lines.push(format!("ap_max_distance_from_home = {:.0}", settings.fence_m.unwrap_or(0.0)));
    }
    lines.extend(document.settings.iter().cloned());
    Assumptions::from_settings(&lines)
}

/// All findings about the open plan, refusals first; none while it is empty.
#[must_use]
pub(crate) fn findings(state: &AppState) -> Vec<Finding> {
    let document = state.editor.document();
    match home(state) {
        Some(home) if !document.plan.waypoints.is_empty() => {
            review(&document.plan, home, &assumptions(state, document))
        }
        _ => Vec::new(),
    }
}

/// The finding that is shown: about the waypoint under the cursor, else the first; and what takes it away.
#[must_use]
pub(crate) fn shown(state: &AppState, findings: &[Finding]) -> Option<(Finding, Option<Fix>)> {
    let here = findings.iter().find(|finding| waypoint_of(finding) == Some(state.editor.row()));
    let finding = here.or_else(|| findings.first())?.clone();
    let fix = fix(state.editor.document(), &finding, home(state)?);
    Some((finding, fix))
}
