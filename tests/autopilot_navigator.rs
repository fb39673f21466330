//! The navigator as a whole: commands, sequences of states, overlays, fence, return home, losses, overrides.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may stop at a surprise and say what it measured"
)]

#[path = "autopilot_support/flight.rs"]
mod flight;

use std::path::Path;

use betadeck::autopilot::io::{AbortReason, L1Mode, NavEvent, NavInputs, NavState, PlanSource, Refusal};
use betadeck::autopilot::params::{FenceAction, YawMode};
use betadeck::autopilot::{Navigator, Params, Rescue};
use betadeck::geo::{LatLon, distance_bearing, offset_to_latlon};
use betadeck::plan::{FlightPlan, HoldPattern, Waypoint, WaypointType};
use betadeck::signals::SimTime;
use flight::{Flight, HOME, guide, inputs, plan, waypoint, worst};
use nalgebra::Vector2;
use serde_json::Value;

use WaypointType::{AltChange, Delay, Flyby, Flyover, Hold, Land, Takeoff, YawRate};

fn vectors(group: &str, list: &str) -> Vec<Value> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/vectors/autopilot.json");
    let all: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    all[group][list].as_array().unwrap().clone()
}

/// Three FLYOVERs on a line north.
fn three() -> FlightPlan {
    plan(&[60.0, 120.0, 180.0].map(|north| waypoint(Flyover, north, 0.0, 20.0, 5.0)))
}

fn reason_of(refusal: Refusal) -> String {
    refusal.to_string()
}

fn check_expectation(nav: &Navigator, expect: &Value, case: &Value) {
    if let Some(state) = expect["state"].as_str() {
        assert_eq!(nav.state().to_string(), state, "{case}");
    }
    if let Some(index) = expect["index"].as_u64() {
        assert_eq!(u64::from(nav.index()), index, "{case}");
    }
    if let Some(next) = expect["next_index"].as_u64() {
        assert_eq!(u64::from(nav.telemetry().next_wp), next, "{case}");
    }
    if let Some(valid) = expect["valid"].as_bool() {
        assert_eq!(nav.is_flying(), valid, "{case}");
    }
    if let Some(count) = expect["active_count"].as_u64() {
        assert_eq!(nav.active_plan().waypoints.len() as u64, count, "{case}");
    }
}

/// A navigator that flies `three` and stands before waypoint `index`.
fn flying(index: u8, stored: &FlightPlan, params: &Params) -> (Navigator, NavInputs) {
    let mut nav = Navigator::new();
    let mut at = inputs();
    nav.engage(&at, params, stored).unwrap();
    assert!(index == 0 || nav.set_current(index, &at, params, stored));
    at.time = SimTime(at.time.0 + 10_000);
    nav.update(&at, params, stored);
    (nav, at)
}

/// Moves the craft onto its waypoint and over its plane, update by update, until it leaves APPROACHING for the next.
fn pass(nav: &mut Navigator, at: &mut NavInputs, stored: &FlightPlan, params: &Params) {
    let target = stored.waypoints[usize::from(nav.index())].position;
    let place = betadeck::geo::local_offset(HOME, target);
    for step in [Vector2::new(-1.0, 0.0), Vector2::new(0.5, 0.0), Vector2::new(0.5, 0.0)] {
        at.time = SimTime(at.time.0 + 10_000);
        at.pos_ne = place + step;
        nav.update(at, params, stored);
    }
}

