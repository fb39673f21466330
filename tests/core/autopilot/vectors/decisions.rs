//! Decisions that allow or end a flight: plan, engagement, fence, receiver loss.

use std::str::FromStr;

use betadeck_core::autopilot::engage::{EngageFacts, check};
use betadeck_core::autopilot::fence::{FenceFacts, pre_flight};
use betadeck_core::autopilot::machine::{Facts, Outcome, transition};
use betadeck_core::autopilot::rx_loss::{RxLossFacts, decide};
use betadeck_core::geo::LatLon;
use betadeck_core::plan::WaypointRecord;
use betadeck_core::plan::validate::{PlanFault, WaypointFault, check_records};
use betadeck_core::plan::{FlightPlan, HoldPattern, MAX_WAYPOINTS, Waypoint, WaypointType};
use betadeck_core::telemetry::{AbortReason, FenceAction, PlanSource, Refusal, RxLossPolicy};
use serde_json::Value;
use strum::IntoEnumIterator;

use crate::autopilot::vectors::{cases, fence_action, flag, num, state, text};

fn refusal_name(verdict: Result<(), Refusal>) -> String {
    match verdict {
        Ok(()) => "ok".to_owned(),
        Err(Refusal::Geofence { wp, .. }) => format!("GEOFENCE({wp})"),
        Err(Refusal::BadWaypoint(wp)) => format!("BAD_WAYPOINT({wp})"),
        Err(Refusal::Aborted(why)) => format!("ABORTED({why})"),
        Err(other) => other.to_string(),
    }
}

#[test]
fn geofence() {
    for case in cases("geofence", "in_flight") {
        let limit = num(&case, "limit_m");
        let state = state(text(&case, "state"));
        let fence = FenceFacts {
            limit_m: (limit > 0.0).then_some(limit),
            distance_m: flag(&case, "home").then_some(num(&case, "distance_cm") / 100.0),
            state,
            source: if flag(&case, "injected") { PlanSource::Rth } else { PlanSource::Stored },
            action: fence_action(&case, "action"),
        };
        let got =
            match transition(state, &Facts { fence, ..Facts::default() }).map(|decision| decision.outcome) {
                Some(Outcome::Fence(FenceAction::Land)) => "EMERGENCY_LAND",
                Some(Outcome::Fence(FenceAction::Rth)) => "RETURN_TO_HOME",
                _ => "none",
            };
        assert_eq!(got, text(&case, "expect"), "{case}");
    }
    for case in cases("geofence", "pre_flight") {
        let waypoints =
            case["types"].as_array().unwrap().iter().zip(case["waypoint_distance_cm"].as_array().unwrap());
        let waypoints = waypoints.map(|(kind, distance)| {
            (WaypointType::from_str(kind.as_str().unwrap()).unwrap(), distance.as_f64().unwrap() / 100.0)
        });
        let got = pre_flight(num(&case, "limit_m") as u16, flag(&case, "home"), waypoints);
        assert_eq!(refusal_name(got), text(&case, "expect"), "{case}");
    }
}

#[test]
fn rx_loss() {
    for case in cases("rx_loss", "cases") {
        let policy = RxLossPolicy::iter().find(|policy| policy.to_string() == text(&case, "policy"));
        let facts = RxLossFacts {
            policy: policy.unwrap(),
            engaged: flag(&case, "engaged"),
            state: state(text(&case, "state")),
            fix: flag(&case, "fix"),
        };
        let decision = decide(&facts);
        assert_eq!(decision.action.to_string(), text(&case, "action"), "{case}");
        assert_eq!(decision.autopilot_flag, text(&case, "autopilot") == "on", "{case}");
    }
}

#[test]
fn engagement() {
    for case in cases("engage", "cases") {
        let limit_m = num(&case, "fence_m") as u16;
        let farthest = num(&case, "farthest_cm") / 100.0;
        let kinds = [(WaypointType::Flyover, farthest)];
        let bad = case["bad_waypoint"].as_u64();
        let records = (0..).map(|index| (Some(index) != bad).then(Waypoint::default));
        let aborted = case["aborted"].as_str().map(|why| match why {
            "STALLED" => AbortReason::Stalled,
            other => panic!("unknown cause {other}"),
        });
        let facts = EngageFacts {
            armed: flag(&case, "armed"),
            throttle_raised: flag(&case, "throttle_raised"),
            fix: flag(&case, "fix"),
            altitude_valid: flag(&case, "altitude_ok"),
            heading_valid: case["heading_ok"].as_bool().unwrap_or(true),
            plan: check_records(num(&case, "count") as usize, records.take(40)),
            fence: pre_flight(limit_m, flag(&case, "home"), kinds),
            floor: Ok(()),
            failsafe: flag(&case, "failsafe"),
            aborted,
        };
        let got = match check(&facts) {
            Ok(()) => "ENGAGED".to_owned(),
            Err(Refusal::Geofence { .. }) => "GEOFENCE".to_owned(),
            other => refusal_name(other),
        };
        assert_eq!(got, text(&case, "expect"), "{case}");
    }
}

fn record(value: &Value) -> Option<Waypoint> {
    let record = WaypointRecord {
        position: LatLon::new(num(value, "lat") as i32, num(value, "lon") as i32),
        alt_cm: num(value, "alt") as i32,
        speed: num(value, "speed") as u16,
        duration_ds: num(value, "duration") as u16,
        kind: WaypointType::from_str(text(value, "type")).ok()?,
        pattern: HoldPattern::from_str(text(value, "pattern")).ok()?,
    };
    Some(record.into())
}

#[test]
fn plan_validation() {
    for case in cases("plan_validation", "cases") {
        let waypoints = case["waypoints"].as_array().unwrap();
        let got = match check_records(waypoints.len(), waypoints.iter().map(record)) {
            Ok(()) => "ok".to_owned(),
            Err(PlanFault::Empty) => "NO_PLAN".to_owned(),
            Err(PlanFault::Corrupt(_)) => "PLAN_CORRUPT".to_owned(),
            Err(PlanFault::BadWaypoint { index, fault }) => {
                let known = matches!(fault, WaypointFault::Latitude | WaypointFault::Longitude);
                assert_eq!(known, record(&waypoints[usize::from(index)]).is_some());
                format!("BAD_WAYPOINT({index})")
            }
        };
        assert_eq!(got, text(&case, "expect"), "{case}");
    }
    let somewhere = cases("plan_validation", "cases")
        .iter()
        .find_map(|case| record(case["waypoints"].as_array()?.first()?))
        .unwrap();
    for case in cases("plan_validation", "is_valid_index") {
        let count = (num(&case, "count") as usize).min(MAX_WAYPOINTS);
        let mut plan = FlightPlan::default();
        plan.waypoints.extend(std::iter::repeat_n(somewhere, count));
        let found = plan.waypoints.get(num(&case, "index") as usize).is_some();
        assert_eq!(found, flag(&case, "expect"), "{case}");
    }
}
