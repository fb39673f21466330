//! The analytic checks of the plant against `tests/vectors/sim.json` (every section but `wire`).

mod airframes;
mod environment;
mod integrator;
mod physics;
mod stand;

use nalgebra::Vector3;
use serde_json::Value;

/// Returns one section of the vectors.
fn section(name: &str) -> Value {
    let vectors: Value =
        serde_json::from_str(include_str!("../../vectors/sim.json")).expect("the vectors are JSON");
    vectors[name].clone()
}

/// Returns one check of the section `physics`.
fn physics(id: &str) -> Value {
    let checks = section("physics");
    let check = checks.as_array().and_then(|checks| checks.iter().find(|check| check["id"] == id));
    check.unwrap_or_else(|| panic!("no check {id}")).clone()
}

fn rows(value: &Value) -> &Vec<Value> {
    value.as_array().unwrap_or_else(|| panic!("not a list: {value}"))
}

fn num(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("not a number: {value}"))
}

fn vec3(value: &Value) -> Vector3<f64> {
    Vector3::from_iterator(rows(value).iter().map(num))
}

#[track_caller]
fn close(got: f64, want: f64, tolerance: f64) {
    assert!((got - want).abs() <= tolerance, "{got} instead of {want}, off by {:e}", got - want);
}

#[track_caller]
fn close3(got: Vector3<f64>, want: Vector3<f64>, tolerance: f64) {
    assert!((got - want).amax() <= tolerance, "{got:?} instead of {want:?}");
}

/// Panics unless `got` is as close to `want` as `relative` allows.
#[track_caller]
fn near(got: f64, want: f64, relative: f64) {
    close(got, want, relative * want.abs());
}