#[test]
fn commands_of_the_vectors() {
    let params = Params::default();
    for case in vectors("state_transitions", "commands") {
        let expect = &case["expect"];
        let stored = three();
        match case["command"].as_str().unwrap() {
            "reset" => {
                let count = case["plan_count"].as_u64().unwrap();
                if count > 30 {
                    // A plan cannot hold more than 30; a damaged count is caught where it is read.
                    let fault = betadeck::plan::validate::check_records(count as usize, []);
                    assert!(matches!(fault, Err(betadeck::plan::validate::PlanFault::Corrupt(255))));
                    continue;
                }
                let stored = plan(&stored.waypoints[..count as usize]);
                let mut nav = Navigator::new();
                let at = NavInputs { fix: case["fix"].as_bool().unwrap(), ..inputs() };
                let verdict = nav.reset(&at, &params, &stored);
                let reason = verdict.err().map(reason_of);
                assert_eq!(reason.as_deref(), expect["reason"].as_str(), "{case}");
                nav.update(&at, &params, &stored);
                check_expectation(&nav, expect, &case);
            }
            "advance" => {
                let index = case["index"].as_u64().unwrap() as u8;
                let (mut nav, mut at) = flying(index, &stored, &params);
                pass(&mut nav, &mut at, &stored, &params);
                check_expectation(&nav, expect, &case);
            }
            "emergency_land" => {
                let (mut nav, mut at) = flying(1, &stored, &params);
                if case["state_before"] == "LANDING" {
                    nav.emergency_land(&at, &params).unwrap();
                    at.pos_ne = Vector2::new(30.0, 7.0);
                }
                nav.emergency_land(&at, &params).unwrap();
                check_expectation(&nav, expect, &case);
                let here = offset_to_latlon(HOME, at.pos_ne);
                assert_eq!(nav.active_plan().waypoints[0].position, here);
                assert_eq!(nav.active_plan().waypoints[0].kind, Land);
            }
            "return_to_home" => {
                let (mut nav, mut at) = flying(1, &stored, &params);
                at.alt_m = 33.0;
                at.pos_ne = Vector2::new(50.0, 50.0);
                nav.return_to_home(&at, &params, None).unwrap();
                nav.update(&at, &params, &stored);
                check_expectation(&nav, expect, &case);
                let kinds: Vec<_> = nav.active_plan().waypoints.iter().map(|wp| wp.kind).collect();
                assert_eq!(kinds, [Flyover, Land]);
                assert!(
                    nav.active_plan().waypoints.iter().all(|wp| wp.alt_cm == 3300 && wp.position == HOME)
                );
            }
            "resume" => {
                let index = case["index"].as_u64().unwrap() as u8;
                let mut nav = Navigator::new();
                let mut at = inputs();
                if case["started"] == true {
                    (nav, at) = flying(index, &stored, &params);
                }
                if case["state_before"] == "COMPLETE" {
                    pass(&mut nav, &mut at, &stored, &params);
                    assert_eq!(nav.state(), NavState::Complete);
                }
                nav.disengage();
                assert_eq!(nav.state(), NavState::Idle);
                let stored = if case["plan_changed"] == true {
                    plan(&[60.0, 120.0, 190.0].map(|north| waypoint(Flyover, north, 0.0, 20.0, 5.0)))
                } else {
                    stored
                };
                nav.engage(&at, &params, &stored).unwrap();
                check_expectation(&nav, expect, &case);
            }
            "set_current" => {
                let (mut nav, at) = flying(0, &stored, &params);
                if case["flying"] == false {
                    nav.disengage();
                }
                if case["injected"] == true {
                    nav.return_to_home(&at, &params, None).unwrap();
                }
                let argument = case["argument"].as_u64().unwrap() as u8;
                let accepted = nav.set_current(argument, &at, &params, &stored);
                assert_eq!(accepted, expect["accepted"].as_bool().unwrap(), "{case}");
                if accepted {
                    check_expectation(&nav, expect, &case);
                }
                if let Some(start) = expect["starts_at"].as_u64() {
                    nav.engage(&at, &params, &stored).unwrap();
                    assert_eq!(u64::from(nav.index()), start);
                    nav.disengage();
                    nav.on_disarm();
                    nav.engage(&at, &params, &stored).unwrap();
                    assert_eq!(nav.index(), 0, "only once");
                }
            }
            other => panic!("unknown command {other}"),
        }
    }
}

/// A waypoint from the words of the `sequences` group, `index` giving its place.
fn from_words(words: &str, index: usize) -> Waypoint {
    let mut parts = words.split_whitespace();
    let kind: WaypointType = parts.next().unwrap().parse().unwrap();
    let mut record = waypoint(kind, 30.0 * (index as f64 + 1.0), 0.0, 20.0, 5.0);
    if let Some(pattern) = parts.next() {
        record.pattern = pattern.parse().unwrap();
    }
    if let Some(duration) = parts.next() {
        record.duration_ds = duration.parse().unwrap();
    }
    record
}

