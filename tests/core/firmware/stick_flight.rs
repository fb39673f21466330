//! Manual flight: the response of the craft to the sticks.

use crate::firmware::control_support::{Rig, StepResponse, world};
use betadeck_core::firmware::config::MixerKind;
use betadeck_core::firmware::control::{StickMode, Tuning};
use betadeck_core::firmware::settings::Settings;
use betadeck_core::sim::{Airframe, Noise, WorldConfig};

fn airframes() -> [(&'static str, Airframe); 2] {
    [("iris", Airframe::iris()), ("five-inch", Airframe::five_inch())]
}

/// Returns the stick deflection (RC units) that demands this angle with the default curve and limit.
fn stick_for(angle_deg: f64, settings: &Settings) -> f64 {
    let tuning = Tuning::from_settings(settings, MixerKind::QuadX, &[]);
    let wanted = angle_deg / tuning.level.limit_deg * tuning.rates[0].rate_dps(1.0);
    let mut stick: f64 = 0.0;
    while tuning.rates[0].rate_dps(stick / 500.0) < wanted {
        stick += 0.5;
    }
    stick
}

/// The flights of a step with noise. The estimate of the attitude errs by about the 5 % of a small step within which it is
/// settled, so the mean of several flights is judged.
const SEEDS: u64 = 12;

/// Returns the tilt angles after a step of the stick in angle mode, degrees from those before, every millisecond.
fn angle_step(airframe: &Airframe, noise: Noise, seed: u64, axis: usize, angle: f64) -> (f64, Vec<f64>) {
    let settings = Settings::default();
    let config = WorldConfig { seed, ..world(noise, airframe.clone()) };
    let mut rig = Rig::airborne(config, &settings);
    rig.manual(StickMode::Angle);
    rig.run(1.0);
    *[&mut rig.sticks.stick_roll, &mut rig.sticks.stick_pitch][axis] = stick_for(angle, &settings);
    let start = rig.tilt_deg()[axis];
    let mut angles = Vec::new();
    rig.watch(1.0, |rig| angles.push(rig.tilt_deg()[axis] - start));
    (angle - start, angles)
}

part_and_search!(angle_steps, every 2, angle_steps_settle_quickly_without_overshoot, angle_steps_settle_quickly_without_overshoot_on_both_axes);

fn angle_steps(n: usize) {
    for (name, airframe) in airframes() {
        for (noise, flights) in [(Noise::None, 1), (Noise::Real, SEEDS)] {
            for axis in (0..2).step_by(n) {
                for angle in [10.0, 20.0, 40.0] {
                    let (mut step, mut angles) = (0.0, vec![0.0; 1000]);
                    for seed in 1..=flights {
                        let (to, flown) = angle_step(&airframe, noise, seed, axis, angle);
                        step += to / flights as f64;
                        angles
                            .iter_mut()
                            .zip(flown)
                            .for_each(|(mean, angle)| *mean += angle / flights as f64);
                    }
                    let response = StepResponse::of(&angles, step, 0.001);
                    assert!(response.overshoot <= 0.10, "{name} {noise} axis {axis} {angle}°: {response:?}");
                    // With noise, the end of a small step is that of the estimate.
                    let limit_s = if noise == Noise::Real && angle < 20.0 { 0.5 } else { 0.35 };
                    assert!(
                        response.settled_s <= limit_s,
                        "{name} {noise} axis {axis} {angle}°: {response:?}"
                    );
                }
            }
        }
    }
}

/// Returns the rate response to a stick in acro, from hover.
fn rate_step(airframe: &Airframe, noise: Noise, axis: usize, rate_dps: f64) -> StepResponse {
    let settings = Settings::default();
    let mut rig = Rig::airborne(world(noise, airframe.clone()), &settings);
    rig.manual(StickMode::Acro);
    rig.run(0.1);
    let curve = Tuning::from_settings(&settings, MixerKind::QuadX, &[]).rates[axis];
    let stick =
        (0..500).map(f64::from).find(|stick| curve.rate_dps(stick / 500.0) >= rate_dps).unwrap_or(500.0);
    *[&mut rig.sticks.stick_roll, &mut rig.sticks.stick_pitch, &mut rig.sticks.stick_yaw][axis] = stick;
    let mut rates = Vec::new();
    rig.watch(0.6, |rig| rates.push(rig.rates_dps()[axis]));
    StepResponse::of(&rates, rate_dps, 0.001)
}

#[test]
fn rate_steps_follow_the_stick() {
    for (name, airframe) in airframes() {
        for (axis, rate, rise_s, overshoot) in
            [(0, 200.0, 0.12, 0.15), (1, 200.0, 0.12, 0.15), (2, 150.0, 0.25, 0.2)]
        {
            let response = rate_step(&airframe, Noise::Real, axis, rate);
            println!("{name} axis {axis} {rate}°/s: {response:?}");
            assert!(response.rise_s <= rise_s, "{name} axis {axis}: {response:?}");
            assert!(response.overshoot <= overshoot, "{name} axis {axis}: {response:?}");
        }
    }
}

#[test]
fn the_right_yaw_stick_turns_the_nose_right() {
    for mode in [StickMode::Acro, StickMode::Angle] {
        let mut rig = Rig::airborne(world(Noise::Real, Airframe::iris()), &Settings::default());
        rig.manual(mode);
        let before = rig.truth().heading_deg();
        rig.sticks.stick_yaw = 200.0;
        rig.run(0.6);
        let turned = (rig.truth().heading_deg() - before).rem_euclid(360.0);
        assert!((10.0..170.0).contains(&turned), "{mode:?}: {turned}");
    }
}

#[test]
fn a_levelled_craft_keeps_level_through_a_full_turn() {
    let mut rig = Rig::airborne(world(Noise::Real, Airframe::iris()), &Settings::default());
    rig.manual(StickMode::Angle);
    rig.tilt(15.0, -10.0);
    rig.sticks.yaw_rate_rps = Some(1.5);
    rig.run(1.0);
    let mut worst: f64 = 0.0;
    rig.watch(4.0, |rig| {
        let [roll, pitch] = rig.tilt_deg();
        worst = worst.max((roll - 15.0).abs()).max((pitch + 10.0).abs());
    });
    println!("worst lean error in a turn: {worst}");
    assert!(worst < 3.0, "{worst}");
}

#[test]
fn a_gust_of_torque_is_shrugged_off() {
    use betadeck_core::sim::{Fault, MotorNumber, WorldCommand};
    let mut rig = Rig::airborne(world(Noise::Real, Airframe::iris()), &Settings::default());
    rig.manual(StickMode::Angle);
    rig.run(0.5);
    let weak = Fault::Motor(MotorNumber::new(2).expect("there is a motor 2"), 0.8);
    rig.world.apply(WorldCommand::FaultOn(weak, None)).expect("a valid fault");
    let mut worst: f64 = 0.0;
    rig.watch(3.0, |rig| worst = rig.tilt_deg().iter().fold(worst, |most, angle| most.max(angle.abs())));
    println!("motor 2 at 80 %: {worst}° at most, then {:?}", rig.tilt_deg());
    assert!(worst < 12.0, "{worst}");
    assert!(rig.tilt_deg().iter().all(|angle| angle.abs() < 2.0), "{:?}", rig.tilt_deg());
}

#[test]
fn hovering_in_angle_mode_hardly_moves_the_craft() {
    for (name, airframe) in airframes() {
        let mut rig = Rig::airborne(world(Noise::Real, airframe), &Settings::default());
        rig.manual(StickMode::Angle);
        rig.run(1.0);
        let (mut worst, mut fastest, mut motor): (f64, f64, f64) = (0.0, 0.0, 0.0);
        let mut last = rig.controller.state().motors.0;
        rig.watch(5.0, |rig| {
            worst = rig.tilt_deg().iter().fold(worst, |most, angle| most.max(angle.abs()));
            fastest = rig.rates_dps().iter().fold(fastest, |most, rate| most.max(rate.abs()));
            let now = rig.controller.state().motors.0;
            motor = motor.max((now[0] - last[0]).abs());
            last = now;
        });
        println!("{name} hover: lean {worst:.2}°, rate {fastest:.2}°/s, motor step {motor:.4}");
        assert!(worst < 2.0 && fastest < 5.0 && motor < 0.03, "{name}: {worst} {fastest} {motor}");
    }
}

#[test]
fn acro_keeps_the_attitude_when_the_sticks_are_released() {
    let mut rig = Rig::airborne(world(Noise::Real, Airframe::iris()), &Settings::default());
    rig.manual(StickMode::Acro);
    rig.sticks.stick_roll = 200.0;
    rig.run(0.3);
    rig.sticks.stick_roll = 0.0;
    rig.run(0.3);
    let left = rig.tilt_deg()[0];
    rig.run(0.7);
    assert!(left > 10.0 && (rig.tilt_deg()[0] - left).abs() < 5.0, "{left} {:?}", rig.tilt_deg());
}

#[test]
fn horizon_levels_in_the_middle_and_flips_at_the_end() {
    let mut rig = Rig::airborne(world(Noise::Real, Airframe::iris()), &Settings::default());
    rig.manual(StickMode::Horizon);
    rig.sticks.stick_roll = 100.0;
    rig.run(1.5);
    rig.sticks.stick_roll = 0.0;
    rig.run(2.0);
    assert!(rig.tilt_deg()[0].abs() < 4.0, "{:?}", rig.tilt_deg());
    rig.sticks.stick_roll = 500.0;
    let mut fastest: f64 = 0.0;
    rig.watch(0.4, |rig| fastest = fastest.max(rig.rates_dps()[0]));
    assert!(fastest > 500.0, "{fastest}");
}

#[test]
fn every_rate_levels_alike() {
    let settings = Settings::default();
    for rate_hz in [400, 500, 4000, 8000] {
        let mut config = world(Noise::Real, Airframe::iris());
        config.rate_hz = rate_hz;
        let mut rig = Rig::airborne(config, &settings);
        rig.manual(StickMode::Angle);
        rig.run(1.0);
        rig.sticks.stick_roll = stick_for(20.0, &settings);
        let start = rig.tilt_deg()[0];
        let mut angles = Vec::new();
        rig.watch(1.0, |rig| angles.push(rig.tilt_deg()[0] - start));
        let response = StepResponse::of(&angles, 20.0 - start, 1.0 / f64::from(rate_hz));
        println!("{rate_hz} Hz: {response:?}");
        assert!(response.overshoot <= 0.10 && response.settled_s <= 0.35, "{rate_hz} Hz: {response:?}");
    }
}
