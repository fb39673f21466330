//! The accuracy of the craft's own motion estimate, with the errors of ordinary sensors and with sensor
//! failures.

use crate::firmware::control_support::{Rig, world};
use betadeck_core::firmware::settings::Settings;
use betadeck_core::sim::{Airframe, Fault, Noise, Wind, WorldCommand, WorldConfig};
use betadeck_core::telemetry::Turbulence;
use nalgebra::{Vector2, Vector3};

/// The greatest errors of a flight.
#[derive(Debug, Default)]
struct Errors {
    /// Tilt, degrees.
    tilt: f64,
    /// Heading, degrees.
    heading: f64,
    /// Position, m, relative to a home that the GPS measured.
    position: f64,
    /// Ground velocity, m/s.
    velocity: f64,
    /// Altitude above home, m.
    altitude: f64,
    /// Climb rate, m/s.
    climb: f64,
}

impl Errors {
    fn look(&mut self, rig: &Rig) {
        let (estimate, truth) = (rig.estimate(), rig.truth());
        let up = |attitude: nalgebra::UnitQuaternion<f64>| attitude.inverse() * Vector3::z();
        let tilt = up(truth.attitude).angle(&up(estimate.attitude)).to_degrees();
        let heading =
            (estimate.heading_rad.to_degrees() - truth.heading_deg() + 540.0).rem_euclid(360.0) - 180.0;
        let velocity = Vector2::new(truth.vel_enu.y, truth.vel_enu.x);
        for (worst, error) in [
            (&mut self.tilt, tilt),
            (&mut self.heading, heading),
            (&mut self.position, (rig.position_ne() - estimate.pos_ne).norm()),
            (&mut self.velocity, (velocity - estimate.vel_ne).norm()),
            (&mut self.altitude, rig.altitude_m() - estimate.alt_m),
            (&mut self.climb, truth.vel_enu.z - estimate.climb_mps),
        ] {
            *worst = worst.max(error.abs());
        }
    }

    fn of(rig: &mut Rig, seconds: f64) -> Self {
        let mut errors = Self::default();
        rig.watch(seconds, |rig| errors.look(rig));
        errors
    }
}

/// Returns the guide's hover throttle and tilt limit. The bounds are stated for a craft with a known hover
/// throttle.
fn settings() -> Settings {
    let mut settings = Settings::default();
    settings.set_number("ap_hover_throttle", 1500).expect("in range");
    settings.set_number("ap_max_angle", 25).expect("in range");
    settings
}

fn rough(seed: u64) -> WorldConfig {
    let mut config = world(Noise::Real, Airframe::iris());
    config.seed = seed;
    config.wind = Wind { speed_mps: 4.0, from_deg: 60.0 * seed as f64 };
    config.turbulence = Turbulence::Light;
    config.switches.turbulence_scale = 0.5;
    config
}

/// Sets the sticks of a pilot who flies hard, by the second.
fn throw_about(rig: &mut Rig, second: u32) {
    let phase = second % 12;
    rig.sticks.stick_pitch = [400.0, -200.0, 0.0][(phase / 4) as usize];
    rig.sticks.stick_roll = match phase {
        3..6 => 300.0,
        9..12 => -300.0,
        _ => 0.0,
    };
    rig.sticks.stick_yaw = if second % 20 < 3 { 150.0 } else { 0.0 };
}

#[test]
fn hovering_with_real_sensors() {
    for seed in 1..=4 {
        let mut rig = Rig::airborne(rough(seed), &settings());
        let errors = Errors::of(&mut rig, 60.0);
        println!("hover seed {seed}: {errors:?}");
        assert!(errors.tilt < 1.5, "seed {seed}: {errors:?}");
        assert!(errors.heading < 3.0, "seed {seed}: {errors:?}");
        assert!(errors.position < 1.25, "seed {seed}: {errors:?}");
        assert!(errors.velocity < 0.2, "seed {seed}: {errors:?}");
        assert!(errors.altitude < 0.5, "seed {seed}: {errors:?}");
        assert!(errors.climb < 0.15, "seed {seed}: {errors:?}");
    }
}

#[test]
fn manoeuvring_with_real_sensors() {
    for seed in 1..=4 {
        let mut rig = Rig::airborne(rough(seed), &settings());
        let mut errors = Errors::default();
        for second in 0..60 {
            throw_about(&mut rig, second);
            rig.watch(1.0, |rig| errors.look(rig));
        }
        println!("manoeuvre seed {seed}: {errors:?}");
        assert!(errors.tilt < 2.0, "seed {seed}: {errors:?}");
        assert!(errors.heading < 3.0, "seed {seed}: {errors:?}");
        assert!(errors.position < 1.5, "seed {seed}: {errors:?}");
        assert!(errors.velocity < 0.25, "seed {seed}: {errors:?}");
    }
}

#[test]
fn exact_sensors_leave_only_the_manoeuvre() {
    let mut rig = Rig::airborne(world(Noise::None, Airframe::iris()), &settings());
    let mut errors = Errors::default();
    for second in 0..60 {
        throw_about(&mut rig, second);
        rig.watch(1.0, |rig| errors.look(rig));
    }
    println!("exact: {errors:?}");
    assert!(errors.tilt < 1.0 && errors.position < 0.2 && errors.velocity < 0.1, "{errors:?}");
    assert!(errors.altitude < 0.05, "{errors:?}");
}