#[test]
fn sequences_of_the_vectors() {
    for case in vectors("sequences", "cases") {
        let words: Vec<&str> = case["plan"].as_array().unwrap().iter().map(|w| w.as_str().unwrap()).collect();
        let home = words[0].ends_with("@home");
        let waypoints: Vec<Waypoint> = if home {
            vec![waypoint(Hold, 60.0, 30.0, 20.0, 5.0)]
        } else {
            words.iter().enumerate().map(|(index, words)| from_words(words, index)).collect()
        };
        let mut flight = Flight::new(guide(), &waypoints, 20.0).launch();
        if home {
            flight.run(15.0);
            flight.events.clear();
            flight.nav.return_to_home(&flight.inputs, &flight.params, None).unwrap();
        }
        flight.run(120.0);
        let got: Vec<_> =
            flight.sequence().iter().map(|(state, wp)| serde_json::json!([state.to_string(), wp])).collect();
        assert_eq!(&got, case["sequence"].as_array().unwrap(), "{case}");
    }
}

#[test]
fn arrived_and_holding_before_a_pattern_last_one_update() {
    let mut hold = waypoint(Hold, 20.0, 0.0, 20.0, 5.0);
    hold.pattern = HoldPattern::Orbit;
    hold.duration_ds = 50;
    let mut flight = Flight::new(guide(), &[hold, waypoint(Flyover, 60.0, 0.0, 20.0, 5.0)], 20.0).launch();
    flight.run(40.0);
    let at = |state, wp| flight.entered(state, wp).unwrap();
    let arrived = at(NavState::Arrived, 0);
    assert!((at(NavState::Holding, 0) - arrived - 0.01).abs() < 1e-9);
    assert!((at(NavState::Orbiting, 0) - arrived - 0.02).abs() < 1e-9);
    assert!((at(NavState::Approaching, 1) - at(NavState::Holding, 0) - 5.0).abs() < 1e-9);
}

#[test]
fn every_state_event_carries_the_guard_that_fired() {
    let mut hold = waypoint(Hold, 20.0, 0.0, 20.0, 5.0);
    hold.duration_ds = 10;
    let waypoints = [waypoint(Flyby, 10.0, 0.0, 20.0, 5.0), hold, waypoint(Land, 30.0, 0.0, 20.0, 5.0)];
    let mut flight = Flight::new(guide(), &waypoints, 20.0).launch();
    assert!(flight.until(120.0, |f| f.disarmed));
    let fired: Vec<(&str, NavState)> = flight
        .events
        .iter()
        .filter_map(|(_, event)| match event {
            NavEvent::State { guard: Some(guard), to, .. } => {
                assert!(guard.holds() && guard.margin() >= 0.0, "{guard:?}");
                Some((guard.name, *to))
            }
            _ => None,
        })
        .collect();
    assert_eq!(
        fired,
        [
            ("turn radius", NavState::Arrived),
            ("arrival", NavState::Arrived),
            ("hold time", NavState::Approaching),
            ("arrival", NavState::Arrived),
            ("touchdown time", NavState::Complete),
        ]
    );
}

#[test]
fn climbing_comes_before_the_first_leg() {
    let mut flight = Flight::new(guide(), &[waypoint(Flyover, 60.0, 0.0, 20.0, 5.0)], 2.0);
    flight.hover(5.0);
    flight.engage();
    flight.run(0.02);
    assert!(flight.nav.telemetry().climbing);
    assert_eq!(flight.nav.telemetry().guards[1].name, "climb");
    assert!(flight.until(30.0, |f| !f.nav.telemetry().climbing));
    assert!(flight.plant.pos.norm() < 0.3 && flight.plant.alt >= 5.0, "it climbed on the spot");
    let events: Vec<_> = flight
        .events
        .iter()
        .filter_map(|(_, event)| if let NavEvent::Climbing(on) = event { Some(*on) } else { None })
        .collect();
    assert_eq!(events, [true, false]);
    assert!(flight.until(60.0, |f| f.nav.state() == NavState::Complete));
}

