//! The rules of each state.

use arrayvec::ArrayVec;

use super::{Facts, Outcome, Rule, Rules, STALL_S};
use crate::autopilot::fence;
use crate::autopilot::guidance::PlaneCrossing;
use crate::plan::{HoldPattern, WaypointType};
use crate::telemetry::{AbortReason, Guard, GuardOp, NavState, PlanSource};

/// Name of the guard on the GPS fix.
pub(super) const FIX: &str = "fix";
/// Name of the guard on the plan.
pub(super) const PLAN: &str = "plan";

/// The rules of `state`, in the order they are tried; the first whose guards all hold fires.
#[must_use]
pub fn rules(state: NavState, facts: &Facts) -> Rules {
    let mut list = Rules::new();
    if state != NavState::Idle {
        common(state, facts, &mut list);
        own(state, facts, &mut list);
    }
    list
}

/// The rules that only this state has.
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

pub(super) fn guard(name: &'static str, value: f64, op: GuardOp, limit: f64, unit: &'static str) -> Guard {
    Guard { name, value, limit, op, unit }
}

fn rule(guards: impl IntoIterator<Item = Guard>, outcome: Outcome, reason: &'static str) -> Rule {
    Rule { guards: ArrayVec::from_iter(guards), outcome, reason }
}

/// What ends a mission from any state.
pub(super) fn common(state: NavState, facts: &Facts, list: &mut Rules) {
    let fix = guard(FIX, f64::from(u8::from(facts.fix)), GuardOp::Below, 1.0, "");
    list.push(rule([fix], Outcome::Abort(AbortReason::GpsLost), "GPS_LOST"));
    let plan = guard(PLAN, f64::from(facts.count), GuardOp::Below, 1.0, "waypoints");
    list.push(rule([plan], Outcome::Abort(AbortReason::NoPlan), "NO_PLAN"));
    let fence = fence::FenceFacts { state, ..facts.fence };
    if let Some(outside) = fence::guard(&fence) {
        list.push(rule([outside], Outcome::Fence(fence.action), "fence"));
    }
}

fn approaching(facts: &Facts, list: &mut Rules) {
    if let Some((altitude, enough)) = facts.climb {
        let climbed = guard("climb", altitude, GuardOp::AtLeast, enough, "m");
        list.push(rule([climbed], Outcome::Climbed, "climb"));
        return;
    }
    monitors(facts, list);
    match facts.waypoint.kind {
        WaypointType::Flyover => pass(facts, false, list),
        WaypointType::Flyby => pass(facts, true, list),
        WaypointType::Hold | WaypointType::Land => list.push(arrival(facts, facts.approach.hold_radius_m)),
        WaypointType::Takeoff => {
            let radius = facts.approach.hold_radius_m;
            let level =
                guard("altitude", facts.approach.altitude_error_m.abs(), GuardOp::AtMost, radius, "m");
            let mut reached = arrival(facts, radius);
            reached.guards.push(level);
            list.push(reached);
        }
        // Never current: the plan moves on to positional waypoints only.
        WaypointType::AltChange | WaypointType::Delay | WaypointType::YawRate => {
            list.push(rule([], Outcome::Next, "advance"));
        }
    }
}

/// The progress monitors, unless they are paused. A return home that cannot be made is not left hanging in the air.
pub(super) fn monitors(facts: &Facts, list: &mut Rules) {
    let give_up = |why| match facts.fence.source {
        PlanSource::Stored => Outcome::Abort(why),
        PlanSource::Rth | PlanSource::Emergency => Outcome::LandHere,
    };
    if let Some(progress) = facts.progress {
        let stalled = guard("no progress", progress.no_progress_s, GuardOp::AtLeast, STALL_S, "s");
        list.push(rule([stalled], give_up(AbortReason::Stalled), "STALLED"));
        let away = guard("flyaway", progress.distance_m, GuardOp::Above, progress.flyaway_m, "m");
        list.push(rule([away], give_up(AbortReason::Flyaway), "FLYAWAY"));
    }
}

fn arrival(facts: &Facts, radius: f64) -> Rule {
    let near = guard("arrival", facts.approach.distance_m, GuardOp::AtMost, radius, "m");
    rule([near], Outcome::Arrive, "arrival")
}

