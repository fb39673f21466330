//! Tests of the position controller.

use super::*;
use proptest::prelude::*;

const DT: f64 = 0.01;
const LAWS: [PositionLaw; 2] = [PositionLaw::Speed, PositionLaw::Direct];

/// Returns a level craft at the origin that moves to the north with this velocity, m/s, and acceleration, m/s².
fn level_craft(velocity: f64, accel: f64) -> PositionMeasurement {
    PositionMeasurement {
        position: Vector2::zeros(),
        velocity: Vector2::new(velocity, 0.0),
        accel: Vector2::new(accel, 0.0),
        tilt_body: Vector2::zeros(),
        heading_rad: 0.0,
    }
}

/// Returns the tilt to the north, degrees, of a level craft `seconds` after it was sent to a place `north_m` ahead.
fn tilt_deg(
    controller: &mut PositionController,
    now: &PositionMeasurement,
    north_m: f64,
    law: PositionLaw,
    seconds: f64,
) -> f64 {
    let params = Params::default();
    let target = PositionTarget { law, ..PositionTarget::stay(Vector2::new(north_m, 0.0), &params) };
    let steps = (seconds / DT).round() as usize;
    let tilts = (0..steps).map(|_| controller.update(now, &target, &params, DT));
    tilts.last().unwrap_or_default().x.to_degrees()
}

#[test]
fn a_craft_leans_against_the_speed_and_the_acceleration_that_carry_it_away() {
    for law in LAWS {
        for (velocity, accel) in [(1.0, 0.0), (0.0, 2.0)] {
            let mut controller = PositionController::default();
            let carried = level_craft(velocity, accel);
            controller.engage(&carried);
            let tilt = tilt_deg(&mut controller, &carried, 0.0, law, 2.0);
            assert!(tilt < -0.5, "{law:?}, {velocity} m/s, {accel} m/s²: {tilt}°");
        }
    }
}

#[test]
fn the_tilt_learned_against_a_lasting_error_fades_while_the_pilot_flies() {
    let still = level_craft(0.0, 0.0);
    for law in LAWS {
        let mut held_back = PositionController::default();
        held_back.engage(&still);
        tilt_deg(&mut held_back, &still, 1.0, law, 10.0);
        let tilt_after = |pilot_s: f64| {
            let mut controller = held_back.clone();
            for _ in 0..(pilot_s / DT).round() as usize {
                controller.track(&still, DT);
            }
            tilt_deg(&mut controller, &still, 0.0, law, 1.5)
        };
        let (learned, left) = (tilt_after(0.05), tilt_after(10.0));
        assert!(learned > 2.0, "{law:?}: {learned}°");
        assert!((0.0..0.2 * learned).contains(&left), "{law:?}: {left}° of {learned}°");
        held_back.engage(&still);
        let engaged = tilt_deg(&mut held_back, &still, 0.0, law, 1.5);
        assert!(engaged.abs() < 0.1, "{law:?}: {engaged}° after the craft was taken over");
    }
}

#[test]
fn a_craft_leans_into_its_speeding_up_before_it_lags_behind() {
    let params =
        Params { velocity_p: 0, velocity_i: 0, velocity_d: 0, velocity_drag_coeff: 0, ..Params::default() };
    let still = level_craft(0.0, 0.0);
    let mut controller = PositionController::default();
    controller.engage(&still);
    let law = PositionLaw::Speed;
    let target = PositionTarget { law, ..PositionTarget::stay(Vector2::new(500.0, 0.0), &params) };
    let tilt = (0..200).map(|_| controller.update(&still, &target, &params, DT)).last().unwrap_or_default();
    let expected = (params.build_up_accel_mps2() / GRAVITY).atan();
    assert!((tilt.x - expected).abs() < 0.05 * expected && tilt.y.abs() < 1e-9, "{tilt} {expected}");
}

#[test]
fn a_lasting_speed_error_leans_the_craft_a_little_more_every_second() {
    let params = Params { velocity_i: 20, ..Params::default() };
    let target =
        PositionTarget { law: PositionLaw::Speed, ..PositionTarget::stay(Vector2::new(500.0, 0.0), &params) };
    let mut controller =
        PositionController { velocity_setpoint: Vector2::new(4.0, 0.0), ..PositionController::default() };
    for _ in 0..100 {
        controller.integrate(&level_craft(3.0, 0.0), &target, &params, DT);
    }
    let learned = controller.speed_integral.map(f64::to_degrees);
    assert!((learned - Vector2::new(2.0, 0.0)).norm() < 1e-9, "{learned}");
}

#[test]
fn a_lasting_error_on_a_pattern_is_learned_but_not_the_way_to_the_pattern() {
    let params = Params::default();
    let still = level_craft(0.0, 0.0);
    // An orbit of 20 m to the north, with its centre in the east.
    let learned = |off_m: f64| {
        let mut controller = PositionController::default();
        controller.engage(&still);
        let target = PositionTarget {
            target_velocity: Vector2::new(5.0, 0.0),
            target_accel: Vector2::new(0.0, 1.25),
            ..PositionTarget::stay(Vector2::new(0.0, off_m), &params)
        };
        for _ in 0..100 {
            controller.trim_pattern(&still, &target, &params, DT);
        }
        controller.pattern_trim
    };
    for off_m in [-9.5, -1.0, 1.0, 9.5] {
        let trim = learned(off_m);
        // It leads by the turn of the pattern while the craft answers to it.
        assert!(trim.y * off_m > 0.0 && trim.x * off_m < 0.0, "{off_m} m inward: {trim}");
    }
    for off_m in [-10.5, 10.5, 50.0] {
        assert_eq!(learned(off_m), Vector2::zeros(), "{off_m} m inward");
    }
}

proptest! {
    #[test]
    fn body_and_earth_are_inverse(n in -50.0..50.0, e in -50.0..50.0, heading in -7.0..7.0) {
        let ne = Vector2::new(n, e);
        prop_assert!((body_to_earth(earth_to_body(ne, heading), heading) - ne).norm() < 1e-9);
    }
}