#[test]
fn a_low_waypoint_does_not_climb_again() {
    let waypoints = [waypoint(Flyover, 60.0, 0.0, 3.0, 5.0), waypoint(Hold, 90.0, 0.0, 3.0, 5.0)];
    let mut flight = Flight::new(guide(), &waypoints, 20.0).launch();
    flight.run(60.0);
    assert!(!flight.events.iter().any(|(_, event)| matches!(event, NavEvent::Climbing(_))));
    assert!((flight.plant.alt - 3.0).abs() < 0.5);
}

#[test]
fn takeoff_climbs_where_it_stands() {
    let mut takeoff = waypoint(Takeoff, 900.0, 900.0, 15.0, 0.0);
    takeoff.duration_ds = 20;
    let waypoints = [takeoff, waypoint(Hold, 30.0, 0.0, 15.0, 5.0)];
    let mut flight = Flight::new(guide(), &waypoints, 1.5);
    flight.hover(5.0);
    flight.engage();
    assert!(flight.until(40.0, |f| f.nav.index() == 1));
    assert!(flight.plant.pos.norm() < 0.3 && (flight.plant.alt - 15.0).abs() < 2.0);
    let waited = flight.t() - flight.entered(NavState::Holding, 0).unwrap();
    assert!((waited - 2.0).abs() < 1e-9);
    assert!(flight.until(40.0, |f| f.nav.state() == NavState::Holding));
}

#[test]
fn a_missed_flyover_is_come_back_to() {
    let params = Params { waypoint_arrival_radius: 100, ..guide() };
    let waypoints = [waypoint(Flyover, 60.0, 0.0, 20.0, 5.0), waypoint(Flyover, 60.0, 60.0, 20.0, 5.0)];
    let mut flight = Flight::new(params, &waypoints, 20.0).launch();
    flight.run(8.0);
    // Blown 10 m beside, it passes the plane far from the point.
    for _ in 0..1000 {
        if flight.plant.pos.x > 60.1 {
            break;
        }
        flight.plant.pos.y = 10.0;
        flight.tick();
    }
    assert_eq!((flight.nav.state(), flight.nav.index()), (NavState::Approaching, 0));
    assert!(flight.until(40.0, |f| f.nav.index() == 1));
    let at = flight.log.last().unwrap().pos;
    assert!((at - Vector2::new(60.0, 0.0)).norm() < 1.2, "{at}");
}

fn fence_flight(action: FenceAction) -> Flight {
    let params = Params { max_distance_from_home: 100, geofence_action: action, ..guide() };
    let mut flight = Flight::new(params, &[waypoint(Hold, 80.0, 0.0, 30.0, 5.0)], 30.0).launch();
    assert!(flight.until(40.0, |f| f.nav.state() == NavState::Holding));
    flight.run(5.0);
    flight.inputs.stick_pitch = 500.0;
    assert!(flight.until(40.0, |f| f.nav.source() != PlanSource::Stored));
    flight.inputs.stick_pitch = 0.0;
    flight
}

#[test]
fn leaving_the_fence_lands() {
    let mut flight = fence_flight(FenceAction::Land);
    let before = flight.plan.clone();
    let trigger = flight.log[flight.log.len() - 1].pos;
    assert!((100.0..100.2).contains(&trigger.x), "{trigger}");
    assert_eq!(flight.nav.state(), NavState::Landing);
    assert!(flight.until(120.0, |f| f.disarmed));
    assert!((flight.plant.pos - trigger).norm() <= 2.0);
    assert!(worst(flight.log.iter().map(|s| s.pos.norm())) <= 120.0);
    assert_eq!(flight.plan, before);
    let fences = flight.events.iter().filter(|(_, event)| matches!(event, NavEvent::Geofence { .. })).count();
    assert_eq!(fences, 1);
}

#[test]
fn leaving_the_fence_returns_home() {
    let mut flight = fence_flight(FenceAction::Rth);
    let began = flight.t();
    assert_eq!((flight.nav.state(), flight.nav.index()), (NavState::Approaching, 0));
    let altitudes: Vec<_> = flight.nav.active_plan().waypoints.iter().map(|wp| wp.alt_cm).collect();
    assert!(altitudes.iter().all(|alt| (alt - 3000).abs() <= 50), "{altitudes:?}");
    assert!(flight.until(60.0, |f| f.nav.state() == NavState::Arrived));
    assert!((12.0..=24.0).contains(&(flight.t() - began)), "{}", flight.t() - began);
    assert!(flight.until(120.0, |f| f.disarmed));
    assert!(flight.plant.pos.norm() <= 1.0);
}

