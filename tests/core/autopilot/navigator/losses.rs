//! Losses and failures in flight: a lost fix, a craft without progress, broken inputs.

use betadeck_core::autopilot::control::FlightControllers;
use betadeck_core::autopilot::{Navigator, Params};
use betadeck_core::signals::SimTime;
use betadeck_core::telemetry::{AbortReason, NavState, Refusal, TransitionReason};
use nalgebra::Vector2;

use crate::autopilot::flight::inputs;
use crate::autopilot::navigator::{flying, three};

#[test]
fn a_lost_fix_idles_and_resumes_two_seconds_after_it_is_back() {
    let stored = three();
    let params = Params::default();
    let (mut nav, mut at, mut controllers) = flying(1, &stored, &params);
    let mut tick = |nav: &mut Navigator, fix: bool| {
        at.time = SimTime(at.time.0 + 10_000);
        at.fix = fix;
        let engaged = nav.engage(&at, &params, &stored);
        nav.update(&at, &params, &stored, &mut controllers);
        engaged
    };
    tick(&mut nav, false).unwrap();
    assert_eq!(
        (nav.state(), nav.telemetry().reason),
        (NavState::Idle, Some(TransitionReason::GivenUp(AbortReason::GpsLost)))
    );
    for _ in 0..50 {
        assert_eq!(tick(&mut nav, false), Err(Refusal::Aborted(AbortReason::GpsLost)));
    }
    let mut waited = 0;
    while tick(&mut nav, true).is_err() {
        waited += 1;
        assert!(waited < 300);
    }
    assert!((199..=202).contains(&waited), "{waited}");
    assert_eq!((nav.state(), nav.telemetry().wp), (NavState::Approaching, 1));
}

#[test]
fn a_stalled_craft_gives_up_until_the_switch_is_cycled() {
    let stored = three();
    let params = Params::default();
    let (mut nav, mut at, mut controllers) = flying(0, &stored, &params);
    let began = at.time;
    while nav.is_flying() {
        at.time = SimTime(at.time.0 + 10_000);
        nav.update(&at, &params, &stored, &mut controllers);
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
        let (mut nav, mut at, mut controllers) = flying(0, &stored, &params);
        at.stick_roll = stick;
        for step in 0..400 {
            at.time = SimTime(at.time.0 + 10_000);
            at.pos_ne = Vector2::new(-0.1 * f64::from(step), 0.0);
            nav.update(&at, &params, &stored, &mut controllers);
        }
        assert_eq!(nav.telemetry().reason == Some(TransitionReason::GivenUp(AbortReason::Flyaway)), aborts);
    }
}

#[test]
fn nothing_but_finite_numbers_comes_out_of_broken_inputs() {
    let stored = three();
    let params = Params::default();
    let (mut nav, good, mut controllers) = flying(0, &stored, &params);
    let mut at = good.clone();
    at.alt_m = f64::NAN;
    at.climb_mps = f64::INFINITY;
    at.heading_rad = f64::NAN;
    at.cos_tilt = f64::NAN;
    at.accel_ne = Vector2::repeat(f64::NAN);
    at.throttle_us = f64::NAN;
    at.dt = f64::NAN;
    for _ in 0..5 {
        let out = nav.update(&at, &params, &stored, &mut controllers);
        assert!((out.roll_rad + out.pitch_down_rad + out.throttle + out.yaw_rate_rps.unwrap()).is_finite());
    }
    let out = nav.update(&good, &params, &stored, &mut controllers);
    assert!(out.throttle.is_finite() && nav.state() == NavState::Approaching);
    at.pos_ne.x = f64::NAN;
    nav.update(&at, &params, &stored, &mut controllers);
    assert_eq!(
        (nav.state(), nav.telemetry().reason),
        (NavState::Idle, Some(TransitionReason::GivenUp(AbortReason::GpsLost)))
    );
}

#[test]
fn broken_inputs_while_the_pilot_flies_do_not_reach_the_mission_after_them() {
    let (params, stored, good) = (Params::default(), three(), inputs());
    let mut broken = good.clone();
    broken.climb_mps = f64::NAN;
    broken.throttle_us = f64::NAN;
    broken.vel_ne = Vector2::repeat(f64::NAN);
    let (mut nav, mut controllers) = (Navigator::new(), FlightControllers::default());
    for at in [&good, &broken, &good] {
        nav.update(at, &params, &stored, &mut controllers);
        controllers.track_altitude(at, &params);
        controllers.track_position(at);
    }
    nav.engage(&good, &params, &stored).unwrap();
    for _ in 0..200 {
        let out = nav.update(&good, &params, &stored, &mut controllers);
        assert!((out.roll_rad + out.pitch_down_rad + out.throttle).is_finite(), "{out:?}");
    }
    assert!(controllers.altitude.hover_us() > 1050.0);
    assert!(controllers.position.speed_setpoint_mps() > 0.0);
}

#[test]
fn the_controllers_are_not_touched_by_a_navigator_that_flies_nothing() {
    let (params, stored, at) = (Params::default(), three(), inputs());
    let (mut nav, mut controllers) = (Navigator::new(), FlightControllers::default());
    controllers.engage(&at, &params);
    let before = controllers.clone();
    nav.update(&at, &params, &stored, &mut controllers);
    assert_eq!(controllers, before);
    // A command that is taken back before the next update has not touched the controllers.
    nav.emergency_land(&at).unwrap();
    nav.disengage();
    nav.update(&at, &params, &stored, &mut controllers);
    assert_eq!(controllers, before);
}

#[test]
fn a_craft_up_to_20_m_farther_than_at_its_best_does_not_fly_away() {
    let stored = three();
    let params = Params::default();
    let (mut nav, mut at, mut controllers) = flying(0, &stored, &params);
    for (back_m, flies) in [(19.9, true), (20.1, false)] {
        at.time = SimTime(at.time.0 + 10_000);
        at.pos_ne.x = -back_m;
        nav.update(&at, &params, &stored, &mut controllers);
        assert_eq!(nav.is_flying(), flies, "{back_m} m");
    }
    assert_eq!(nav.telemetry().reason, Some(TransitionReason::GivenUp(AbortReason::Flyaway)));
}

#[test]
fn a_craft_that_comes_less_than_2_m_nearer_in_30_s_makes_no_progress() {
    let stored = three();
    let params = Params::default();
    for (nearer_m, flies) in [(1.9, false), (2.1, true)] {
        let (mut nav, mut at, mut controllers) = flying(0, &stored, &params);
        let (began, from) = (at.time, at.pos_ne.x);
        while at.time.seconds_since(began) < 31.0 {
            at.time = SimTime(at.time.0 + 10_000);
            at.pos_ne.x = from + nearer_m * (at.time.seconds_since(began) / 29.0).min(1.0);
            nav.update(&at, &params, &stored, &mut controllers);
        }
        assert_eq!(nav.is_flying(), flies, "{nearer_m} m nearer");
    }
}
