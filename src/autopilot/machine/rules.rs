//! The rules of each state.

use arrayvec::ArrayVec;

use super::{Facts, HELD_OFF_S, HOLD_ALTITUDE_M, Outcome, Rule, Rules, STALL_S};
use crate::autopilot::fence;
use crate::autopilot::guidance::PlaneCrossing;
use crate::autopilot::land_detector::STATIONARY_S;
use crate::plan::{Approach, HoldPattern, Then};
use crate::telemetry::{AbortReason, Guard, GuardName, GuardOp, NavState, PlanSource, TransitionReason};

/// Returns the rules of `state` in the order in which they are tried. The first rule whose guards all hold fires.
pub fn rules(state: NavState, facts: &Facts) -> Rules {
    let mut list = Rules::new();
    if state != NavState::Idle {
        common(state, facts, &mut list);
        own(state, facts, &mut list);
    }
    list
}

/// Adds the rules that only this state has.
pub(super) fn own(state: NavState, facts: &Facts, list: &mut Rules) {
    match state {
        NavState::Idle | NavState::Complete => {}
        NavState::Approaching => approaching(facts, list),
        NavState::Arrived => arrived(facts, list),
        NavState::Holding => holding(facts, list),
        NavState::Orbiting | NavState::Figure8 => hold_time(facts, list),
        NavState::Landing => landing(facts, list),
    }
}

fn rule(guards: impl IntoIterator<Item = Guard>, outcome: Outcome, reason: TransitionReason) -> Rule {
    Rule { guards: ArrayVec::from_iter(guards), outcome, reason }
}

/// Returns the rule that gives the mission up for the reason `why`.
fn given_up(guard: Guard, outcome: impl Fn(AbortReason) -> Outcome, why: AbortReason) -> Rule {
    rule([guard], outcome(why), TransitionReason::GivenUp(why))
}

/// Adds the rules that end a mission from any state.
pub(super) fn common(state: NavState, facts: &Facts, list: &mut Rules) {
    let fix = Guard::new(GuardName::Fix, f64::from(u8::from(facts.fix)), GuardOp::Below, 1.0);
    list.push(given_up(fix, Outcome::Abort, AbortReason::GpsLost));
    let plan = Guard::new(GuardName::Plan, f64::from(facts.count), GuardOp::Below, 1.0);
    list.push(given_up(plan, Outcome::Abort, AbortReason::NoPlan));
    let fence = fence::FenceFacts { state, ..facts.fence };
    if let Some(outside) = fence::guard(&fence) {
        list.push(rule([outside], Outcome::Fence(fence.action), TransitionReason::Fence));
    }
}

fn approaching(facts: &Facts, list: &mut Rules) {
    if let Some((altitude, enough)) = facts.climb {
        let climbed = Guard::new(GuardName::Climb, altitude, GuardOp::AtLeast, enough);
        list.push(rule([climbed], Outcome::Climbed, TransitionReason::Climb));
        return;
    }
    monitors(facts, list);
    match facts.waypoint.kind.capability().approach {
        Approach::Pass => pass(facts, false, list),
        Approach::Turn => pass(facts, true, list),
        Approach::Stop => list.push(arrival(facts, facts.approach.hold_radius_m)),
        Approach::Level => {
            list.push(level_arrival(facts, facts.approach.hold_radius_m.max(HOLD_ALTITUDE_M)));
            let held_off = Guard::new(
                GuardName::HeldOffAltitude,
                facts.approach.held_off_s,
                GuardOp::AtLeast,
                HELD_OFF_S,
            );
            list.push(rule([held_off], Outcome::Arrive, TransitionReason::HeldOffAltitude));
        }
        Approach::Climb => list.push(level_arrival(facts, facts.approach.hold_radius_m)),
        // Never current, since the plan moves on to positional waypoints only.
        Approach::Modify(_) => {
            list.push(rule([], Outcome::Next, TransitionReason::Advance));
        }
    }
}

/// Adds the rules of the progress monitors unless they are paused. A return home that fails ends in a landing, so
/// that the craft is not left in the air.
pub(super) fn monitors(facts: &Facts, list: &mut Rules) {
    let outcome = |why| match facts.fence.source {
        PlanSource::Stored => Outcome::Abort(why),
        PlanSource::Rth | PlanSource::Emergency => Outcome::LandHere,
    };
    if let Some(progress) = facts.progress {
        let stalled = Guard::new(GuardName::NoProgress, progress.no_progress_s, GuardOp::AtLeast, STALL_S);
        list.push(given_up(stalled, outcome, AbortReason::Stalled));
        let away = Guard::new(GuardName::Flyaway, progress.distance_m, GuardOp::Above, progress.flyaway_m);
        list.push(given_up(away, outcome, AbortReason::Flyaway));
    }
}

fn arrival(facts: &Facts, radius: f64) -> Rule {
    let near = Guard::new(GuardName::Arrival, facts.approach.distance_m, GuardOp::AtMost, radius);
    rule([near], Outcome::Arrive, TransitionReason::Arrival)
}

/// Returns the rule for an arrival within the hold radius and with an altitude error of at most `altitude_m`.
fn level_arrival(facts: &Facts, altitude_m: f64) -> Rule {
    let error_m = facts.approach.altitude_error_m.abs();
    let level = Guard::new(GuardName::Altitude, error_m, GuardOp::AtMost, altitude_m);
    let mut reached = arrival(facts, facts.approach.hold_radius_m);
    reached.guards.push(level);
    reached
}

