//! Statistics of the sensors against the figures in `docs/physics.md`.

use betadeck_core::sim::{Noise, Switches, WorldConfig};
use nalgebra::Vector3;

use crate::sim::world::{ideal, put_on, run, stand, statistics, world};

/// Returns a configuration with real noise, without turn-on bias and drift.
fn without_bias() -> WorldConfig {
    WorldConfig { switches: Switches { sensor_bias: false, ..Switches::default() }, ..WorldConfig::default() }
}

#[track_caller]
fn deviation(values: &[f64], want: f64, share: f64) {
    let (_, sigma) = statistics(values);
    assert!((sigma / want - 1.0).abs() < share, "{sigma} instead of {want}");
}

#[test]
fn white_noise_at_rest_is_as_stated() {
    let mut world = world(without_bias());
    let (mut gyro, mut acc, mut mag) = (Vec::new(), Vec::new(), Vec::new());
    let (mut baro, mut volts, mut amps) = (Vec::new(), Vec::new(), Vec::new());
    stand(&mut world, 600.0, |world| {
        let frame = world.sensors();
        gyro.push(frame.rate_flu);
        acc.push(frame.specific_force_flu);
        mag.extend(frame.mag_flu);
        baro.extend(frame.pressure_pa);
        volts.extend(frame.battery.map(|b| b.voltage_v - world.truth().battery.voltage_v));
        amps.extend(frame.battery.map(|b| b.current_a - world.truth().battery.current_a));
    });
    for axis in 0..3 {
        let take = |all: &[Vector3<f64>]| all.iter().map(|v| v[axis]).collect::<Vec<f64>>();
        deviation(&take(&gyro), (0.0038_f64 * 1000_f64.sqrt()).to_radians(), 0.05);
        deviation(&take(&acc), 70e-6 * 9.806_65 * 1000_f64.sqrt(), 0.05);
        deviation(&take(&mag), 0.4 / 500.0 * 4096.0, 0.05);
        let (mean, _) = statistics(&take(&acc));
        assert!((mean - if axis == 2 { 9.806_65 } else { 0.0 }).abs() < 1e-3, "{mean}");
    }
    // 1 Pa of noise and steps of 1 Pa.
    deviation(&baro, (1.0_f64 + 1.0 / 12.0).sqrt(), 0.05);
    deviation(&volts, 0.02, 0.05);
    deviation(&amps, 0.1, 0.05);
    assert_eq!((mag.len(), baro.len(), volts.len()), (60_000, 30_000, 30_000));
}

#[test]
fn the_allan_deviation_of_the_gyro_is_its_density() {
    let mut world = world(without_bias());
    let mut seconds: Vec<Vector3<f64>> = Vec::new();
    for _ in 0..600 {
        let mut sum = Vector3::zeros();
        stand(&mut world, 1.0, |world| sum += world.sensors().rate_flu);
        seconds.push(sum / 1000.0);
    }
    let steps: Vec<Vector3<f64>> = seconds.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let variance = steps.iter().map(Vector3::norm_squared).sum::<f64>() / (steps.len() as f64 * 3.0) / 2.0;
    let density = variance.sqrt().to_degrees();
    assert!((density / 0.0038 - 1.0).abs() < 0.1, "{density} °/s/√Hz");
}

#[test]
fn biases_are_as_large_as_stated() {
    let (mut gyro, mut acc) = (Vec::new(), Vec::new());
    for seed in 0..200 {
        let mut world = world(WorldConfig { seed, ..WorldConfig::default() });
        let (mut rate, mut force) = (Vector3::zeros(), Vector3::zeros());
        stand(&mut world, 0.5, |world| {
            rate += world.sensors().rate_flu / 500.0;
            force += world.sensors().specific_force_flu / 500.0;
        });
        gyro.extend(rate.iter().map(|v| v.to_degrees()));
        acc.extend((force - Vector3::new(0.0, 0.0, 9.806_65)).iter());
    }
    deviation(&gyro, 0.5, 0.12);
    deviation(&acc, 0.05, 0.12);
}

#[test]
fn gps_errors_are_white_plus_wandering() {
    let mut world = world(WorldConfig { seed: 4, rate_hz: 400, ..WorldConfig::default() });
    stand(&mut world, 10.0, |_| {});
    let mut fixes = Vec::new();
    stand(&mut world, 6000.0, |world| {
        if let Some(gps) = world.sensors().gps {
            let place = world.local_frame().to_enu(
                gps.position.lat_deg(),
                gps.position.lon_deg(),
                f64::from(gps.alt_amsl_cm) / 100.0,
            );
            fixes.push((place - world.truth().pos_enu, gps.vel_enu));
        }
    });
    assert_eq!(fixes.len(), 60_000);
    for (axis, factor, velocity) in [(0, 1.0, 0.05), (1, 1.0, 0.05), (2, 1.6, 0.08)] {
        let errors: Vec<f64> = fixes.iter().map(|fix| fix.0[axis]).collect();
        let speeds: Vec<f64> = fixes.iter().map(|fix| fix.1[axis]).collect();
        deviation(&speeds, velocity, 0.05);
        // 100 time constants of the wandering part: its deviation is known to 7 %.
        deviation(&errors, factor * 0.25, 0.25);
        let steps: Vec<f64> = errors.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let wander = 0.25_f64.powi(2) * (1.0 - (-0.1_f64 / 60.0).exp());
        deviation(&steps, factor * (2.0 * (0.03_f64.powi(2) + wander)).sqrt(), 0.05);
    }
}