#[test]
fn a_plan_outside_the_fence_is_refused_once_with_its_distance() {
    let params = Params { max_distance_from_home: 100, ..guide() };
    let stored = plan(&[waypoint(Flyover, 150.0, 0.0, 20.0, 5.0)]);
    let mut nav = Navigator::new();
    for _ in 0..10 {
        nav.update(&inputs(), &params, &stored);
        let refusal = nav.engage(&inputs(), &params, &stored).unwrap_err();
        assert!(matches!(refusal, Refusal::Geofence { wp: 0, distance_cm: 14_990..=15_010, limit_m: 100 }));
    }
    assert_eq!(nav.state(), NavState::Idle);
    assert_eq!(nav.drain_events().count(), 1);
    nav.update(&inputs(), &params, &stored);
    assert!(nav.telemetry().refusal.is_some());
}

#[test]
fn return_home_flies_straight_and_lands() {
    for (north, east) in [(0.0, 0.0), (-3.5, -3.5)] {
        let hold = [waypoint(Hold, 100.0, 50.0, 20.0, 5.0)];
        let mut flight = Flight::new(guide(), &hold, 20.0).wind(north, east, 0.0).launch();
        assert!(flight.until(60.0, |f| f.nav.state() == NavState::Holding));
        flight.run(5.0);
        let began = flight.t();
        flight.nav.return_to_home(&flight.inputs, &flight.params, None).unwrap();
        assert!(flight.until(60.0, |f| f.nav.index() == 1));
        assert!((12.0..=26.0).contains(&(flight.t() - began)));
        let along = Vector2::new(100.0, 50.0).normalize();
        let beside = worst(flight.since(began + 5.0).map(|s| (s.pos - along * s.pos.dot(&along)).norm()));
        assert!(beside <= 5.0, "{beside}");
        assert!(flight.until(120.0, |f| f.disarmed));
        assert!(flight.plant.pos.norm() <= 1.5);
    }
}

#[test]
fn a_rescue_climbs_first() {
    let hold = [waypoint(Hold, 60.0, 0.0, 20.0, 5.0)];
    let mut flight = Flight::new(guide(), &hold, 20.0).launch();
    assert!(flight.until(60.0, |f| f.nav.state() == NavState::Holding));
    let rescue = Rescue { altitude_m: 45.0, climb_mps: 3.0, speed_mps: 7.5, descend_mps: 1.5 };
    flight.nav.return_to_home(&flight.inputs, &flight.params, Some(rescue)).unwrap();
    let began = flight.t();
    flight.run(1.0);
    assert!(flight.nav.telemetry().climbing && flight.nav.active_plan().waypoints.len() == 2);
    assert!(flight.until(40.0, |f| !f.nav.telemetry().climbing));
    assert!((flight.plant.pos.x - 60.0).abs() < 2.5 && flight.plant.alt >= 44.0);
    assert!(flight.t() - began > 24.0 / 3.0);
    assert!(flight.until(60.0, |f| f.nav.state() == NavState::Landing));
    let landing = flight.t();
    assert!(flight.until(60.0, |f| f.plant.alt < 4.0));
    let rate = 41.0 / (flight.t() - landing);
    assert!((1.3..=1.6).contains(&rate), "{rate}");
    assert!(flight.until(60.0, |f| f.disarmed));
    assert!(flight.plant.impact_mps.unwrap() <= 0.8);
}

#[test]
fn return_home_without_a_home_lands_here() {
    let mut nav = Navigator::new();
    let at = NavInputs { home: None, ..inputs() };
    nav.return_to_home(&at, &Params::default(), None).unwrap();
    assert_eq!((nav.state(), nav.source()), (NavState::Landing, PlanSource::Emergency));
}