#[test]
fn the_heading_is_known_before_take_off_whatever_it_is() {
    for heading in [0.0, 77.0, 180.0, 301.0] {
        let mut config = world(Noise::Real, Airframe::iris());
        config.home.heading_deg = heading;
        let mut rig = Rig::new(config, &Settings::default());
        rig.run(0.1);
        let errors = Errors::of(&mut rig, 3.0);
        assert!(errors.heading < 1.5, "heading {heading}: {errors:?}");
        assert!(errors.tilt < 1.0, "heading {heading}: {errors:?}");
        assert!(rig.estimate().heading_valid && rig.estimate().attitude_valid);
    }
}

#[test]
fn every_rate_estimates_alike() {
    for rate_hz in [400, 500, 2000, 8000] {
        let mut config = rough(1);
        config.rate_hz = rate_hz;
        let mut rig = Rig::airborne(config, &settings());
        let errors = Errors::of(&mut rig, 20.0);
        println!("rate {rate_hz}: {errors:?}");
        assert!(
            errors.tilt < 1.5 && errors.position < 1.25 && errors.altitude < 0.5,
            "{rate_hz}: {errors:?}"
        );
    }
}

fn with_fault(fault: Fault, seconds: Option<f64>) -> Rig {
    let mut rig = Rig::airborne(rough(2), &settings());
    rig.world.apply(WorldCommand::FaultOn(fault, seconds)).expect("a valid fault");
    rig
}

#[test]
fn accelerometer_bias_tilts_by_no_more_than_it_must() {
    let mut rig = with_fault(Fault::AccBias(0.3), None);
    let errors = Errors::of(&mut rig, 60.0);
    println!("acc-bias: {errors:?}");
    // asin(0.3/g) is 1.75°. The turn-on bias of the sensor comes on top.
    assert!(errors.tilt < 2.8, "{errors:?}");
    assert!(errors.velocity < 0.5, "{errors:?}");
}

#[test]
fn gyro_bias_is_found_in_flight() {
    let mut rig = with_fault(Fault::GyroBias(2.0), None);
    let errors = Errors::of(&mut rig, 20.0);
    println!("gyro-bias, at first: {errors:?}");
    assert!(errors.tilt < 7.0, "{errors:?}");
    let errors = Errors::of(&mut rig, 30.0);
    println!("gyro-bias, later: {errors:?}");
    assert!(errors.tilt < 2.0, "{errors:?}");
}

#[test]
fn a_lost_or_biased_magnetometer_does_not_turn_the_craft_in_circles() {
    for fault in [Fault::MagOff, Fault::MagBias(20.0)] {
        let mut rig = with_fault(fault, None);
        let errors = Errors::of(&mut rig, 60.0);
        println!("{}: {errors:?}", fault.name());
        assert!(errors.heading < 5.0, "{}: {errors:?}", fault.name());
    }
}

#[test]
fn a_gps_outage_ends_the_fix_at_once_and_the_filter_recovers() {
    let mut rig = with_fault(Fault::GpsLoss, Some(6.0));
    rig.run(0.25);
    assert!(!rig.estimate().gps.fix, "the fix must be gone within 0.25 s");
    assert!(rig.estimate().position_valid);
    rig.run(2.0);
    assert!(!rig.estimate().position_valid);
    assert!(rig.estimate().altitude_valid);
    rig.run(8.0);
    let errors = Errors::of(&mut rig, 5.0);
    println!("after the outage: {errors:?}");
    assert!(rig.estimate().gps.fix && rig.estimate().position_valid);
    assert!(errors.velocity < 0.4 && errors.tilt < 2.0, "{errors:?}");
}

#[test]
fn a_frozen_receiver_is_no_fix() {
    let mut rig = Rig::airborne(rough(2), &settings());
    rig.sticks.stick_pitch = 250.0;
    rig.run(5.0);
    rig.world.apply(WorldCommand::FaultOn(Fault::GpsFreeze, None)).expect("a valid fault");
    rig.run(0.6);
    assert!(rig.estimate().gps.frozen && !rig.estimate().gps.fix);
}

#[test]
fn barometer_spikes_and_ramps_make_no_steps() {
    let mut rig = with_fault(Fault::BaroSpike(100.0), None);
    let errors = Errors::of(&mut rig, 30.0);
    println!("baro-spike: {errors:?}");
    assert!(errors.altitude < 0.5, "{errors:?}");
    let mut rig = with_fault(Fault::BaroDrift(1.0), Some(20.0));
    let mut last = rig.estimate().alt_m;
    rig.watch(20.0, |rig| {
        let altitude = rig.estimate().alt_m;
        assert!((altitude - last).abs() < 0.05, "a step of {} m", altitude - last);
        last = altitude;
    });
    // 20 Pa are 1.7 m.
    let error = (rig.altitude_m() - rig.estimate().alt_m).abs();
    assert!(error < 2.2, "{error}");
}

#[test]
fn the_true_attitude_can_be_chosen() {
    use betadeck_core::firmware::estimate::{AttitudeSource, Estimator, EstimatorOptions, EstimatorTuning};
    let mut rig = Rig::new(rough(3), &settings());
    let options = EstimatorOptions { attitude: AttitudeSource::Truth, ..EstimatorOptions::default() };
    rig.estimator = Estimator::new(options, EstimatorTuning::from_settings(&settings()));
    rig.run(1.0);
    let truth = rig.truth().attitude;
    assert!(rig.estimate().attitude.angle_to(&truth) < 1e-6);
}
