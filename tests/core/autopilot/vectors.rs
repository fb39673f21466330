//! Every group of the autopilot's test vectors, checked against the functions that the navigator uses.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may stop at a surprise and say what it measured"
)]

mod control;
mod decisions;
mod earth;
mod guidance;
mod landing;
mod machine;

use betadeck_core::autopilot::params::Params;
use betadeck_core::geo::LatLon;
use betadeck_core::telemetry::{FenceAction, NavState};
use nalgebra::Vector2;
use serde_json::Value;
use strum::IntoEnumIterator;

fn group(name: &str) -> Value {
    let path = test_support::path("tests/vectors/autopilot.json");
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

/// Converts a pair of centimetres to metres.
fn metres(value: &Value) -> Vector2<f64> {
    Vector2::new(value[0].as_f64().unwrap(), value[1].as_f64().unwrap()) / 100.0
}

fn state(name: &str) -> NavState {
    NavState::iter().find(|state| state.to_string() == name).unwrap()
}

fn set(params: &mut Params, name: &str, case: &Value, key: &str) {
    (Params::field(name).unwrap().set)(params, case[key].as_i64().unwrap());
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

fn fence_action(case: &Value, key: &str) -> FenceAction {
    FenceAction::iter().find(|action| action.to_string() == text(case, key)).unwrap()
}

/// Checks that every list of cases of every group is read by a test here or in the tests of the navigator.
#[test]
fn no_group_is_left_out() {
    let here = [
        include_str!("vectors/control.rs"),
        include_str!("vectors/decisions.rs"),
        include_str!("vectors/earth.rs"),
        include_str!("vectors/guidance.rs"),
        include_str!("vectors/landing.rs"),
        include_str!("vectors/machine.rs"),
        include_str!("navigator/vectors.rs"),
    ]
    .concat();
    let path = test_support::path("tests/vectors/autopilot.json");
    let all: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let groups = all.as_object().unwrap().iter().filter(|(_, group)| group["section"].is_string());
    let lists: Vec<(&String, &String)> = groups
        .flat_map(|(name, group)| {
            let lists = group.as_object().unwrap().iter().filter(|(_, list)| list.is_array());
            lists.map(move |(list, _)| (name, list))
        })
        .collect();
    assert!(lists.len() >= 22 + 8, "{lists:?}");
    for (group, list) in lists {
        let reads = ["cases", "vectors"].map(|read| format!("{read}(\"{group}\", \"{list}\")"));
        assert!(reads.iter().any(|read| here.contains(read)), "{group}.{list} has no test");
    }
}
