//! The effect of each fault on the sensor data or on the craft.

use betadeck_core::signals::GpsSample;
use betadeck_core::sim::{Clock, World, WorldCommand, WorldConfig, WorldEventKind};

use crate::sim::world::{events, fault, ideal, put_on, run, stand, statistics, world};

/// Returns the GPS messages while the craft is on the ground for a time, each with its time, s.
fn messages(world: &mut World, seconds: f64) -> Vec<(f64, GpsSample)> {
    let mut seen = Vec::new();
    stand(world, seconds, |world| {
        seen.extend(world.sensors().gps.map(|gps| (world.time().as_secs_f64(), gps)));
    });
    seen
}

/// Returns a world with a GPS fix.
fn fixed(config: WorldConfig) -> World {
    let mut world = world(config);
    stand(&mut world, 6.0, |_| {});
    world
}

/// Returns a craft that hovers 20 m up by constant command, and that command.
fn hovering() -> (World, f64) {
    let mut config = ideal();
    config.switches.set("air_density=reference").expect("a switch");
    let mut world = world(config);
    let hover = world.airframe().hover_rotor_speed() / world.airframe().rotor_speed_max;
    put_on(&mut world, "teleport=0,0,20", None);
    run(&mut world, 0.1, hover);
    events(&mut world);
    (world, hover)
}

#[test]
fn gps_loss_ends_with_a_fix_after_a_second_and_a_half() {
    for (config, wait) in [(WorldConfig::default(), 1.5), (ideal(), 0.0)] {
        let mut world = fixed(config);
        let start = world.time().as_secs_f64();
        put_on(&mut world, "gps-loss", Some(3.0));
        let seen = messages(&mut world, 6.0);
        let lost: Vec<_> = seen.iter().filter(|(_, gps)| !gps.fix).collect();
        assert!((lost[0].0 - start - 0.1).abs() < 1e-9, "at once");
        assert_eq!(lost[0].1.sats, 0);
        let back = seen.iter().find(|(at, gps)| gps.fix && *at > start).map(|(at, _)| at - start);
        assert!(back.is_some_and(|back| (back - 3.0 - wait).abs() < 0.11), "{back:?}");
    }
}

#[test]
fn gps_glitch_shifts_the_position_only() {
    let mut world = fixed(ideal());
    let before = messages(&mut world, 0.1)[0].1;
    put_on(&mut world, "gps-glitch=30@90", Some(0.15));
    let seen = messages(&mut world, 0.3);
    let east = f64::from(seen[0].1.position.lon_e7 - before.position.lon_e7) * 1e-7 * 84_813.69;
    assert!((east - 30.0).abs() < 0.02, "{east}");
    assert_eq!(seen[0].1.position.lat_e7, before.position.lat_e7);
    assert!((seen[0].1.vel_enu - before.vel_enu).norm() < 1e-9);
    assert_eq!(seen[2].1.position, before.position);
}

#[test]
fn gps_freeze_repeats_the_last_solution() {
    let mut world = fixed(WorldConfig::default());
    let last = messages(&mut world, 0.1)[0].1;
    put_on(&mut world, "gps-freeze", Some(1.0));
    let seen = messages(&mut world, 2.0);
    assert!(seen[..9].iter().all(|(_, gps)| *gps == last));
    assert!(seen[10..].iter().all(|(_, gps)| *gps != last));
}

#[test]
fn gps_delay_shows_where_the_craft_was_and_ends_without_a_gap() {
    let (mut world, hover) = hovering();
    run(&mut world, 4.0, hover);
    put_on(&mut world, "teleport=50,0,0", None);
    put_on(&mut world, "gps-delay=0.5", Some(2.0));
    let mut seen = Vec::new();
    let home = (betadeck_core::sim::Home::default().lat_deg * 1e7) as i32;
    for _ in 0..3000 {
        run(&mut world, 0.001, hover);
        seen.extend(world.sensors().gps.map(|gps| (gps.position.lat_e7 - home, gps.latency_s)));
    }
    let is_there = |(lat_e7, _): &(i32, f64)| *lat_e7 > 2000;
    let first = seen.iter().position(is_there).expect("the new place");
    assert!((4..=6).contains(&first), "{seen:?}");
    assert!(
        seen[first..].iter().all(is_there) && seen.iter().all(|(_, latency)| *latency == 0.0),
        "{seen:?}"
    );
}

