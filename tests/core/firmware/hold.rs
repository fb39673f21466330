//! ALTHOLD, POS HOLD and the failsafe descent, flown with ordinary sensors.

use crate::firmware::control_support::{Rig, world};
use betadeck_core::firmware::control::hold::{DescentRate, HoldModes};
use betadeck_core::firmware::settings::Settings;
use betadeck_core::sim::{Airframe, Noise, Wind, WorldConfig};
use betadeck_core::telemetry::Turbulence;

fn settings() -> Settings {
    let mut settings = Settings::default();
    for (name, value) in [
        ("ap_hover_throttle", 1500),
        ("ap_max_angle", 25),
        ("ap_altitude_p", 50),
        ("ap_altitude_i", 30),
        ("ap_altitude_d", 20),
        ("ap_altitude_f", 10),
    ] {
        settings.set_number(name, value).expect("in range");
    }
    settings
}

fn windy(noise: Noise, speed_mps: f64) -> WorldConfig {
    let mut config = world(noise, Airframe::iris());
    config.wind = Wind { speed_mps, from_deg: 225.0 };
    if speed_mps > 0.0 {
        config.turbulence = Turbulence::Light;
        config.switches.turbulence_scale = 0.5;
    }
    config
}

#[test]
fn the_place_is_held_in_wind() {
    // The bounds are the rms of the autopilot's hold, plus 1 m and 0.5 m for the GPS and the barometer of
    // ordinary sensors.
    for (noise, wind, horizontal, vertical) in [
        (Noise::None, 0.0, 0.3, 0.3),
        (Noise::None, 5.0, 0.8, 0.5),
        (Noise::Real, 0.0, 1.3, 0.8),
        (Noise::Real, 5.0, 1.8, 0.8),
        (Noise::Real, 8.0, 2.3, 0.8),
    ] {
        let mut rig = Rig::airborne(windy(noise, wind), &settings());
        rig.run(15.0);
        let (place, altitude) = (rig.position_ne(), rig.altitude_m());
        let (mut squares, mut farthest_up, mut steps): (f64, f64, f64) = (0.0, 0.0, 0.0);
        rig.watch(60.0, |rig| {
            squares += (rig.position_ne() - place).norm_squared();
            farthest_up = farthest_up.max((rig.altitude_m() - altitude).abs());
            steps += 1.0;
        });
        let rms = (squares / steps).sqrt();
        println!("{noise} {wind} m/s: {rms:.2} m rms, altitude within {farthest_up:.2} m");
        assert!(rms < horizontal, "{noise} {wind} m/s: {rms}");
        assert!(farthest_up < vertical, "{noise} {wind} m/s: {farthest_up}");
    }
}

#[test]
fn a_released_stick_stops_the_craft_for_good() {
    let mut rig = Rig::airborne(windy(Noise::Real, 0.0), &settings());
    rig.sticks.stick_pitch = 300.0;
    rig.run(4.0);
    let speed = rig.truth().vel_enu.norm();
    assert!(speed > 4.0, "{speed}");
    rig.sticks.stick_pitch = 0.0;
    let released = rig.position_ne();
    let mut farthest: f64 = 0.0;
    rig.watch(8.0, |rig| farthest = farthest.max((rig.position_ne() - released).norm()));
    let parked = rig.position_ne();
    println!("released at {speed:.1} m/s: {farthest:.1} m to the stop");
    assert!(farthest - (parked - released).norm() < 1.5, "comes back from {farthest} m");
    rig.watch(10.0, |rig| assert!((rig.position_ne() - parked).norm() < 1.5));
}

#[test]
fn the_throttle_stick_climbs_and_sinks() {
    let mut rig = Rig::airborne(windy(Noise::Real, 0.0), &settings());
    for (stick, rate) in [(1700.0, 1.25), (1200.0, -2.92)] {
        rig.sticks.throttle_us = stick;
        rig.run(4.0);
        let before = rig.altitude_m();
        rig.run(1.0);
        let climbed = rig.altitude_m() - before;
        println!("stick {stick}: {climbed:.2} m/s");
        assert!((climbed - rate).abs() < 0.7, "stick {stick}: {climbed} instead of {rate} m/s");
        rig.sticks.throttle_us = 1500.0;
        rig.run(8.0);
        assert!(rig.truth().vel_enu.z.abs() < 0.3, "{}", rig.truth().vel_enu.z);
    }
}

