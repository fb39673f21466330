//! Tests of the altitude controller.

use super::*;

#[test]
fn only_a_descent_to_a_low_target_is_slowed() {
    let rows = [
        // setpoint, target, maximum speed
        (20.0, 1.0, 5.0),
        (4.0, 1.0, 1.0),
        (1.0, 0.5, 0.3),
        (0.0, -1.0, 0.3),
        (-0.1, -1.0, f64::INFINITY),
        (4.0, -60.0, f64::INFINITY),
        (4.0, 3.0, f64::INFINITY),
        (1.0, 2.0, f64::INFINITY),
    ];
    for (setpoint_m, target_m, speed_mps) in rows {
        assert_eq!(flare_mps(setpoint_m, target_m), speed_mps, "{setpoint_m} m to {target_m} m");
    }
}

const DT: f64 = 0.01;

/// Returns a level craft that neither climbs nor sinks at this altitude, m, and throttle, µs.
fn level_craft(altitude_m: f64, throttle_us: f64) -> AltitudeMeasurement {
    AltitudeMeasurement { altitude_m, climb_mps: 0.0, cos_tilt: 1.0, throttle_us }
}

/// Returns the throttle, µs, after `seconds` with this target.
fn throttle_us(
    controller: &mut AltitudeController,
    now: &AltitudeMeasurement,
    target: AltitudeTarget,
    params: &Params,
    seconds: f64,
) -> f64 {
    let steps = (seconds / DT).round() as usize;
    (0..steps).map(|_| controller.update(now, target, params, DT)).last().unwrap_or_default()
}

#[test]
fn a_hold_after_a_flight_by_the_sticks_begins_without_the_old_integral() {
    let params = Params { altitude_i: 100, ..Params::default() };
    let hovering = level_craft(20.0, 1500.0);
    let mut controller = AltitudeController::default();
    controller.engage(&hovering, &params);
    let held_down = throttle_us(&mut controller, &hovering, AltitudeTarget::Altitude(21.0), &params, 10.0);
    assert!(held_down > 1600.0, "{held_down} µs pull at a craft that is held down");
    for _ in 0..300 {
        controller.track(&hovering, &params, DT);
    }
    controller.engage(&hovering, &params);
    let held = throttle_us(&mut controller, &hovering, AltitudeTarget::Altitude(20.0), &params, 1.5);
    assert!((held - 1500.0).abs() < 15.0, "{held} µs");
}

#[test]
fn a_landing_that_waits_on_the_ground_does_not_forget_the_hover_throttle() {
    let params = Params::default();
    let hovering = level_craft(20.0, 1500.0);
    let mut controller = AltitudeController::default();
    controller.engage(&hovering, &params);
    throttle_us(&mut controller, &hovering, AltitudeTarget::Altitude(20.0), &params, 8.0);
    assert!((controller.hover_us() - 1500.0).abs() < 5.0);
    controller.set_relief_us(50.0);
    let landing = AltitudeTarget::Landing { setpoint_m: -1.5, rate_mps: -0.5 };
    let landed = level_craft(0.0, 1300.0);
    let throttle = throttle_us(&mut controller, &landed, landing, &params, 8.0);
    assert!(throttle < 1400.0, "{throttle} µs");
    assert!((controller.hover_us() - 1500.0).abs() < 5.0, "{} µs", controller.hover_us());
}

#[test]
fn the_damping_grows_beyond_five_metres_a_second() {
    let params = Params { altitude_p: 0, altitude_d: 100, altitude_f: 0, ..Params::default() };
    let throttle = |climb_mps: f64| {
        let terms = ThrottleTerms {
            error_cm: 0.0,
            integral_us: 0.0,
            setpoint_rate_cms: 0.0,
            climb_rate_cms: 100.0 * climb_mps,
            hover_us: 1500.0,
            cos_tilt: 1.0,
        };
        terms.throttle_us(&params) - 1500.0
    };
    assert!((throttle(4.0) + 400.0).abs() < 1e-9);
    assert!((throttle(5.0) + 500.0).abs() < 1e-9);
    // At twice that rate the factor is (3·2 − 2)/2.
    assert!((throttle(10.0) + 2000.0).abs() < 1e-9);
    assert!((throttle(-10.0) - 2000.0).abs() < 1e-9);
}

#[test]
fn a_target_is_a_climb_only_above_the_craft() {
    for (target, climbs) in [
        (AltitudeTarget::Altitude(20.0), false),
        (AltitudeTarget::Altitude(20.2), false),
        (AltitudeTarget::Altitude(20.4), true),
        (AltitudeTarget::Altitude(10.0), false),
        (AltitudeTarget::Rate(0.1), true),
        (AltitudeTarget::Rate(0.0), false),
        (AltitudeTarget::Rate(-1.0), false),
    ] {
        assert_eq!(target.climbs(20.0), climbs, "{target:?}");
    }
}

#[test]
fn the_acceleration_of_the_setpoint_is_filtered() {
    let params = Params::default();
    let hovering = level_craft(20.0, 1500.0);
    let mut controller = AltitudeController::default();
    controller.engage(&hovering, &params);
    controller.update(&hovering, AltitudeTarget::Altitude(20.0), &params, DT);
    let before = controller.setpoint_accel;
    let rate = controller.setpoint_rate;
    controller.update(&hovering, AltitudeTarget::Altitude(60.0), &params, DT);
    let accel = (controller.setpoint_rate - rate) / DT;
    assert!(accel > 0.1, "{accel} m/s²");
    // A first-order filter with a time constant of 0.1 s.
    let expected = before + (accel - before) * DT / (0.1 + DT);
    assert!((controller.setpoint_accel - expected).abs() < 1e-9, "{} m/s²", controller.setpoint_accel);
}

#[test]
fn the_setpoint_brakes_in_time_for_its_target() {
    let params = Params::default();
    for (target_m, sign) in [(35.0, 1.0), (10.0, -1.0)] {
        let mut controller = AltitudeController::default();
        controller.engage(&level_craft(20.0, 1500.0), &params);
        for _ in 0..3000 {
            let before_m = controller.setpoint_m();
            let now = level_craft(before_m, 1500.0);
            controller.update(&now, AltitudeTarget::Altitude(target_m), &params, DT);
            let left_m = sign * (target_m - before_m);
            let speed_mps = sign * (controller.setpoint_m() - before_m) / DT;
            let fastest_mps = (2.0 * SETPOINT_BRAKE * left_m.max(0.0)).sqrt() + 0.2;
            assert!(
                left_m > -0.02 && speed_mps < fastest_mps,
                "{speed_mps} m/s {left_m} m before {target_m} m"
            );
        }
        assert!((controller.setpoint_m() - target_m).abs() < 1e-9, "{} m", controller.setpoint_m());
    }
}

#[test]
fn a_small_lasting_error_moves_the_hover_throttle_and_a_large_one_does_not() {
    let params = Params { altitude_i: 100, ..Params::default() };
    let hovering = level_craft(20.0, 1500.0);
    for (above_m, moves) in [(0.5, true), (-0.5, true), (10.0, false)] {
        let mut controller = AltitudeController::default();
        controller.engage(&hovering, &params);
        throttle_us(&mut controller, &hovering, AltitudeTarget::Altitude(20.0 + above_m), &params, 20.0);
        let moved_us = (controller.hover_us() - 1500.0) * above_m.signum();
        assert_eq!(moved_us > 10.0, moves, "{above_m} m: {moved_us} µs");
        assert!(moves || moved_us.abs() < 5.0, "{above_m} m: {moved_us} µs");
    }
}