/// Adds the rules of FLYOVER and FLYBY: by radius if last, co-located or missed, else by the plane; FLYBY also by the
/// turn radius.
fn pass(facts: &Facts, flyby: bool, list: &mut Rules) {
    let radius = facts.approach.arrival_radius_m;
    let waypoint = facts.waypoint;
    let turn = Guard::new(
        GuardName::TurnRadius,
        facts.approach.distance_m,
        GuardOp::AtMost,
        facts.approach.turn_radius_m,
    );
    if waypoint.last || waypoint.co_located || waypoint.missed || facts.approach.plane == PlaneCrossing::NoLeg
    {
        list.push(arrival(facts, radius));
        return;
    }
    if flyby {
        list.push(rule([turn], Outcome::Arrive, TransitionReason::TurnRadius));
    }
    let (to_go, lateral) = match facts.approach.plane {
        PlaneCrossing::NoLeg => return,
        PlaneCrossing::Before { to_go_m } => (to_go_m, None),
        PlaneCrossing::Crossed { lateral_m } => (0.0, Some(lateral_m)),
        PlaneCrossing::Behind => {
            // The craft was exactly on the plane before. It only has to come back if it moves away from the point.
            let overrun = Guard::new(GuardName::Overrun, facts.approach.distance_m, GuardOp::Above, radius);
            list.push(rule([overrun], Outcome::Missed, TransitionReason::Missed));
            return;
        }
    };
    let plane = Guard::new(GuardName::Plane, to_go, GuardOp::AtMost, 0.0);
    let beside = lateral.map(|lateral| Guard::new(GuardName::Beside, lateral, GuardOp::AtMost, radius));
    list.push(rule(std::iter::once(plane).chain(beside), Outcome::Arrive, TransitionReason::Plane));
    if let Some(lateral) = lateral {
        let too_far = Guard::new(GuardName::Beside, lateral, GuardOp::Above, radius);
        list.push(rule([plane, too_far], Outcome::Missed, TransitionReason::Missed));
    }
}

fn next(facts: &Facts) -> Outcome {
    if facts.waypoint.last { Outcome::Complete } else { Outcome::Next }
}

fn arrived(facts: &Facts, list: &mut Rules) {
    let loiter = !facts.waypoint.duration.is_zero();
    let (outcome, reason) = match facts.waypoint.kind.capability().then {
        Then::Hold => (Outcome::Hold, TransitionReason::Hold),
        Then::Land | Then::Loiter if loiter => (Outcome::Hold, TransitionReason::Loiter),
        Then::Land => (Outcome::Land, TransitionReason::Land),
        Then::GoOn | Then::Loiter => (next(facts), TransitionReason::Advance),
    };
    list.push(rule([], outcome, reason));
}

fn holding(facts: &Facts, list: &mut Rules) {
    if facts.held_by_command {
        return;
    }
    match facts.waypoint.kind.capability().then {
        Then::Hold => match facts.waypoint.pattern {
            HoldPattern::Orbit => list.push(rule([], Outcome::Orbit, TransitionReason::Pattern)),
            HoldPattern::Figure8 => list.push(rule([], Outcome::Figure8, TransitionReason::Pattern)),
            HoldPattern::None => hold_time(facts, list),
        },
        Then::Land => {
            let duration_s = facts.waypoint.duration.get();
            let over = Guard::new(GuardName::HoldTime, hold_s(facts), GuardOp::AtLeast, duration_s);
            list.push(rule([over], Outcome::Land, TransitionReason::HoldTime));
        }
        Then::GoOn | Then::Loiter => hold_time(facts, list),
    }
}

/// Adds the rule for the hold time. A duration of zero is endless: the guard is shown with a limit that is never
/// reached.
fn hold_time(facts: &Facts, list: &mut Rules) {
    let duration = facts.waypoint.duration;
    let limit = if duration.is_zero() { f64::INFINITY } else { duration.get() };
    let over = Guard::new(GuardName::HoldTime, hold_s(facts), GuardOp::AtLeast, limit);
    list.push(rule([over], next(facts), TransitionReason::HoldTime));
}

// Both divisions round the same rational number the same way, so the comparison is exact.
fn hold_s(facts: &Facts) -> f64 {
    facts.hold_elapsed_us as f64 / 1e6
}

fn landing(facts: &Facts, list: &mut Rules) {
    let held = facts.touchdown_held_us.unwrap_or(0) as f64 / 1e6;
    let needed = f64::from(facts.detection_time_ds) / 10.0;
    let time = Guard::new(GuardName::TouchdownTime, held, GuardOp::AtLeast, needed);
    list.push(rule(facts.touchdown.iter().chain([time]), Outcome::Touchdown, TransitionReason::Touchdown));
    let still = Guard::new(GuardName::Stationary, facts.stationary_s, GuardOp::AtLeast, STATIONARY_S);
    list.push(rule([still], Outcome::Touchdown, TransitionReason::Touchdown));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::machine::transition;
    use crate::plan::WaypointType;

    #[test]
    fn a_takeoff_or_hold_far_above_its_altitude_is_not_reached_yet() {
        for kind in [WaypointType::Takeoff, WaypointType::Hold] {
            for (above_m, arrives) in [(-5.0, false), (-1.0, true), (0.0, true), (1.0, true), (5.0, false)] {
                let mut facts = Facts::default();
                facts.waypoint.kind = kind;
                facts.approach.altitude_error_m = -above_m;
                let outcome = transition(NavState::Approaching, &facts).map(|transition| transition.outcome);
                assert_eq!(outcome, arrives.then_some(Outcome::Arrive), "{kind} {above_m} m above");
            }
        }
    }
}