#[test]
fn the_failsafe_descent_lands_softly_and_says_so() {
    for (noise, wind) in [(Noise::None, 0.0), (Noise::Real, 3.0)] {
        let mut rig = Rig::airborne(windy(noise, wind), &Settings::default());
        rig.run(5.0);
        rig.modes = HoldModes { altitude: true, position: true, descend: Some(DescentRate::Failsafe) };
        let (mut seconds, mut impact) = (0.0, 0.0);
        while !rig.hold.touchdown && seconds < 60.0 {
            rig.run(0.05);
            seconds += 0.05;
            if !rig.truth().on_ground {
                assert!(!rig.hold.touchdown, "touchdown in the air");
                impact = -rig.truth().vel_enu.z;
            }
        }
        println!("{noise} {wind} m/s: down after {seconds:.1} s, touched at {impact:.2} m/s");
        assert!(rig.hold.touchdown && rig.truth().on_ground && !rig.truth().crashed);
        assert!((10.0..45.0).contains(&seconds), "{seconds}");
        assert!(impact < 1.6, "{impact}");
    }
}

#[test]
fn without_a_fix_the_position_is_left_to_the_pilot() {
    use betadeck_core::sim::{Fault, WorldCommand};
    let mut rig = Rig::airborne(windy(Noise::Real, 3.0), &settings());
    rig.world.apply(WorldCommand::FaultOn(Fault::GpsLoss, Some(6.0))).expect("a valid fault");
    let altitude = rig.altitude_m();
    rig.run(1.0);
    assert!(rig.hold.no_position && rig.hold.tilt.is_none() && rig.hold.throttle.is_some());
    let mut worst: f64 = 0.0;
    rig.watch(4.0, |rig| {
        worst = rig.tilt_deg().iter().fold(worst, |most, angle| most.max(angle.abs()));
        assert!((rig.altitude_m() - altitude).abs() < 2.0);
    });
    assert!(worst < 3.0, "{worst}");
    rig.run(8.0);
    assert!(!rig.hold.no_position);
}

#[test]
fn the_hover_throttle_of_any_airframe_is_found() {
    // The default hover throttle fits neither airframe.
    for airframe in [Airframe::iris(), Airframe::five_inch()] {
        let mut rig = Rig::airborne(world(Noise::Real, airframe), &Settings::default());
        rig.run(25.0);
        let altitude = rig.altitude_m();
        rig.watch(30.0, |rig| {
            assert!((rig.altitude_m() - altitude).abs() < 2.2, "{}", rig.altitude_m() - altitude);
        });
    }
}

#[test]
fn hard_flying_is_never_taken_for_standing() {
    for (airframe, wind, turbulence) in [
        (Airframe::iris(), 0.0, Turbulence::None),
        (Airframe::iris(), 10.0, Turbulence::Moderate),
        (Airframe::five_inch(), 8.0, Turbulence::Severe),
    ] {
        let mut config = world(Noise::Real, airframe);
        (config.wind, config.turbulence) = (Wind { speed_mps: wind, from_deg: 30.0 }, turbulence);
        let mut rig = Rig::airborne(config, &settings());
        for second in 0..90 {
            let part = second % 15;
            // Full speed ahead, then back, and seconds of hover in the wind with a roll to the side between
            // them.
            rig.sticks.stick_pitch =
                [500.0, 500.0, 500.0, -500.0, -500.0].get(part % 11).copied().unwrap_or(0.0);
            rig.sticks.stick_roll = if part == 7 { 500.0 } else { 0.0 };
            rig.sticks.throttle_us = [1500.0, 1850.0, 1200.0][second / 5 % 3];
            rig.watch(1.0, |rig| assert!(!rig.controllers.land.on_ground(), "in the air after {second} s"));
        }
        assert!(!rig.truth().on_ground);
    }
}

#[test]
fn a_position_hold_without_a_source_is_only_levelled() {
    for (source, holds) in [(0, true), (1, true), (2, false)] {
        let mut settings = settings();
        settings.set_number("poshold_position_source", source).expect("in range");
        let mut rig = Rig::airborne(windy(Noise::None, 0.0), &settings);
        rig.run(0.1);
        assert_eq!(rig.hold.tilt.is_some(), holds, "{source}");
        assert_eq!(rig.hold.no_position, !holds, "{source}");
    }
}

#[test]
fn standing_in_position_hold_winds_nothing_up_for_the_lift_off() {
    let mut rig = Rig::new(windy(Noise::Real, 0.0), &settings());
    rig.run(6.0);
    rig.arm();
    rig.modes = HoldModes { altitude: true, position: true, descend: None };
    rig.sticks.throttle_us = 1300.0;
    rig.run(120.0);
    rig.sticks.throttle_us = 1700.0;
    let mut fastest: f64 = 0.0;
    rig.watch(6.0, |rig| fastest = fastest.max(rig.truth().vel_enu.xy().norm()));
    println!("lifted off after two minutes: {fastest:.2} m/s at most");
    assert!(rig.altitude_m() > 1.0 && fastest < 1.0, "{} m up, {fastest} m/s", rig.altitude_m());
}
