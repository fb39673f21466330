//! Every group of the autopilot's test vectors, against the functions the navigator uses.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may stop at a surprise and say what it measured"
)]

use std::path::Path;
use std::str::FromStr;

use betadeck::autopilot::control::{
    ThrottleTerms, YawFacts, desired_heading, earth_to_body, throttle_share, yaw_rate_dps,
};
use betadeck::autopilot::engage::{EngageFacts, check};
use betadeck::autopilot::fence::{FenceFacts, in_flight, pre_flight};
use betadeck::autopilot::guidance::{
    CornerArc, L1Limits, PlaneCrossing, Spiral, TouchdownFacts, TouchdownTimer, figure8, hold_expired,
    hold_remaining_ds, l1, landing_setpoint_m, leg_speed_mps, orbit, pattern_rate_rps, plane_crossing,
    spiral_offset, stop_speed_mps, turn_radius_m,
};
use betadeck::autopilot::io::{AbortReason, L1Mode, NavState, PlanSource, Refusal};
use betadeck::autopilot::machine::{Facts, Outcome, ProgressFacts, transition};
use betadeck::autopilot::params::{FenceAction, Params, RxLossPolicy, YawMode};
use betadeck::autopilot::rx_loss::{RxLossFacts, decide};
use betadeck::geo::{LatLon, distance_bearing, local_offset, offset_to_latlon};
use betadeck::plan::validate::{PlanFault, WaypointFault, check_records, is_valid_index};
use betadeck::plan::{HoldPattern, Waypoint, WaypointType};
use betadeck::signals::SimTime;
use nalgebra::Vector2;
use serde_json::Value;
use strum::IntoEnumIterator;

fn group(name: &str) -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/vectors/autopilot.json");
    let all: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    all[name].clone()
}

fn cases(name: &str, list: &str) -> Vec<Value> {
    let cases = group(name)[list].as_array().unwrap().clone();
    assert!(!cases.is_empty());
    cases
}

fn num(case: &Value, key: &str) -> f64 {
    case[key].as_f64().unwrap_or_else(|| panic!("{key} missing in {case}"))
}

fn text<'a>(case: &'a Value, key: &str) -> &'a str {
    case[key].as_str().unwrap_or_else(|| panic!("{key} missing in {case}"))
}

fn flag(case: &Value, key: &str) -> bool {
    case[key].as_bool().unwrap_or_else(|| panic!("{key} missing in {case}"))
}

fn point(value: &Value) -> LatLon {
    LatLon::new(value[0].as_i64().unwrap() as i32, value[1].as_i64().unwrap() as i32)
}

/// A pair of centimetres as metres.
fn metres(value: &Value) -> Vector2<f64> {
    Vector2::new(value[0].as_f64().unwrap(), value[1].as_f64().unwrap()) / 100.0
}

fn state(name: &str) -> NavState {
    NavState::iter().find(|state| state.to_string() == name).unwrap()
}

fn set(params: &mut Params, name: &str, case: &Value, key: &str) {
    params.set_by_name(name, case[key].as_i64().unwrap()).unwrap();
}

#[track_caller]
fn close(got: f64, want: f64, tolerance: f64, case: &Value) {
    assert!((got - want).abs() <= tolerance, "got {got}, want {want} ± {tolerance} in {case}");
}

#[track_caller]
fn close_angle(got_deg: f64, want_deg: f64, tolerance: f64, case: &Value) {
    let difference = (got_deg - want_deg + 180.0).rem_euclid(360.0) - 180.0;
    assert!(difference.abs() <= tolerance, "got {got_deg}, want {want_deg} in {case}");
}

#[track_caller]
fn close_place(got: LatLon, want: LatLon, reference: LatLon, case: &Value) {
    let lon_tolerance = 2.0 / reference.lat_deg().to_radians().cos().max(1e-3);
    let dlon = (f64::from(got.lon_e7) - f64::from(want.lon_e7) + 1.8e9).rem_euclid(3.6e9) - 1.8e9;
    assert!((got.lat_e7 - want.lat_e7).abs() <= 2 && dlon.abs() <= lon_tolerance, "{got} for {case}");
}

