//! Pressure and positions of the packets against the section `environment` of `tests/vectors/sim.json`.

use betadeck::geo::LocalFrame;
use betadeck::link::conventions::Dialect;
use betadeck::link::proto::fdm;
use nalgebra::Vector3;
use serde_json::Value;

/// Returns the rows of a list of the section.
fn rows(list: &str) -> Vec<Value> {
    let vectors: Value =
        serde_json::from_str(include_str!("../../vectors/sim.json")).expect("the vectors are JSON");
    vectors["environment"][list].as_array().expect("a list").clone()
}

fn num(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("not a number: {value}"))
}

fn vec3(value: &Value) -> Vector3<f64> {
    Vector3::from_iterator(value.as_array().expect("three numbers").iter().map(num))
}

#[track_caller]
fn close(got: f64, want: f64, tolerance: f64) {
    assert!((got - want).abs() <= tolerance, "{got} instead of {want}, off by {:e}", got - want);
}

/// Panics unless `got` is as close to `want` as `relative` allows.
#[track_caller]
fn near(got: f64, want: f64, relative: f64) {
    close(got, want, relative * want.abs());
}

/// The pressure in the packets to a SITL, as a stock executable reads and shows it.
#[test]
fn pressure_of_the_doors_as_an_executable_shows_it() {
    for row in rows("isa") {
        let h = num(&row["h"]);
        near(fdm::pressure_pa(h), num(&row["sitl_formula_Pa"]), 1e-9);
        let whole = fdm::pressure_pa(h).trunc();
        let shown_cm = (1.0 - (whole / 101_325.0).powf(0.190_295)) * 4_433_000.0;
        close(shown_cm, num(&row["bf_altitude_cm_from_int"]), 1e-6);
        // One pascal, and 0.03 % between the two formulas.
        close(shown_cm / 100.0, h, 0.11 + 4e-4 * h.abs());
    }
}

/// gz-math 7 turns the plane by 180°. Mirrored about home, its positions are the true ones.
#[test]
fn mirrored_positions_of_gz_math_are_the_true_ones() {
    for row in rows("geodesy") {
        let (home, enu, wire) = (vec3(&row["home"]), vec3(&row["enu"]), vec3(&row["gz_math7_local_lla"]));
        assert!(Dialect::GzPlugin.mirrors());
        let (lat, lon) = (fdm::mirrored(home.x, wire.x), fdm::mirrored(home.y, wire.y));
        let off = LocalFrame::new(home.x, home.y, home.z).to_enu(lat, lon, wire.z) - enu;
        let scale = (enu.xy().norm() / 250.0).powi(2).max(0.05);
        // Twice the curvature that the radii formula leaves out, once on each side of home.
        assert!(off.xy().norm() < 0.013 * scale, "{} m off at {enu:?}", off.xy().norm());
        assert!(off.z.abs() < 0.0055 * scale, "{} m high at {enu:?}", off.z);
    }
}
