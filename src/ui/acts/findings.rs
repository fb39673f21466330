//! The findings about the open plan with the craft's settings, and the edits that fix them.

use nalgebra::Vector3;

use super::settings_in_force;
use crate::geo::LatLon;
use crate::plan::FlightPlan;
use crate::plan::edit::fix::{Fix, fix, waypoint_of};
use crate::plan::estimate::Assumptions;
use crate::plan::format::HomePosition;
use crate::plan::review::{Finding, FlownPlace, clearances, low_in_flight, review};
use crate::ui::acts::origin::origin;
use crate::ui::shared::Shared;

/// Returns the home position: of the craft, else of the plan, else the origin of the map, else the first waypoint.
pub(crate) fn home(state: &Shared) -> Option<LatLon> {
    let document = state.editor.document();
    let planned = document.home.map(|home| home.position);
    let first = || document.plan.waypoints.iter().find(|wp| wp.kind.uses_position()).map(|wp| wp.position);
    let map = origin(state);
    let map = map.map(|frame| LatLon::from_degrees(frame.lat_deg, frame.lon_deg));
    state.view.vehicle.craft.home.or(planned).or(map).or_else(first)
}

/// Returns the home with its altitude above sea level, for a file without it.
pub(crate) fn home_above_sea(state: &Shared) -> Option<HomePosition> {
    let amsl_m = origin(state)?.alt_amsl_m;
    Some(HomePosition { position: home(state)?, amsl_m: Some(amsl_m) })
}

/// Returns all findings about the open plan, refusals first; empty for an empty plan.
pub(crate) fn findings(state: &Shared) -> Vec<Finding> {
    let document = state.editor.document();
    match home(state) {
        Some(home) if !document.plan.waypoints.is_empty() => {
            let differs = settings_in_force::differing(state, document).into_iter();
            let differs = differs.map(|setting| Finding::CraftDiffers { setting });
            let assumptions = settings_in_force::assumptions(state, document);
            let mut findings = review(&document.plan, home, &assumptions);
            let refusals = findings.iter().take_while(|finding| finding.is_refusal()).count();
            findings.splice(refusals..refusals, differs);
            findings.extend_from_slice(state.ground.low());
            findings.extend(state.editor.zones.findings().iter().cloned());
            findings
        }
        _ => Vec::new(),
    }
}

/// Looks at the ground for the legs and the ways home that come too close to it, as planned and as flown in the estimate.
pub(crate) fn low(state: &Shared, home: LatLon, assumptions: &Assumptions) -> Vec<Finding> {
    let Some(relief) = state.ground.relief(home) else { return Vec::new() };
    let (plan, margin_m) = (state.plan(), state.ground.clearance_m);
    let mut findings = clearances(plan, assumptions, &relief, margin_m).findings;
    if let Some((estimate, frame)) = state.forecast.estimate().zip(origin(state)) {
        let path = estimate.path.iter().map(|point| {
            let (lat_deg, lon_deg, _) = frame.to_geodetic(Vector3::new(point.e, point.n, 0.0));
            let place = LatLon::from_degrees(lat_deg, lon_deg);
            FlownPlace { place, along_m: point.along_m, alt_m: point.alt }
        });
        let flown = low_in_flight(plan, assumptions, &relief, margin_m, path, &findings);
        findings.extend(flown);
    }
    findings
}

/// Returns the finding for which the autopilot would refuse a plan in the air.
pub(crate) fn refusal(state: &Shared, plan: &FlightPlan, limits: &Assumptions) -> Option<Finding> {
    // Arming sets home where the craft is.
    let craft = &state.view.vehicle.craft;
    let here = craft.gps.as_ref().filter(|_| craft.has_fix()).map(|gps| gps.position);
    let home = craft.home.filter(|_| craft.is_armed()).or(here).or_else(|| home(state))?;
    review(plan, home, limits).into_iter().find(Finding::is_refusal)
}

/// Returns the finding for which the autopilot would refuse the plan that the craft stores.
pub(crate) fn refusal_of_the_stored(state: &Shared) -> Option<Finding> {
    let stored = state.view.vehicle.stored_plan.as_ref().filter(|plan| !plan.waypoints.is_empty())?;
    refusal(state, stored, &settings_in_force::of_the_craft(state)?)
}

/// Returns the finding for which the autopilot would refuse the open plan, if the craft does not have it.
pub(crate) fn refusal_of_the_open(state: &Shared) -> Option<Finding> {
    if !settings_in_force::craft_has_another(state) {
        return None;
    }
    refusal(state, state.plan(), &settings_in_force::assumptions(state, state.editor.document()))
}

/// Returns the shown finding (about the waypoint under the cursor, else the first) and its fix.
pub(crate) fn shown(state: &Shared, findings: &[Finding]) -> Option<(Finding, Option<Fix>)> {
    let here = findings.iter().find(|finding| waypoint_of(finding) == Some(state.editor.row()));
    let finding = here.or_else(|| findings.first())?.clone();
    let fix = fix(state.editor.document(), &finding, home(state)?);
    Some((finding, fix))
}