#[test]
fn distance_and_bearing() {
    for case in cases("distance_bearing", "cases") {
        let (distance, bearing) = distance_bearing(point(&case["from"]), point(&case["to"]));
        let want = num(&case, "distance_cm");
        close(distance * 100.0, want, (want * 5e-4).max(1.0), &case);
        if want > 0.0 {
            let tolerance = if want < 200.0 { 0.5 } else { 0.03 };
            close_angle(bearing.to_degrees(), num(&case, "bearing_cdeg") / 100.0, tolerance, &case);
        } else {
            assert!(distance.abs() + bearing.abs() < 1e-12);
        }
    }
}

#[test]
fn local_offsets() {
    for case in cases("local_offset", "cases") {
        let ne = local_offset(point(&case["origin"]), point(&case["point"])) * 100.0;
        for (got, key) in [(ne.x, "north_cm"), (ne.y, "east_cm")] {
            close(got, num(&case, key), (num(&case, key).abs() * 2e-4).max(1.0), &case);
        }
    }
}

#[test]
fn offsets_to_positions() {
    for case in cases("offset_to_latlon", "cases") {
        let origin = point(&case["origin"]);
        let offset = Vector2::new(num(&case, "north_cm"), num(&case, "east_cm")) / 100.0;
        close_place(offset_to_latlon(origin, offset), point(&case["point"]), origin, &case);
    }
}

#[test]
fn turn_radius() {
    for case in cases("turn_radius", "cases") {
        let lean = num(&case, "max_angle_deg").to_radians();
        let radius = turn_radius_m(num(&case, "ground_speed_cms") / 100.0, lean) * 100.0;
        close(radius, num(&case, "radius_cm"), num(&case, "radius_cm") * 2e-3, &case);
    }
}

/// Facts of a FLYOVER between others.
fn flyover() -> Facts {
    let mut facts = Facts { count: 3, ..Facts::default() };
    facts.waypoint.last = false;
    facts
}

#[test]
fn plane_crossings() {
    for case in cases("plane_crossing", "cases") {
        let (start, wp) = (metres(&case["leg_start"]), metres(&case["waypoint"]));
        let (prev, pos) = (metres(&case["prev"]), metres(&case["position"]));
        let plane = plane_crossing(start, wp, prev, pos);
        let mut facts = flyover();
        facts.approach.plane = plane;
        facts.approach.distance_m = (wp - pos).norm();
        facts.approach.arrival_radius_m = num(&case, "arrival_radius_cm") / 100.0;
        facts.waypoint.missed = flag(&case, "missed_before");
        let outcome = transition(NavState::Approaching, &facts).outcome;
        let expect = &case["expect"];
        assert_eq!(outcome == Some(Outcome::Arrive), flag(expect, "arrived"), "{case}");
        let missed = facts.waypoint.missed || outcome == Some(Outcome::Missed);
        assert_eq!(missed, flag(expect, "missed"), "{case}");
        if let Some(lateral) = expect["lateral_cm"].as_f64() {
            let PlaneCrossing::Crossed { lateral_m } = plane else { panic!("no crossing in {case}") };
            close(lateral_m * 100.0, lateral, 1.0, &case);
        }
    }
}

#[test]
fn orbits() {
    for case in cases("orbit", "cases") {
        let centre = point(&case["centre"]);
        let offset = orbit(num(&case, "radius_cm") / 100.0, num(&case, "angle_deg").to_radians()).offset;
        close(offset.x * 100.0, num(&case, "north_cm"), 0.5, &case);
        close(offset.y * 100.0, num(&case, "east_cm"), 0.5, &case);
        close_place(offset_to_latlon(centre, offset), point(&case["target"]), centre, &case);
    }
    for case in cases("orbit", "rate") {
        let mut params = Params::default();
        set(&mut params, "ap_max_turn_rate", &case, "turn_rate_dps");
        set(&mut params, "ap_max_angle", &case, "max_angle_deg");
        let speed = num(&case, "leg_speed_cms") / 100.0;
        let rate = pattern_rate_rps(num(&case, "radius_cm") / 100.0, speed, &params);
        let want = num(&case, "effective_rate_dps");
        close(rate.to_degrees(), want, want * 2e-3, &case);
        close(std::f64::consts::TAU / rate, num(&case, "lap_s"), num(&case, "lap_s") * 2e-3, &case);
    }
    for case in cases("orbit", "timeline") {
        let angle = (num(&case, "turn_rate_dps") * num(&case, "t_s")).rem_euclid(360.0);
        close_angle(angle, num(&case, "angle_deg"), 1e-6, &case);
    }
}

