//! Commands and complete sequences of states, from the test vectors.

use betadeck_core::autopilot::control::FlightControllers;
use betadeck_core::autopilot::io::NavInputs;
use betadeck_core::autopilot::{Navigator, Params};
use betadeck_core::geo::offset_to_latlon;
use betadeck_core::plan::WaypointType::{Flyover, Hold, Land};
use betadeck_core::plan::{Altitude, FlightPlan, Seconds, Waypoint, WaypointType};
use betadeck_core::signals::SimTime;
use betadeck_core::telemetry::{NavState, Refusal};
use nalgebra::Vector2;
use serde_json::Value;

use crate::autopilot::flight::{Flight, HOME, guide, inputs, plan, waypoint};
use crate::autopilot::navigator::{flying, three};

fn vectors(group: &str, list: &str) -> Vec<Value> {
    let path = test_support::path("tests/vectors/autopilot.json");
    let all: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    all[group][list].as_array().unwrap().clone()
}

fn reason_of(refusal: Refusal) -> String {
    refusal.to_string()
}

fn check_expectation(nav: &Navigator, expect: &Value, case: &Value) {
    if let Some(state) = expect["state"].as_str() {
        assert_eq!(nav.state().to_string(), state, "{case}");
    }
    if let Some(index) = expect["index"].as_u64() {
        assert_eq!(u64::from(nav.telemetry().wp), index, "{case}");
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

/// Moves the craft onto its waypoint and over its plane in three updates, so that the navigator leaves
/// APPROACHING.
fn pass(
    nav: &mut Navigator,
    at: &mut NavInputs,
    stored: &FlightPlan,
    params: &Params,
    controllers: &mut FlightControllers,
) {
    let target = stored.waypoints[usize::from(nav.telemetry().wp)].position;
    let place = betadeck_core::geo::local_offset(HOME, target);
    for step in [Vector2::new(-1.0, 0.0), Vector2::new(0.5, 0.0), Vector2::new(0.5, 0.0)] {
        at.time = SimTime(at.time.0 + 10_000);
        at.pos_ne = place + step;
        nav.update(at, params, stored, controllers);
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
                    // A plan cannot hold more than 30 waypoints. A damaged count is caught where the plan is
                    // read.
                    let fault = betadeck_core::plan::validate::check_records(count as usize, []);
                    assert!(matches!(fault, Err(betadeck_core::plan::validate::PlanFault::Corrupt(255))));
                    continue;
                }
                let stored = plan(&stored.waypoints[..count as usize]);
                let mut nav = Navigator::new();
                let at = NavInputs { fix: case["fix"].as_bool().unwrap(), ..inputs() };
                let verdict = nav.reset(&at, &params, &stored);
                let reason = verdict.err().map(reason_of);
                assert_eq!(reason.as_deref(), expect["reason"].as_str(), "{case}");
                nav.update(&at, &params, &stored, &mut FlightControllers::default());
                check_expectation(&nav, expect, &case);
            }
            "advance" => {
                let index = case["index"].as_u64().unwrap() as u8;
                let (mut nav, mut at, mut controllers) = flying(index, &stored, &params);
                pass(&mut nav, &mut at, &stored, &params, &mut controllers);
                check_expectation(&nav, expect, &case);
            }
            "emergency_land" => {
                let (mut nav, mut at, _) = flying(1, &stored, &params);
                if case["state_before"] == "LANDING" {
                    nav.emergency_land(&at).unwrap();
                    at.pos_ne = Vector2::new(30.0, 7.0);
                }
                nav.emergency_land(&at).unwrap();
                check_expectation(&nav, expect, &case);
                let here = offset_to_latlon(HOME, at.pos_ne);
                assert_eq!(nav.active_plan().waypoints[0].position, here);
                assert_eq!(nav.active_plan().waypoints[0].kind, Land);
            }
            "return_to_home" => {
                let (mut nav, mut at, mut controllers) = flying(1, &stored, &params);
                at.alt_m = 33.0;
                at.pos_ne = Vector2::new(50.0, 50.0);
                nav.return_to_home(&at, &params, None).unwrap();
                nav.update(&at, &params, &stored, &mut controllers);
                check_expectation(&nav, expect, &case);
                let kinds: Vec<_> = nav.active_plan().waypoints.iter().map(|wp| wp.kind).collect();
                assert_eq!(kinds, [Flyover, Land]);
                assert!(
                    nav.active_plan()
                        .waypoints
                        .iter()
                        .all(|wp| wp.altitude == Altitude::above_home(33.0) && wp.position == HOME)
                );
            }
            "resume" => {
                let index = case["index"].as_u64().unwrap() as u8;
                let (mut nav, mut controllers) = (Navigator::new(), FlightControllers::default());
                let mut at = inputs();
                if case["started"] == true {
                    (nav, at, controllers) = flying(index, &stored, &params);
                }
                if case["state_before"] == "COMPLETE" {
                    pass(&mut nav, &mut at, &stored, &params, &mut controllers);
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
                let (mut nav, at, _) = flying(0, &stored, &params);
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
                    assert_eq!(u64::from(nav.telemetry().wp), start);
                    nav.disengage();
                    nav.on_disarm();
                    nav.engage(&at, &params, &stored).unwrap();
                    assert_eq!(nav.telemetry().wp, 0, "only once");
                }
            }
            other => panic!("unknown command {other}"),
        }
    }
}

/// Builds a waypoint from the words of the `sequences` group. `index` gives its place.
fn from_words(words: &str, index: usize) -> Waypoint {
    let mut parts = words.split_whitespace();
    let kind: WaypointType = parts.next().unwrap().parse().unwrap();
    let mut record = waypoint(kind, 30.0 * (index as f64 + 1.0), 0.0, 20.0, 5.0);
    if let Some(pattern) = parts.next() {
        record.pattern = pattern.parse().unwrap();
    }
    if let Some(duration) = parts.next() {
        record.duration = Seconds::new(duration.parse::<f64>().unwrap() / 10.0);
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
