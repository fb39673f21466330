//! Single updates of the state machine.

use std::str::FromStr;

use betadeck_core::autopilot::guidance::{PlaneCrossing, hold_remaining_s, turn_radius_m};
use betadeck_core::autopilot::land_detector::{GroundFacts, TouchdownFacts, TouchdownGuards};
use betadeck_core::autopilot::machine::{Facts, Outcome, ProgressFacts, transition};
use betadeck_core::plan::{HoldPattern, Seconds, WaypointType};
use betadeck_core::signals::SimTime;
use betadeck_core::telemetry::{FenceAction, NavState};
use serde_json::Value;

use crate::autopilot::vectors::{cases, fence_action, flag, num, state, text};

#[test]
fn hold_timers() {
    for case in cases("hold_timer", "cases") {
        let duration = Seconds::new(num(&case, "duration_ds") / 10.0);
        let elapsed = SimTime::from_secs_f64(num(&case, "elapsed_s")).0;
        // Saturates: 65535 ds are endless.
        let remaining = u64::from((hold_remaining_s(duration, elapsed) * 10.0).round() as u16);
        assert_eq!(Some(remaining), case["remaining_ds"].as_u64(), "{case}");
        let mut facts = Facts { hold_elapsed_us: elapsed, ..Facts::default() };
        facts.waypoint.kind = WaypointType::Hold;
        facts.waypoint.duration = duration;
        let over = transition(NavState::Holding, &facts).is_some();
        assert_eq!(over, flag(&case, "expired"), "guard in {case}");
    }
}

/// Returns the facts of a `state_transitions` case.
fn transition_facts(case: &Value) -> Facts {
    let input = &case["input"];
    let cm = |key: &str| input[key].as_f64().map(|value| value / 100.0);
    let is = |key: &str| input[key].as_bool().unwrap_or(false);
    let mut facts = Facts { fix: flag(input, "fix"), count: num(case, "count") as u8, ..Facts::default() };
    let waypoint = &mut facts.waypoint;
    waypoint.kind = WaypointType::from_str(text(case, "type")).unwrap();
    waypoint.pattern = input["pattern"].as_str().map_or(HoldPattern::None, |name| name.parse().unwrap());
    waypoint.duration = Seconds::new(input["duration_ds"].as_f64().unwrap_or(0.0) / 10.0);
    waypoint.last = num(case, "index") + 1.0 >= num(case, "count");
    waypoint.co_located = is("co_located");
    waypoint.missed = is("missed");
    let approach = &mut facts.approach;
    approach.distance_m = cm("distance_cm").unwrap_or(0.0);
    approach.altitude_error_m = cm("altitude_error_cm").unwrap_or(0.0);
    approach.arrival_radius_m = cm("arrival_radius_cm").unwrap();
    approach.hold_radius_m = cm("hold_radius_cm").unwrap();
    approach.turn_radius_m =
        turn_radius_m(cm("ground_speed_cms").unwrap(), num(input, "max_angle_deg").to_radians());
    approach.plane = match input["plane"].as_str() {
        None | Some("before") => PlaneCrossing::Before { to_go_m: approach.distance_m.max(0.01) },
        Some("crossed") => PlaneCrossing::Crossed { lateral_m: cm("lateral_cm").unwrap() },
        Some("behind") => PlaneCrossing::Behind,
        Some(other) => panic!("plane {other}"),
    };
    facts.climb = is("climbing").then_some((2.0, 5.0));
    let watched = !is("sticks") && case["state"] == "APPROACHING";
    facts.progress = watched.then(|| ProgressFacts {
        no_progress_s: input["no_progress_s"].as_f64().unwrap_or(0.0),
        distance_m: approach_distance(input),
        flyaway_m: cm("best_cm").unwrap_or(f64::INFINITY)
            + (0.25 * cm("leg_distance_cm").unwrap_or(0.0)).clamp(20.0, 100.0),
    });
    facts.hold_elapsed_us = SimTime::from_secs_f64(input["elapsed_s"].as_f64().unwrap_or(0.0)).0;
    if is("outside_fence") {
        facts.fence.limit_m = Some(100.0);
        facts.fence.distance_m = Some(150.0);
        facts.fence.action = fence_action(input, "geofence_action");
    }
    let down = TouchdownFacts {
        max_speed_mps: 1.0,
        max_throttle_us: 1.0,
        landing_altitude_m: 1.0,
        min_climb_mps: -1.0,
        ..TouchdownFacts::default()
    };
    facts.touchdown = TouchdownGuards::new(&down, &GroundFacts::CERTAIN);
    facts.touchdown_held_us = is("touchdown").then_some(1_000_000);
    facts
}

fn approach_distance(input: &Value) -> f64 {
    input["distance_cm"].as_f64().unwrap_or(0.0) / 100.0
}

#[test]
fn state_transitions() {
    for case in cases("state_transitions", "cases") {
        let before = state(text(&case, "state"));
        let decision = transition(before, &transition_facts(&case));
        let outcome = decision.map(|decision| decision.outcome);
        let expect = &case["expect"];
        let after = outcome.map_or(before, Outcome::state);
        assert_eq!(after, state(text(expect, "state")), "{case} gave {decision:?}");
        let index = num(&case, "index") as u64;
        let index_after = match outcome {
            Some(Outcome::Next) => index + 1,
            Some(Outcome::Fence(_)) => 0,
            Some(_) | None => index,
        };
        assert_eq!(Some(index_after), expect["index"].as_u64(), "{case}");
        if let Some(reason) = expect["reason"].as_str() {
            assert_eq!(decision.map(|decision| decision.reason.word()), Some(reason), "{case}");
        }
        let missed = outcome == Some(Outcome::Missed);
        assert_eq!(missed, expect["missed"].as_bool().unwrap_or(false), "{case}");
        let disarms = outcome == Some(Outcome::Touchdown);
        assert_eq!(disarms, expect["disarm"] == "LANDING", "{case}");
        if let Some(plan) = expect["active_plan"].as_array() {
            let want = if plan.len() == 1 { FenceAction::Land } else { FenceAction::Rth };
            assert_eq!(outcome, Some(Outcome::Fence(want)), "{case}");
        }
    }
}