/// Returns the age at which the GPS velocities of a falling craft fit the truth best, in hundredths of a second.
fn gps_age(noise: Noise) -> usize {
    let mut world = world(WorldConfig { noise, ..ideal() });
    stand(&mut world, 6.0, |_| {});
    put_on(&mut world, "teleport=0,0,3000", None);
    let (mut truth, mut gps) = (Vec::new(), Vec::new());
    for _ in 0..600 {
        run(&mut world, 0.01, 0.0);
        truth.push(world.truth().vel_enu.z);
        if let Some(sample) = world.sensors().gps {
            gps.push((truth.len() - 1, sample.vel_enu.z));
        }
    }
    let misfit = |age: usize| {
        gps.iter()
            .filter(|(at, _)| *at >= 30)
            .map(|&(at, speed)| (speed - truth[at - age]).powi(2))
            .sum::<f64>()
    };
    (0..30).min_by(|&a, &b| misfit(a).total_cmp(&misfit(b))).expect("an age")
}

#[test]
fn gps_is_a_tenth_of_a_second_late_unless_ideal() {
    assert_eq!(gps_age(Noise::Real), 10);
    assert_eq!(gps_age(Noise::None), 0);
}

#[test]
fn acquisition_goes_through_its_stages() {
    for seed in 0..20 {
        let mut world = world(WorldConfig { seed, ..WorldConfig::default() });
        let mut stages = Vec::new();
        stand(&mut world, 6.0, |world| {
            let Some(gps) = world.sensors().gps else { return };
            let stage = (gps.fix, gps.sats);
            if stages.last().is_none_or(|&(_, last, _)| last != stage) {
                stages.push((world.time().as_secs_f64(), stage, gps.hdop));
            }
        });
        let at = |wanted: (bool, u8)| {
            stages.iter().find(|s| s.1 == wanted).unwrap_or_else(|| panic!("{stages:?}"))
        };
        for (stage, nominal) in [((false, 4), 1.5), ((true, 7), 3.0), ((true, 12), 4.5)] {
            let time = at(stage).0;
            assert!((0.8 * nominal..=1.2 * nominal + 0.11).contains(&time), "{stage:?} at {time}");
        }
        assert!(at((true, 7)).2 > 2.0 && (at((true, 12)).2 - 0.8).abs() < 0.15, "{stages:?}");
    }
}

#[test]
fn the_ideal_world_is_exact_and_complete() {
    let mut world = world(ideal());
    stand(&mut world, 4.0, |world| {
        let (frame, truth) = (world.sensors(), world.truth());
        assert_eq!((frame.rate_flu, frame.specific_force_flu), (truth.rate_flu, truth.specific_force_flu));
        assert_eq!(frame.truth_attitude, Some(truth.attitude));
        assert_eq!(frame.time, truth.time);
        if let Some(battery) = frame.battery {
            assert_eq!(battery.voltage_v, truth.battery.voltage_v);
        }
        if let Some(pressure) = frame.pressure_pa {
            assert_eq!(pressure, betadeck_core::sim::pressure_pa(300.0 + truth.pos_enu.z));
        }
    });
}

#[test]
fn gps_keeps_the_rate_it_was_given() {
    for rate in [1, 5, 7, 10, 20] {
        let mut world = world(ideal());
        world.apply(betadeck_core::sim::WorldCommand::SetGpsRate(rate)).expect("a rate");
        let mut messages = 0_u32;
        stand(&mut world, 10.0, |world| messages += u32::from(world.sensors().gps.is_some()));
        assert_eq!(messages, 10 * u32::from(rate));
    }
}

#[test]
fn an_accelerometer_away_from_the_centre_feels_the_rotation() {
    let mut config = ideal();
    config.airframe.imu_position_m = Vector3::new(0.0, 0.0, 0.1);
    let mut world = world(config);
    put_on(&mut world, "teleport=0,0,100", None);
    put_on(&mut world, "motor=1:0.5", None);
    run(&mut world, 0.4, 0.5);
    let extra = world.sensors().specific_force_flu - world.truth().specific_force_flu;
    let rate = world.truth().rate_flu;
    assert!(rate.norm() > 1.0);
    let centripetal = -0.1 * (rate.x * rate.x + rate.y * rate.y);
    assert!((extra.z - centripetal).abs() < 1e-9, "{extra}");
}