#[test]
fn figures_of_eight() {
    for case in cases("figure8", "cases") {
        let centre = point(&case["centre"]);
        let at = figure8(num(&case, "width_cm") / 100.0, num(&case, "phase_deg").to_radians());
        close(at.offset.x * 100.0, num(&case, "north_cm"), 0.5, &case);
        close(at.offset.y * 100.0, num(&case, "east_cm"), 0.5, &case);
        close_angle(at.heading_rad.to_degrees(), num(&case, "heading_deg"), 0.5, &case);
        close_place(offset_to_latlon(centre, at.offset), point(&case["target"]), centre, &case);
    }
}

#[test]
fn hold_timers() {
    for case in cases("hold_timer", "cases") {
        let duration = num(&case, "duration_ds") as u16;
        let elapsed = SimTime::from_secs_f64(num(&case, "elapsed_s")).0;
        assert_eq!(hold_expired(duration, elapsed), flag(&case, "expired"), "{case}");
        let remaining = u64::from(hold_remaining_ds(duration, elapsed));
        assert_eq!(Some(remaining), case["remaining_ds"].as_u64(), "{case}");
        let mut facts = Facts { hold_elapsed_us: elapsed, ..Facts::default() };
        facts.waypoint.kind = WaypointType::Hold;
        facts.waypoint.duration_ds = duration;
        let over = transition(NavState::Holding, &facts).outcome.is_some();
        assert_eq!(over, flag(&case, "expired"), "guard in {case}");
    }
}

#[test]
fn l1_law() {
    for case in cases("l1", "cases") {
        let limits = L1Limits {
            period_s: num(&case, "period_ds") / 10.0,
            min_lookahead_m: num(&case, "min_lookahead_cm") / 100.0,
            max_lookahead_m: num(&case, "max_lookahead_cm") / 100.0,
            max_cross_track_m: num(&case, "max_xte_cm") / 100.0,
        };
        let position = metres(&case["position"]);
        let got =
            l1(metres(&case["start"]), metres(&case["end"]), position, metres(&case["velocity"]), &limits);
        let expect = &case["expect"];
        let mode = if text(expect, "mode") == "TRACK" { L1Mode::Track } else { L1Mode::Direct };
        assert_eq!(got.mode, mode, "{case}");
        let aim = metres(&expect["aim"]);
        assert!((got.aim - aim).norm() <= (aim.norm() * 5e-4).max(0.01), "aim {} in {case}", got.aim);
        for (value, key) in [
            (got.length_m, "length_cm"),
            (got.along_m, "along_cm"),
            (got.xte_m, "xte_cm"),
            (got.lookahead_m, "lookahead_cm"),
            (got.effective_lookahead_m, "effective_lookahead_cm"),
        ] {
            if let Some(want) = expect[key].as_f64() {
                close(value * 100.0, want, (want.abs() * 5e-4).max(1.0), &case);
            }
        }
        if let Some(reanchor) = expect["reanchor"].as_bool() {
            assert_eq!(got.reanchor, reanchor, "{case}");
        }
        if let Some(bearing) = expect["bearing_to_aim_deg"].as_f64() {
            let to_aim = got.aim - position;
            close_angle(to_aim.y.atan2(to_aim.x).to_degrees(), bearing, 0.1, &case);
        }
        if let Some(eta) = expect["eta_deg"].as_f64() {
            close_angle(got.eta_rad.unwrap().to_degrees(), eta, 0.1, &case);
            let want = num(expect, "a_lat_cms2");
            close(got.a_lat_mps2 * 100.0, want, (want.abs() * 5e-3).max(1.0), &case);
        }
    }
}