/// FLYOVER and FLYBY: by radius when last, co-located or missed, else by the plane, FLYBY also by the turn radius.
fn pass(facts: &Facts, flyby: bool, list: &mut Rules) {
    let radius = facts.approach.arrival_radius_m;
    let waypoint = facts.waypoint;
    let turn =
        guard("turn radius", facts.approach.distance_m, GuardOp::AtMost, facts.approach.turn_radius_m, "m");
    if waypoint.last || waypoint.co_located || waypoint.missed || facts.approach.plane == PlaneCrossing::NoLeg
    {
        list.push(arrival(facts, radius));
        return;
    }
    if flyby {
        list.push(rule([turn], Outcome::Arrive, "turn radius"));
    }
    let (to_go, lateral) = match facts.approach.plane {
        PlaneCrossing::NoLeg => return,
        PlaneCrossing::Before { to_go_m } => (to_go_m, None),
        PlaneCrossing::Crossed { lateral_m } => (0.0, Some(lateral_m)),
        PlaneCrossing::Behind => {
            // It stood on the plane before: only when it runs away from the point does it have to come back.
            let overrun = guard("overrun", facts.approach.distance_m, GuardOp::Above, radius, "m");
            list.push(rule([overrun], Outcome::Missed, "missed"));
            return;
        }
    };
    let plane = guard("plane", to_go, GuardOp::AtMost, 0.0, "m");
    let beside = lateral.map(|lateral| guard("beside", lateral, GuardOp::AtMost, radius, "m"));
    list.push(rule(std::iter::once(plane).chain(beside), Outcome::Arrive, "plane"));
    if let Some(lateral) = lateral {
        let too_far = guard("beside", lateral, GuardOp::Above, radius, "m");
        list.push(rule([plane, too_far], Outcome::Missed, "missed"));
    }
}

fn next(facts: &Facts) -> Outcome {
    if facts.waypoint.last { Outcome::Complete } else { Outcome::Next }
}

fn arrived(facts: &Facts, list: &mut Rules) {
    let loiter = facts.waypoint.duration_ds > 0;
    let (outcome, reason) = match facts.waypoint.kind {
        WaypointType::Hold => (Outcome::Hold, "hold"),
        WaypointType::Land if loiter => (Outcome::Hold, "loiter"),
        WaypointType::Land => (Outcome::Land, "land"),
        WaypointType::Takeoff if loiter => (Outcome::Hold, "loiter"),
        WaypointType::Flyover
        | WaypointType::Flyby
        | WaypointType::Takeoff
        | WaypointType::AltChange
        | WaypointType::Delay
        | WaypointType::YawRate => (next(facts), "advance"),
    };
    list.push(rule([], outcome, reason));
}

fn holding(facts: &Facts, list: &mut Rules) {
    match facts.waypoint.kind {
        WaypointType::Hold => match facts.waypoint.pattern {
            HoldPattern::Orbit => list.push(rule([], Outcome::Orbit, "pattern")),
            HoldPattern::Figure8 => list.push(rule([], Outcome::Figure8, "pattern")),
            HoldPattern::None => hold_time(facts, list),
        },
        WaypointType::Land => {
            let over = guard("hold time", hold_s(facts), GuardOp::AtLeast, duration_s(facts), "s");
            list.push(rule([over], Outcome::Land, "hold time"));
        }
        WaypointType::Takeoff
        | WaypointType::Flyover
        | WaypointType::Flyby
        | WaypointType::AltChange
        | WaypointType::Delay
        | WaypointType::YawRate => hold_time(facts, list),
    }
}

/// A duration of zero is endless: the guard is shown, with a limit that is never reached.
fn hold_time(facts: &Facts, list: &mut Rules) {
    let limit = if facts.waypoint.duration_ds > 0 { duration_s(facts) } else { f64::INFINITY };
    let over = guard("hold time", hold_s(facts), GuardOp::AtLeast, limit, "s");
    list.push(rule([over], next(facts), "hold time"));
}

// Both divisions round the same rational number the same way, so the comparison is exact.
fn hold_s(facts: &Facts) -> f64 {
    facts.hold_elapsed_us as f64 / 1e6
}

fn duration_s(facts: &Facts) -> f64 {
    f64::from(facts.waypoint.duration_ds) / 10.0
}

fn landing(facts: &Facts, list: &mut Rules) {
    let held = facts.touchdown_held_us.unwrap_or(0) as f64 / 1e6;
    let needed = f64::from(facts.detection_time_ds) / 10.0;
    let time = guard("touchdown time", held, GuardOp::AtLeast, needed, "s");
    list.push(rule(facts.touchdown.iter().chain([time]), Outcome::Touchdown, "touchdown"));
}