#[test]
fn commands_need_an_armed_craft_with_a_fix() {
    let mut nav = Navigator::new();
    let params = Params::default();
    let no_fix = NavInputs { fix: false, ..inputs() };
    assert_eq!(nav.emergency_land(&no_fix, &params), Err(Refusal::NoFix));
    let disarmed = NavInputs { armed: false, ..inputs() };
    assert_eq!(nav.return_to_home(&disarmed, &params, None), Err(Refusal::NotArmed));
    assert_eq!(nav.state(), NavState::Idle);
}

#[test]
fn a_lost_fix_idles_and_resumes_two_seconds_after_it_is_back() {
    let stored = three();
    let params = Params::default();
    let (mut nav, mut at) = flying(1, &stored, &params);
    let mut tick = |nav: &mut Navigator, fix: bool| {
        at.time = SimTime(at.time.0 + 10_000);
        at.fix = fix;
        let engaged = nav.engage(&at, &params, &stored);
        nav.update(&at, &params, &stored);
        engaged
    };
    tick(&mut nav, false).unwrap();
    assert_eq!((nav.state(), nav.telemetry().reason), (NavState::Idle, "GPS_LOST"));
    for _ in 0..50 {
        assert_eq!(tick(&mut nav, false), Err(Refusal::Aborted(AbortReason::GpsLost)));
    }
    let mut waited = 0;
    while tick(&mut nav, true).is_err() {
        waited += 1;
        assert!(waited < 300);
    }
    assert!((199..=202).contains(&waited), "{waited}");
    assert_eq!((nav.state(), nav.index()), (NavState::Approaching, 1));
}

#[test]
fn clearing_the_stored_plan_in_flight_ends_the_mission_and_editing_does_not() {
    let stored = three();
    let params = Params::default();
    let (mut nav, at) = flying(0, &stored, &params);
    let edited = plan(&[waypoint(Hold, 1.0, 1.0, 1.0, 1.0)]);
    nav.update(&at, &params, &edited);
    assert_eq!(nav.active_plan(), &stored);
    nav.update(&at, &params, &FlightPlan::default());
    assert_eq!((nav.state(), nav.telemetry().reason), (NavState::Idle, "NO_PLAN"));
    let away = NavInputs { pos_ne: Vector2::new(50.0, 0.0), ..at };
    nav.return_to_home(&away, &params, None).unwrap();
    nav.update(&away, &params, &FlightPlan::default());
    assert_eq!(nav.state(), NavState::Approaching, "an injected plan does not depend on the stored one");
}

#[test]
fn a_stalled_craft_gives_up_until_the_switch_is_cycled() {
    let stored = three();
    let params = Params::default();
    let (mut nav, mut at) = flying(0, &stored, &params);
    let began = at.time;
    while nav.is_flying() {
        at.time = SimTime(at.time.0 + 10_000);
        nav.update(&at, &params, &stored);
        assert!(at.time.seconds_since(began) < 31.0);
    }
    assert!((at.time.seconds_since(began) - 30.0).abs() < 0.05);
    let stalled = Err(Refusal::Aborted(AbortReason::Stalled));
    assert_eq!(nav.engage(&at, &params, &stored), stalled);
    nav.disengage();
    assert_eq!(nav.engage(&at, &params, &stored), Ok(()));
}

#[test]
fn a_craft_that_flies_away_gives_up_but_not_while_the_pilot_flies() {
    let stored = three();
    let params = Params::default();
    for (stick, aborts) in [(0.0, true), (300.0, false)] {
        let (mut nav, mut at) = flying(0, &stored, &params);
        at.stick_roll = stick;
        for step in 0..400 {
            at.time = SimTime(at.time.0 + 10_000);
            at.pos_ne = Vector2::new(-0.1 * f64::from(step), 0.0);
            nav.update(&at, &params, &stored);
        }
        assert_eq!(nav.telemetry().reason == "FLYAWAY", aborts);
    }
}

