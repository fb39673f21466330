//! The navigator of a remote flight controller, as shown by its `waypoint status`.

use crate::fc::telemetry::{Mission, MissionPhase};
use crate::plan::{FlightPlan, HoldPattern};
use crate::telemetry::{NavState, NavTelemetry, TransitionReason};

/// Returns the navigator's state from a status. `engaged` is `true` while the mode is active.
pub(super) fn nav(mission: &Mission, engaged: bool, plan: Option<&FlightPlan>) -> NavTelemetry {
    let wp = mission.waypoint.unwrap_or_default();
    let planned = plan.and_then(|plan| plan.waypoints.get(usize::from(wp)));
    let (state, reason) = match &mission.phase {
        Some(MissionPhase::Flying(NavState::Holding)) => {
            (holding(planned.map(|waypoint| waypoint.pattern)), None)
        }
        Some(MissionPhase::Flying(state)) => (*state, None),
        Some(MissionPhase::Aborted { .. }) => {
            (NavState::Idle, mission.abort_reason().map(TransitionReason::GivenUp))
        }
        Some(MissionPhase::Inactive { .. }) | None => (NavState::Idle, None),
    };
    // In a landing these values have another meaning.
    let is_under_way = state != NavState::Idle && state != NavState::Landing;
    let count = mission.count.or_else(|| plan.and_then(|plan| u8::try_from(plan.waypoints.len()).ok()));
    NavTelemetry {
        state,
        engaged: engaged && state != NavState::Idle,
        reason,
        wp,
        next_wp: wp,
        count: count.unwrap_or_default(),
        kind: planned.map(|waypoint| waypoint.kind),
        distance_m: mission.distance_m.filter(|_| is_under_way),
        bearing_rad: mission.bearing_deg.map(f64::to_radians).filter(|_| is_under_way),
        eta_s: mission.eta_s.filter(|_| is_under_way),
        ..NavTelemetry::default()
    }
}

/// Returns the kind of hold. Some firmware has one word for all holds; the plan gives the kind.
fn holding(pattern: Option<HoldPattern>) -> NavState {
    match pattern {
        Some(HoldPattern::Orbit) => NavState::Orbiting,
        Some(HoldPattern::Figure8) => NavState::Figure8,
        Some(HoldPattern::None) | None => NavState::Holding,
    }
}