#[test]
fn l1_arcs() {
    for case in cases("l1_arc", "cases") {
        let leg = num(&case, "leg_bearing_deg").to_radians();
        let rate = num(&case, "turn_rate_dps").to_radians();
        let arc = CornerArc::begin(num(&case, "course_deg").to_radians(), leg, rate);
        assert_eq!(arc.is_some(), flag(&case, "arc"), "{case}");
        if let (Some(mut arc), Some(want)) = (arc, case["bearing_after_0_1s"].as_f64()) {
            let goes_on = arc.advance(0.1, leg);
            assert!(goes_on, "{case}");
            let got = arc.bearing_rad.to_degrees();
            let other_way = num(&case, "change_deg").abs() == 180.0;
            let mirrored = 2.0 * num(&case, "course_deg") - want;
            let want = if other_way && (got - 180.0) > 0.0 { mirrored } else { want };
            close_angle(got, want, 0.05, &case);
        }
    }
}

#[test]
fn speed_demands() {
    for case in cases("speed_demand", "cases") {
        let mut params = Params::default();
        set(&mut params, "ap_position_p", &case, "position_p");
        set(&mut params, "ap_max_angle", &case, "max_angle_deg");
        let leg = num(&case, "leg_speed_cms") / 100.0;
        let got = match text(&case, "kind") {
            "pass" => leg,
            _ => stop_speed_mps(num(&case, "distance_cm") / 100.0, leg, &params),
        };
        let want = num(&case, "speed_cms");
        close(got * 100.0, want, (want * 5e-3).max(1.0), &case);
    }
    for case in cases("speed_demand", "leg_speed") {
        let mut params = Params::default();
        set(&mut params, "ap_max_velocity", &case, "max_velocity_cms");
        let got = leg_speed_mps(num(&case, "waypoint_speed_cms") as u16, &params);
        close(got * 100.0, num(&case, "leg_speed_cms"), 1.0, &case);
    }
    for case in cases("speed_demand", "build_up_accel") {
        let mut params = Params::default();
        set(&mut params, "ap_velocity_buildup_max_pitch", &case, "buildup_max_pitch_deg");
        set(&mut params, "ap_max_angle", &case, "max_angle_deg");
        let want = num(&case, "accel_cms2");
        close(params.build_up_accel_mps2() * 100.0, want, (want * 5e-3).max(1.0), &case);
    }
}

#[test]
fn landing_profiles() {
    for case in cases("landing_profile", "cases") {
        let (altitude, low) = (num(&case, "altitude_cm") / 100.0, num(&case, "landing_altitude_m"));
        let t = num(&case, "t_s");
        let start = num(&case, "start_altitude_cm") / 100.0;
        let setpoint = landing_setpoint_m(start, num(&case, "descent_rate_cms") / 100.0, t, altitude, low);
        close(setpoint * 100.0, num(&case, "setpoint_cm"), 1.0, &case);
        let mut params = Params { landing_spiral_enable: flag(&case, "spiral_enable"), ..Params::default() };
        set(&mut params, "ap_landing_spiral_radius", &case, "spiral_radius_cm");
        set(&mut params, "ap_landing_spiral_rate", &case, "spiral_rate_dps");
        set(&mut params, "ap_landing_altitude_m", &case, "landing_altitude_m");
        let offset = Spiral::from_params(&params)
            .map_or(Vector2::zeros(), |spiral| spiral_offset(&spiral, t, altitude));
        close(offset.x * 100.0, num(&case, "offset_north_cm"), 0.5, &case);
        close(offset.y * 100.0, num(&case, "offset_east_cm"), 0.5, &case);
    }
}

