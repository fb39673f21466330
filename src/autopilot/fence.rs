//! The fence: a maximum horizontal distance from home. A craft exactly on it is inside.

use crate::geo::{LatLon, distance_bearing};
use crate::plan::{FlightPlan, WaypointType};
use crate::telemetry::{FenceAction, Guard, GuardName, GuardOp, NavState, PlanSource, Refusal};

/// Facts for the check in flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FenceFacts {
    /// The fence, m; `None` if it is off.
    pub limit_m: Option<f64>,
    /// Distance from home, m; `None` if home is unknown.
    pub distance_m: Option<f64>,
    /// State of the machine.
    pub state: NavState,
    /// Source of the plan that is flown. An injected plan *is* the reaction to a fence, so it is not checked.
    pub source: PlanSource,
    /// `ap_geofence_action`.
    pub action: FenceAction,
}

/// Returns the guard of the fence if the fence counts in this state. The guard holds when the craft is outside.
pub fn guard(facts: &FenceFacts) -> Option<Guard> {
    let live = match facts.state {
        NavState::Approaching
        | NavState::Arrived
        | NavState::Holding
        | NavState::Orbiting
        | NavState::Figure8 => true,
        NavState::Idle | NavState::Landing | NavState::Complete => false,
    };
    let stored = facts.source == PlanSource::Stored;
    let (value, limit) = facts.distance_m.zip(facts.limit_m).filter(|_| live && stored)?;
    Some(Guard { name: GuardName::Fence, value, limit, op: GuardOp::Above })
}

/// Checks waypoints, given by type and distance from home (m), before a flight.
///
/// # Errors
/// Fails if a fence is set and home is unknown, or if a waypoint is outside.
pub fn pre_flight(
    limit_m: u16,
    home_known: bool,
    waypoints: impl IntoIterator<Item = (WaypointType, f64)>,
) -> Result<(), Refusal> {
    if limit_m == 0 {
        return Ok(());
    }
    if !home_known {
        return Err(Refusal::NoHome);
    }
    for (wp, (kind, distance_m)) in (0_u8..).zip(waypoints) {
        if kind.uses_position() && distance_m > f64::from(limit_m) {
            // Saturates. The fence itself is at most 10 km.
            let distance_cm = (distance_m * 100.0).round() as u32;
            return Err(Refusal::Geofence { wp, distance_cm, limit_m });
        }
    }
    Ok(())
}

/// Checks a whole plan before a flight.
///
/// # Errors
/// Fails as [`pre_flight`] does.
pub fn check_plan(limit_m: u16, home: Option<LatLon>, plan: &FlightPlan) -> Result<(), Refusal> {
    let distances = plan.waypoints.iter().map(|waypoint| {
        (waypoint.kind, home.map_or(0.0, |home| distance_bearing(home, waypoint.position).0))
    });
    pre_flight(limit_m, home.is_some(), distances)
}