#[test]
fn sticks_override_and_release_returns_to_the_line() {
    let waypoints = [waypoint(Flyover, 10.0, 0.0, 20.0, 5.0), waypoint(Flyover, 200.0, 0.0, 20.0, 5.0)];
    let mut flight = Flight::new(guide(), &waypoints, 20.0).launch();
    assert!(flight.until(30.0, |f| f.plant.pos.x > 60.0));
    flight.inputs.stick_roll = 500.0;
    flight.run(2.0);
    assert!(flight.nav.telemetry().stick_override);
    assert!((flight.log.last().unwrap().out.roll_rad.to_degrees() - 25.0).abs() < 0.1);
    assert!((flight.plant.alt - 20.0).abs() < 1.6, "the altitude is still the autopilot's");
    flight.inputs.stick_roll = 0.0;
    let moved = flight.plant.pos.y;
    assert!(moved > 2.0);
    assert!(flight.until(40.0, |f| f.plant.pos.x > 180.0));
    assert!(flight.plant.pos.y.abs() < 1.0, "{}", flight.plant.pos.y);
    assert_eq!(flight.nav.index(), 1);
}

#[test]
fn the_throttle_stick_is_no_input_and_the_yaw_stick_takes_only_yaw() {
    let mut flight = Flight::new(guide(), &[waypoint(Hold, 0.0, 0.0, 20.0, 0.0)], 20.0).launch();
    flight.inputs.stick_yaw = 200.0;
    flight.run(1.0);
    let telemetry = flight.nav.telemetry();
    assert!(telemetry.yaw_override && !telemetry.stick_override && telemetry.output.yaw_rate_rps.is_none());
}

#[test]
fn modifiers_change_the_next_leg() {
    let mut slow = waypoint(Delay, 0.0, 0.0, 0.0, 0.0);
    slow.duration_ds = 300;
    let mut cap = waypoint(YawRate, 0.0, 0.0, 0.0, 0.0);
    cap.speed_cms = 5;
    let waypoints = [
        waypoint(Flyover, 0.0, 40.0, 20.0, 5.0),
        waypoint(AltChange, 0.0, 0.0, 26.0, 0.0),
        slow,
        cap,
        waypoint(Hold, 60.0, 40.0, 20.0, 5.0),
    ];
    let mut flight = Flight::new(guide(), &waypoints, 20.0).launch();
    assert!(flight.until(60.0, |f| f.nav.index() == 4));
    let began = flight.t();
    assert!(flight.until(60.0, |f| f.nav.state() == NavState::Holding));
    let took = flight.t() - began;
    assert!((26.0..=33.0).contains(&took), "{took}");
    assert!((flight.plant.alt - 26.0).abs() < 0.5);
    let yaw = worst(flight.since(began).map(|s| s.out.yaw_rate_rps.unwrap().abs().to_degrees()));
    assert!(yaw <= 5.0 + 1e-9, "{yaw}");
}

#[test]
fn a_plan_of_modifiers_completes_at_once() {
    let stored = plan(&[waypoint(AltChange, 0.0, 0.0, 30.0, 0.0)]);
    let mut nav = Navigator::new();
    nav.engage(&inputs(), &Params::default(), &stored).unwrap();
    assert_eq!(nav.state(), NavState::Complete);
}

#[test]
fn disarming_forgets_the_index_and_a_touchdown_shows_until_the_next_arming() {
    let stored = three();
    let params = Params::default();
    let (mut nav, mut at) = flying(2, &stored, &params);
    at.armed = false;
    nav.update(&at, &params, &stored);
    assert_eq!(nav.state(), NavState::Idle);
    at.armed = true;
    nav.engage(&at, &params, &stored).unwrap();
    assert_eq!(nav.index(), 0);

    let mut flight = Flight::new(guide(), &[waypoint(Land, 0.0, 0.0, 6.0, 0.0)], 6.0).launch();
    assert!(flight.until(60.0, |f| f.disarmed));
    flight.nav.on_disarm();
    flight.inputs.armed = false;
    flight.run(1.0);
    assert_eq!(flight.nav.state(), NavState::Complete);
    assert!(!flight.nav.is_flying() && !flight.nav.telemetry().engaged);
    flight.inputs.armed = true;
    flight.tick();
    assert_eq!(flight.nav.state(), NavState::Idle);
}

#[test]
fn complete_in_the_air_stays_parked() {
    let mut flight = Flight::new(guide(), &[waypoint(Flyover, 40.0, 0.0, 20.0, 5.0)], 20.0).launch();
    assert!(flight.until(60.0, |f| f.nav.state() == NavState::Complete));
    let at = flight.t();
    flight.run(45.0);
    assert!(flight.nav.is_flying());
    let off = worst(flight.since(at + 12.0).map(|s| (s.pos - Vector2::new(40.0, 0.0)).norm()));
    assert!(off <= 1.0, "{off}");
}

