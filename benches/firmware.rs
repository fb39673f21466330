//! The time of a firmware tick at 1 kHz, the 100 Hz work included, and of its estimation and control alone.
//!
//! One iteration is a second of flight (1000 ticks), so a reading of 250 µs means 0.25 µs a tick.
#![allow(clippy::unwrap_used, reason = "a bench may stop")]

use betadeck::firmware::config::Configuration;
use betadeck::firmware::config::MixerKind;
use betadeck::firmware::control::{ControlInput, Controller, StickMode, TiltDemand, Tuning};
use betadeck::firmware::estimate::{Estimator, EstimatorOptions, EstimatorTuning};
use betadeck::firmware::settings::Settings;
use betadeck::firmware::{Firmware, FirmwareOptions};
use betadeck::signals::{GpsSample, RcFrame, RcSource, SensorFrame, SimTime};
use betadeck::sim::WorldConfig;
use betadeck::vehicle::{CliSession, Vehicle, VehicleCommand, VehicleConfig};
use nalgebra::Vector3;

fn main() {
    divan::main();
}

/// Returns a second of sensor frames of a craft that hovers and sways.
fn frames(start_us: u64) -> Vec<SensorFrame> {
    (0..1000_u64)
        .map(|tick| {
            let time = SimTime(start_us + tick * 1000);
            let sway = (time.as_secs_f64() * 3.0).sin() * 0.2;
            SensorFrame {
                time,
                rate_flu: Vector3::new(sway, -sway * 0.5, sway * 0.1),
                specific_force_flu: Vector3::new(sway * 0.3, 0.1, 9.8 + sway),
                pressure_pa: tick.is_multiple_of(20).then_some(97_000.0 + sway),
                mag_flu: tick.is_multiple_of(10).then_some(Vector3::new(2046.8, -71.5, -3547.2)),
                gps: tick.is_multiple_of(100).then(|| GpsSample {
                    fix: true,
                    sats: 12,
                    position: betadeck::geo::LatLon::new(404_635_000, -795_182_000),
                    alt_amsl_cm: 32_000,
                    vel_enu: Vector3::new(sway, 0.0, 0.0),
                    hdop: 0.8,
                    latency_s: 0.1,
                    ..GpsSample::default()
                }),
                ..SensorFrame::default()
            }
        })
        .collect()
}

fn flying_estimator() -> (Estimator, Vec<SensorFrame>) {
    let mut estimator = Estimator::new(EstimatorOptions::default(), EstimatorTuning::default());
    for second in 0..5 {
        for frame in frames(second * 1_000_000) {
            estimator.update(&frame);
        }
    }
    estimator.on_arm(None);
    (estimator, frames(5_000_000))
}

#[divan::bench]
fn estimate_1000_ticks(bencher: divan::Bencher) {
    bencher.with_inputs(flying_estimator).bench_local_values(|(mut estimator, frames)| {
        for frame in &frames {
            divan::black_box(estimator.update(divan::black_box(frame)));
        }
        *estimator.estimate()
    });
}

fn input() -> ControlInput {
    ControlInput {
        armed: true,
        airmode: true,
        throttle_us: 1500.0,
        mode: StickMode::Angle,
        ..ControlInput::default()
    }
}

/// Estimation and control together, in ANGLE with the sticks centred, or flown by the navigator with a yaw rate.
#[divan::bench(args = ["angle", "navigator"])]
fn estimate_and_control_1000_ticks(bencher: divan::Bencher, mode: &str) {
    let mut input = input();
    if mode == "navigator" {
        input.tilt = Some(TiltDemand { roll_rad: 0.1, pitch_down_rad: 0.15 });
        input.yaw_rate_rps = Some(0.2);
        input.throttle = Some(0.45);
    }
    let tuning = Tuning::from_settings(&Settings::default(), MixerKind::QuadX, &[]);
    bencher.with_inputs(|| (flying_estimator(), Controller::new(tuning, 0.001))).bench_local_values(
        |((mut estimator, frames), mut controller)| {
            for (tick, frame) in frames.iter().enumerate() {
                input.due = estimator.update(divan::black_box(frame));
                input.rc_frame = tick.is_multiple_of(20);
                divan::black_box(controller.step(&input, estimator.estimate(), 0.001));
            }
            *controller.state()
        },
    );
}

/// Returns the whole firmware on a leg of a mission, and the sensor frames of the next second.
fn on_a_leg() -> (Firmware, Vec<SensorFrame>) {
    let mut configuration = Configuration::default();
    configuration.starter_modes();
    let config = VehicleConfig {
        world: WorldConfig::default(),
        firmware: FirmwareOptions::default(),
        configuration,
        live: false,
    };
    let mut vehicle = Vehicle::new(config).expect("a valid world");
    for line in
        ["set ap_hover_throttle = 1500", "waypoint insert 0 40.4700000 -79.5182000 2000 500 FLYOVER 0 ORBIT"]
    {
        vehicle.apply(&VehicleCommand::line(CliSession::Console, line));
    }
    vehicle.apply(&VehicleCommand::StartPilot(10.0)).accepted().expect("the starter modes");
    let engaged = (0..60_000).any(|_| {
        vehicle.tick();
        vehicle.engaged_at().is_some()
    });
    assert!(engaged, "the mission must be under way");
    for _ in 0..10_000 {
        vehicle.tick();
    }
    let firmware = vehicle.embedded().unwrap().clone();
    let frames = (0..1000).map(|_| {
        let frame = *vehicle.sensors();
        vehicle.tick();
        frame
    });
    (firmware, frames.collect())
}

#[divan::bench]
fn firmware_1000_ticks(bencher: divan::Bencher) {
    let (firmware, frames) = on_a_leg();
    let mut sticks = RcFrame::SAFE;
    sticks.channels[2] = 1500;
    sticks.channels[4..7].fill(1900);
    bencher.with_inputs(|| firmware.clone()).bench_local_refs(|firmware| {
        for frame in &frames {
            if frame.time.0.is_multiple_of(20_000) {
                firmware.receive_rc(&sticks, RcSource::Sticks);
            }
            divan::black_box(firmware.step(divan::black_box(frame)));
        }
        while firmware.take_event().is_some() {}
    });
}