#[test]
fn touchdowns() {
    for case in cases("touchdown", "cases") {
        let mut params = Params::default();
        set(&mut params, "ap_landing_altitude_m", &case, "landing_altitude_m");
        set(&mut params, "ap_landing_velocity_threshold", &case, "velocity_threshold_cms");
        set(&mut params, "ap_landing_throttle_threshold", &case, "throttle_threshold_us");
        set(&mut params, "ap_landing_descent_rate", &case, "descent_rate_cms");
        let facts = TouchdownFacts::new(
            &params,
            num(&case, "hover_throttle_us"),
            num(&case, "altitude_cm") / 100.0,
            num(&case, "ground_speed_cms") / 100.0,
            num(&case, "throttle_us"),
            num(&case, "climb_rate_cms") / 100.0,
        );
        let want = ["altitude", "speed", "throttle", "not_descending"]
            .map(|condition| flag(&case["conditions"], condition));
        assert_eq!(facts.conditions(), want, "{case}");
        assert_eq!(want.iter().all(|holds| *holds), flag(&case, "all"));
        let held = Facts { touchdown: facts, touchdown_held_us: Some(9_000_000), ..Facts::default() };
        let touched = transition(NavState::Landing, &held).outcome == Some(Outcome::Touchdown);
        assert_eq!(touched, flag(&case, "all"), "guards in {case}");
    }
    for case in cases("touchdown", "timer") {
        let mut timer = TouchdownTimer::default();
        let mut facts =
            Facts { detection_time_ds: num(&case, "detection_time_ds") as u8, ..Facts::default() };
        let at = case["samples"].as_array().unwrap().iter().find_map(|sample| {
            let (t, holds) = (sample[0].as_f64().unwrap(), sample[1].as_bool().unwrap());
            facts.touchdown_held_us = timer.update(SimTime::from_secs_f64(t), holds);
            let altitude_m = if holds { -1.0 } else { 1.0 };
            facts.touchdown = TouchdownFacts {
                altitude_m,
                max_speed_mps: 1.0,
                max_throttle_us: 1.0,
                min_climb_mps: -1.0,
                ..TouchdownFacts::default()
            };
            transition(NavState::Landing, &facts).outcome.map(|_| t)
        });
        assert_eq!(at, case["touchdown_at_s"].as_f64(), "{case}");
    }
}

#[test]
fn altitude_throttle() {
    for case in cases("altitude_throttle", "cases") {
        let mut params = Params::default();
        set(&mut params, "ap_altitude_p", &case, "altitude_p");
        set(&mut params, "ap_altitude_d", &case, "altitude_d");
        set(&mut params, "ap_altitude_f", &case, "altitude_f");
        set(&mut params, "min_check", &case, "min_check_us");
        let terms = ThrottleTerms {
            error_cm: num(&case, "altitude_error_cm"),
            integral_us: num(&case, "integral_us"),
            setpoint_rate_cms: num(&case, "setpoint_rate_cms"),
            climb_rate_cms: num(&case, "climb_rate_cms"),
            hover_us: num(&case, "hover_throttle_us"),
            cos_tilt: num(&case, "cos_tilt"),
        };
        let throttle =
            terms.throttle_us(&params).clamp(num(&case, "throttle_min_us"), num(&case, "throttle_max_us"));
        close(throttle, num(&case, "throttle_us"), 0.5, &case);
        close(throttle_share(throttle, &params), num(&case, "out"), 0.001, &case);
    }
}

#[test]
fn yaw() {
    for case in cases("yaw", "cases") {
        let mut params = Params::default();
        set(&mut params, "ap_yaw_p", &case, "yaw_p");
        set(&mut params, "ap_yaw_d", &case, "yaw_d");
        let facts = YawFacts {
            heading_rad: num(&case, "heading_deg").to_radians(),
            yaw_rate_rps: num(&case, "yaw_rate_dps").to_radians(),
            course_rad: num(&case, "course_deg").to_radians(),
            ground_speed_mps: num(&case, "ground_speed_cms") / 100.0,
            bearing_rad: num(&case, "bearing_deg").to_radians(),
            distance_m: num(&case, "distance_cm") / 100.0,
            acceptance_radius_m: num(&case, "acceptance_radius_cm") / 100.0,
        };
        let mode = YawMode::iter().find(|mode| mode.to_string() == text(&case, "mode")).unwrap();
        let trusted = num(&case, "ground_speed_cms") >= num(&case, "min_forward_velocity_cms");
        let desired = desired_heading(mode, &facts, trusted);
        assert_eq!(desired.is_some(), !case["desired_deg"].is_null(), "{case}");
        let cap = num(&case, "yaw_rate_cap_dps");
        let limit = if cap > 0.0 { cap } else { f64::INFINITY }.min(num(&case, "max_yaw_rate_dps"));
        let rate = desired.map_or(0.0, |desired| {
            close_angle(desired.to_degrees(), num(&case, "desired_deg"), 0.1, &case);
            yaw_rate_dps(desired, &facts, num(&case, "ramp"), limit, &params)
        });
        close(rate, num(&case, "rate_dps"), 0.05, &case);
    }
}