#[test]
fn an_offset_leg_is_cut_into_and_a_far_one_starts_anew() {
    let mut flight = Flight::new(
        guide(),
        &[waypoint(Flyover, 10.0, 0.0, 20.0, 5.0), waypoint(Flyover, 210.0, 0.0, 20.0, 5.0)],
        20.0,
    )
    .launch();
    assert!(flight.until(60.0, |f| f.plant.pos.x > 70.0));
    flight.plant.pos.y = 20.0;
    let (from, x) = (flight.t(), flight.plant.pos.x);
    assert!(flight.until(60.0, |f| f.plant.pos.y.abs() < 2.0));
    assert!(flight.t() - from <= 14.0 && flight.plant.pos.x - x <= 60.0, "{} s", flight.t() - from);
    let began = flight.t();
    flight.run(10.0);
    assert!(-worst(flight.since(began).map(|s| -s.pos.y)) >= -2.0);
    flight.params.l1_max_cross_track_error = 1000;
    flight.plant.pos.y = 30.0;
    flight.run(0.05);
    let start = flight.nav.telemetry().leg_start.unwrap();
    assert!((distance_bearing(start, offset_to_latlon(HOME, flight.plant.pos)).0) < 1.0);
    assert_eq!(flight.nav.telemetry().l1_mode, L1Mode::Track);
}

#[test]
fn yaw_follows_the_course_in_velocity_mode_and_the_point_in_bearing_mode() {
    for (mode, east) in [(YawMode::Velocity, 60.0), (YawMode::Bearing, 60.0)] {
        let params = Params { yaw_mode: mode, ..guide() };
        let mut flight = Flight::new(params, &[waypoint(Hold, 0.0, east, 20.0, 5.0)], 20.0).launch();
        assert!(flight.until(60.0, |f| f.plant.pos.y > 40.0));
        assert!((flight.plant.heading.to_degrees() - 90.0).abs() < 5.0, "{mode}: {}", flight.plant.heading);
    }
}

#[test]
fn nothing_but_finite_numbers_comes_out_of_broken_inputs() {
    let stored = three();
    let params = Params::default();
    let (mut nav, good) = flying(0, &stored, &params);
    let mut at = good.clone();
    at.alt_m = f64::NAN;
    at.climb_mps = f64::INFINITY;
    at.heading_rad = f64::NAN;
    at.cos_tilt = f64::NAN;
    at.accel_ne = Vector2::repeat(f64::NAN);
    at.throttle_us = f64::NAN;
    at.dt = f64::NAN;
    for _ in 0..5 {
        let out = nav.update(&at, &params, &stored);
        assert!((out.roll_rad + out.pitch_rad + out.throttle + out.yaw_rate_rps.unwrap()).is_finite());
    }
    let out = nav.update(&good, &params, &stored);
    assert!(out.throttle.is_finite() && nav.state() == NavState::Approaching);
    at.pos_ne.x = f64::NAN;
    nav.update(&at, &params, &stored);
    assert_eq!((nav.state(), nav.telemetry().reason), (NavState::Idle, "GPS_LOST"));
}

#[test]
fn legs_cross_the_antimeridian() {
    let origin = LatLon::new(100_000_000, 1_799_999_000);
    let record = |east: f64| Waypoint {
        position: offset_to_latlon(origin, Vector2::new(0.0, east)),
        ..waypoint(Flyover, 0.0, 0.0, 20.0, 5.0)
    };
    let stored = plan(&[record(50.0), record(100.0)]);
    assert!(stored.waypoints[0].position.lon_e7 < 0);
    let mut nav = Navigator::new();
    let at = NavInputs { origin, home: Some(origin), ..inputs() };
    nav.engage(&at, &Params::default(), &stored).unwrap();
    nav.update(&at, &Params::default(), &stored);
    let telemetry = nav.telemetry();
    assert!((telemetry.distance_m.unwrap() - 50.0).abs() < 0.05);
    assert!((telemetry.bearing_rad.unwrap().to_degrees() - 90.0).abs() < 0.1);
}