#[test]
fn baro_freeze_repeats_the_last_pressure() {
    let (mut world, hover) = hovering();
    let pressures = |world: &mut World, seconds: f64| {
        let mut seen = Vec::new();
        for _ in 0..(seconds * 1000.0) as usize {
            run(world, 0.001, hover);
            seen.extend(world.sensors().pressure_pa);
        }
        seen
    };
    let before = *pressures(&mut world, 0.1).last().expect("a sample");
    put_on(&mut world, "baro-freeze", Some(1.0));
    put_on(&mut world, "teleport=0,0,30", None);
    let seen = pressures(&mut world, 2.0);
    assert!(seen[..45].iter().all(|pressure| *pressure == before), "{before} {seen:?}");
    assert!(seen[55..].iter().all(|pressure| before - pressure > 300.0), "{before} {seen:?}");
}

#[test]
fn gps_noise_multiplies_the_errors() {
    let sigma = |noisy: bool| {
        let mut world = fixed(WorldConfig::default());
        if noisy {
            put_on(&mut world, "gps-noise=5", None);
        }
        let speeds: Vec<f64> = messages(&mut world, 60.0).iter().map(|(_, gps)| gps.vel_enu.x).collect();
        statistics(&speeds).1
    };
    assert!((sigma(true) / sigma(false) - 5.0).abs() < 1e-9);
}

#[test]
fn barometer_faults_ramp_and_spike() {
    let pressures = |world: &mut World, seconds| {
        let mut seen = Vec::new();
        stand(world, seconds, |world| seen.extend(world.sensors().pressure_pa));
        seen
    };
    let mut world = world(ideal());
    let rest = pressures(&mut world, 0.02)[0];
    put_on(&mut world, "baro-drift=2", Some(10.0));
    let ramp = pressures(&mut world, 12.0);
    assert!((ramp[249] - rest - 10.0).abs() < 0.1, "half way: {}", ramp[249] - rest);
    assert!((ramp[599] - rest - 20.0).abs() < 0.1, "it stays where it went");
    put_on(&mut world, "baro-spike=100", Some(5.0));
    let spiky = pressures(&mut world, 6.0);
    assert_eq!(spiky.iter().filter(|&&p| p > ramp[599] + 50.0).count(), 5);
}

#[test]
fn inertial_faults_step_and_freeze() {
    let mut world = world(ideal());
    put_on(&mut world, "gyro-bias=2", Some(0.5));
    put_on(&mut world, "acc-bias=0.3", Some(0.5));
    stand(&mut world, 0.1, |world| {
        assert!((world.sensors().rate_flu.x.to_degrees() - 2.0).abs() < 1e-9);
        assert!((world.sensors().specific_force_flu.x - 0.3).abs() < 1e-9);
    });
    put_on(&mut world, "imu-freeze", None);
    stand(&mut world, 1.0, |_| {});
    assert!((world.sensors().rate_flu.x.to_degrees() - 2.0).abs() < 1e-9, "frozen with the bias on");
    assert!(world.truth().rate_flu.norm() < 1e-9);
}

#[test]
fn vibration_and_imbalance_shake_the_accelerometer() {
    let shake = |text: &str| {
        let (mut world, hover) = hovering();
        // The rotors reach their hover speed first.
        run(&mut world, 0.2, hover);
        put_on(&mut world, text, None);
        let mut seen = Vec::new();
        for _ in 0..1000 {
            run(&mut world, 0.001, hover);
            seen.push(world.sensors().specific_force_flu.x - world.truth().specific_force_flu.x);
        }
        statistics(&seen).1
    };
    assert!((shake("vibration=0.3") - 0.3).abs() < 0.03);
    assert!((shake("prop-imbalance=2:2") - 2.0 / 2_f64.sqrt()).abs() < 0.05);
}

#[test]
fn a_weak_second_motor_rolls_right_pitches_down_and_turns_left() {
    let (mut world, hover) = hovering();
    put_on(&mut world, "motor=2:0.8", None);
    run(&mut world, 0.1, hover);
    let rate = world.truth().rate_flu;
    assert!(rate.x > 0.0 && rate.y > 0.0 && rate.z > 0.0, "roll right, nose down, nose left: {rate}");
}