fn fence_action(case: &Value, key: &str) -> FenceAction {
    FenceAction::iter().find(|action| action.to_string() == text(case, key)).unwrap()
}

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
        let facts = FenceFacts {
            limit_m: (limit > 0.0).then_some(limit),
            distance_m: flag(&case, "home").then_some(num(&case, "distance_cm") / 100.0),
            state: state(text(&case, "state")),
            source: if flag(&case, "injected") { PlanSource::Rth } else { PlanSource::Stored },
            action: fence_action(&case, "action"),
        };
        let got = match in_flight(&facts) {
            None => "none",
            Some(FenceAction::Land) => "EMERGENCY_LAND",
            Some(FenceAction::Rth) => "RETURN_TO_HOME",
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
            plan: check_records(num(&case, "count") as usize, records.take(40)),
            fence: pre_flight(limit_m, flag(&case, "home"), kinds),
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
    Some(Waypoint {
        position: LatLon::new(num(value, "lat") as i32, num(value, "lon") as i32),
        alt_cm: num(value, "alt") as i32,
        speed_cms: num(value, "speed") as u16,
        duration_ds: num(value, "duration") as u16,
        kind: WaypointType::from_str(text(value, "type")).ok()?,
        pattern: HoldPattern::from_str(text(value, "pattern")).ok()?,
    })
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
    for case in cases("plan_validation", "is_valid_index") {
        let valid = is_valid_index(num(&case, "count") as usize, num(&case, "index") as usize);
        assert_eq!(valid, flag(&case, "expect"), "{case}");
    }
}

#[test]
fn earth_and_body() {
    for case in cases("earth_to_body", "cases") {
        let ne = Vector2::new(num(&case, "north"), num(&case, "east"));
        let body = earth_to_body(ne, num(&case, "heading_deg").to_radians());
        close(body.x, num(&case, "forward"), 0.001, &case);
        close(body.y, num(&case, "right"), 0.001, &case);
    }
}

/// Facts of a `state_transitions` case.
fn transition_facts(case: &Value) -> Facts {
    let input = &case["input"];
    let cm = |key: &str| input[key].as_f64().map(|value| value / 100.0);
    let is = |key: &str| input[key].as_bool().unwrap_or(false);
    let mut facts = Facts { fix: flag(input, "fix"), count: num(case, "count") as u8, ..Facts::default() };
    let waypoint = &mut facts.waypoint;
    waypoint.kind = WaypointType::from_str(text(case, "type")).unwrap();
    waypoint.pattern = input["pattern"].as_str().map_or(HoldPattern::None, |name| name.parse().unwrap());
    waypoint.duration_ds = input["duration_ds"].as_u64().unwrap_or(0) as u16;
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
    facts.touchdown = TouchdownFacts {
        max_speed_mps: 1.0,
        max_throttle_us: 1.0,
        landing_altitude_m: 1.0,
        min_climb_mps: -1.0,
        ..TouchdownFacts::default()
    };
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
        let expect = &case["expect"];
        let after = decision.outcome.map_or(before, Outcome::state);
        assert_eq!(after, state(text(expect, "state")), "{case} gave {decision:?}");
        let index = num(&case, "index") as u64;
        let index_after = match decision.outcome {
            Some(Outcome::Next) => index + 1,
            Some(Outcome::Fence(_)) => 0,
            Some(_) | None => index,
        };
        assert_eq!(Some(index_after), expect["index"].as_u64(), "{case}");
        if let Some(reason) = expect["reason"].as_str() {
            assert_eq!(decision.reason, reason, "{case}");
        }
        let missed = decision.outcome == Some(Outcome::Missed);
        assert_eq!(missed, expect["missed"].as_bool().unwrap_or(false), "{case}");
        let disarms = decision.outcome == Some(Outcome::Touchdown);
        assert_eq!(disarms, expect["disarm"] == "LANDING", "{case}");
        if let Some(plan) = expect["active_plan"].as_array() {
            let want = if plan.len() == 1 { FenceAction::Land } else { FenceAction::Rth };
            assert_eq!(decision.outcome, Some(Outcome::Fence(want)), "{case}");
        }
    }
}