#[test]
fn a_stuck_motor_ignores_its_command() {
    let (mut world, hover) = hovering();
    put_on(&mut world, "motor-stuck=3:1", None);
    run(&mut world, 0.2, hover);
    let truth = world.truth();
    assert!((truth.rotor_speeds[2] - 696.0).abs() < 0.01);
    assert_eq!(truth.motor_command[2], hover);
}

#[test]
fn battery_faults_lower_the_voltage_and_with_sag_the_rotors() {
    let mut config = ideal();
    config.switches.set("battery_sag=on").expect("a switch");
    let mut world = world(config);
    let volts = |world: &mut World| {
        run(world, 0.2, 0.0);
        world.truth().battery.voltage_v
    };
    let full = volts(&mut world);
    put_on(&mut world, "battery=-1", None);
    assert!((volts(&mut world) - full + 1.0).abs() < 0.01);
    put_on(&mut world, "battery=cell-out", None);
    assert!((volts(&mut world) / full - 2.0 / 3.0).abs() < 0.01);
    run(&mut world, 0.5, 0.3);
    let scale = world.truth().battery.voltage_v / 11.1;
    assert!((world.truth().rotor_speeds[0] - 0.3 * 696.0 * scale).abs() < 0.5);
}

#[test]
fn wind_faults_blow_for_their_time() {
    let mut config = ideal();
    config.switches.set("wind_profile=flat").expect("a switch");
    let mut world = world(config);
    put_on(&mut world, "wind=8@270", Some(5.0));
    put_on(&mut world, "gust=4@180", None);
    stand(&mut world, 4.5, |_| {});
    assert!((world.truth().wind_enu.x - 8.0).abs() < 1e-9 && world.truth().wind_enu.y.abs() < 1e-9);
    stand(&mut world, 3.0, |_| {});
    assert!(world.truth().wind_enu.norm() < 1e-9);
    let reported: Vec<_> = events(&mut world)
        .into_iter()
        .filter_map(|kind| match kind {
            WorldEventKind::Fault { fault, on } => Some((fault.name(), on)),
            _ => None,
        })
        .collect();
    assert_eq!(reported, [("wind", true), ("gust", true), ("gust", false), ("wind", false)]);
}

#[test]
fn receiver_and_link_faults_are_reported_to_their_owners() {
    let (mut embedded, _) = hovering();
    put_on(&mut embedded, "rx-loss", None);
    put_on(&mut embedded, "rx-jitter=0.3", None);
    assert!(embedded.clock().rx_lost());
    assert_eq!(embedded.clock().rx_drop_fraction(), 0.3);
    let mut clock = Clock::from_external(1000, 1, Vec::new()).expect("a rate");
    for text in ["rx-loss", "gps-loss", "stall", "fdm-loss=0.1", "fdm-late=20", "fdm-dup", "fdm-jitter"] {
        clock.apply(WorldCommand::FaultOn(fault(text), None)).expect("accepted");
    }
    assert!(clock.rx_lost() && clock.gps_lost());
    let link = clock.link_faults();
    assert!(link.stall);
    assert_eq!((link.loss, link.late_ms, link.duplicated, link.jitter_ms), (0.1, 20.0, 0.2, 5.0));
    clock.apply(WorldCommand::ClearFaults).expect("cleared");
    assert!(!clock.rx_lost() && !clock.link_faults().stall && clock.active_faults().next().is_none());
}

#[test]
fn a_fault_is_taken_off_by_name() {
    let (mut world, hover) = hovering();
    put_on(&mut world, "motor=2:0.5", None);
    put_on(&mut world, "motor=4:0.5", None);
    world.apply(WorldCommand::FaultOff(fault("motor=2:1").key())).expect("off");
    run(&mut world, 0.01, hover);
    let active: Vec<_> = world.clock().active_faults().collect();
    assert_eq!(active.len(), 1);
    assert_eq!(active[0].0, fault("motor=4:0.5"));
    put_on(&mut world, "motor=1:0.5", None);
    world.apply(WorldCommand::parse("end=motor").expect("a command")).expect("off");
    assert!(world.clock().active_faults().next().is_none());
}
