//! Tests of the whole world: on the ground, in flight, falling, failing.

use super::*;
use crate::signals::SimTime;
use crate::sim::airframe::Airframe;
use crate::sim::command::WorldCommand;
use crate::sim::config::{Noise, WorldConfig};
use crate::sim::error::WorldError;
use crate::sim::event::WorldEvent;
use crate::sim::fault::{Fault, FaultStart, ScheduledFault};
use crate::sim::switches::AirDensity;
use crate::sim::wind::Wind;
use crate::telemetry::{FaultKind, Turbulence};

fn ideal() -> WorldConfig {
    WorldConfig { noise: Noise::None, ..WorldConfig::default() }
}

fn run(world: &mut World, seconds: f64, command: [f64; 4]) {
    let steps = (seconds * 1e6 / world.clock.step_us() as f64).round() as u64;
    for _ in 0..steps {
        world.step(&MotorCommand(command));
    }
}

fn events(world: &mut World) -> Vec<WorldEventKind> {
    std::iter::from_fn(|| world.take_event()).map(|event| event.kind).collect()
}

/// Returns the command at which four rotors carry the weight, 0…1.
fn hover_command(airframe: &Airframe) -> f64 {
    airframe.hover_rotor_speed() / airframe.rotor_speed_max
}

/// Returns a craft `height` metres above its place on the ground.
fn lifted(config: WorldConfig, height: f64) -> World {
    let mut world = World::new(config).unwrap();
    world.apply(WorldCommand::FaultOn(Fault::Teleport([0.0, 0.0, height]), None)).unwrap();
    events(&mut world);
    world
}

#[test]
fn the_first_frame_is_complete() {
    let world = World::new(ideal()).unwrap();
    let frame = world.sensors();
    assert_eq!(frame.time, SimTime::ZERO);
    assert_eq!(frame.rate_flu, Vector3::zeros());
    assert!((frame.specific_force_flu - Vector3::new(0.0, 0.0, 9.806_65)).norm() < 1e-9);
    assert!(frame.pressure_pa.is_some() && frame.mag_flu.is_some() && frame.battery.is_some());
    assert!(frame.gps.is_some_and(|gps| !gps.fix));
    assert!((world.truth().heading_deg()).abs() < 1e-9);
    assert!(world.truth().on_ground);
}

#[test]
fn ideal_gps_has_a_fix_from_three_seconds_on() {
    let mut world = World::new(ideal()).unwrap();
    let mut fixes = Vec::new();
    for _ in 0..3500 {
        world.step(&MotorCommand::default());
        if let Some(gps) = world.sensors().gps.filter(|gps| gps.fix) {
            fixes.push((world.time().0, gps));
        }
    }
    let (first, gps) = fixes[0];
    assert_eq!(first, 3_000_000);
    assert_eq!(fixes.len(), 6);
    assert_eq!((gps.sats, gps.position.lat_e7, gps.position.lon_e7), (12, 404_635_000, -795_182_000));
    assert_eq!(gps.alt_amsl_cm, 30_020);
}

#[test]
fn a_drop_is_a_contact_then_a_touchdown() {
    let mut world = lifted(ideal(), 0.1);
    run(&mut world, 2.0, [0.0; 4]);
    let seen = events(&mut world);
    let [WorldEventKind::Contact { impact_mps }, WorldEventKind::Touchdown { impact_mps: same, peak_mps2 }] =
        seen[..]
    else {
        panic!("{seen:?}")
    };
    assert_eq!(impact_mps, same);
    assert!((impact_mps - (2.0 * 9.806_65 * 0.1_f64).sqrt()).abs() < 0.02, "{impact_mps}");
    assert!(peak_mps2 > 80.0, "{peak_mps2}");
    assert!(world.truth().on_ground && !world.truth().crashed);
}

#[test]
fn a_fall_is_a_crash_and_stops_the_rotors() {
    let mut world = lifted(ideal(), 3.0);
    run(&mut world, 5.0, [0.2; 4]);
    let seen = events(&mut world);
    assert!(
        matches!(seen[1], WorldEventKind::Crash { cause: CrashCause::HardLanding(speed) } if speed > 3.0),
        "{seen:?}"
    );
    assert_eq!(seen.len(), 2, "a wreck tells no more: {seen:?}");
    assert!(world.truth().crashed);
    assert!(world.truth().rotor_speeds.iter().all(|&speed| speed < 1e-3));
    world.apply(WorldCommand::ResetToHome).unwrap();
    let frame = *world.sensors();
    assert!((frame.specific_force_flu - Vector3::new(0.0, 0.0, 9.806_65)).norm() < 1e-6, "{frame:?}");
    assert!(frame.pressure_pa.is_none() && frame.gps.is_none(), "nothing of the old place is left");
    run(&mut world, 0.01, [0.0; 4]);
    assert!(!world.truth().crashed && world.truth().on_ground);
}

#[test]
fn a_dead_motor_tips_the_craft_over_and_names_no_nan() {
    let mut world = lifted(ideal(), 20.0);
    let hover = hover_command(world.airframe());
    world
        .apply(WorldCommand::FaultOn("motor@0,,2:0".parse::<ScheduledFault>().unwrap().fault, None))
        .unwrap();
    run(&mut world, 10.0, [hover; 4]);
    let truth = *world.truth();
    assert!(truth.crashed && !truth.diverged);
    let touches = events(&mut world);
    let contacts = touches.iter().filter(|event| matches!(event, WorldEventKind::Contact { .. }));
    assert_eq!(contacts.count(), 1, "a wreck that bounces tells no more: {touches:?}");
    assert!(truth.pos_enu.z.abs() < 0.5 && truth.pos_enu.iter().all(|v| v.is_finite()));
}

#[test]
fn commands_that_are_no_numbers_are_refused_and_counted() {
    let mut world = lifted(ideal(), 20.0);
    let hover = hover_command(world.airframe());
    run(&mut world, 0.1, [hover; 4]);
    let mut twin = world.clone();
    world.step(&MotorCommand([f64::NAN, f64::INFINITY, f64::NEG_INFINITY, hover]));
    twin.step(&MotorCommand([hover; 4]));
    assert_eq!(world.truth(), twin.truth());
    assert_eq!(world.status().refused_commands, 3);
    run(&mut world, 1.0, [-5.0, 1e300, f64::NAN, 0.5]);
    assert_eq!(world.truth().motor_command, [0.0, 1.0, hover, 0.5]);
    assert!(!world.truth().diverged);
}

#[test]
fn a_runaway_is_frozen_and_reported() {
    let mut world = lifted(ideal(), 50.0);
    let rate_flu = Vector3::new(299.9, 0.0, 20.0);
    world.craft.set_body(BodyState { rate_flu, ..*world.craft.body() });
    world.refresh_loads();
    run(&mut world, 0.5, [1.0, 1.0, 0.0, 0.0]);
    assert!(world.truth().diverged);
    let seen = events(&mut world);
    assert!(matches!(seen[..], [WorldEventKind::Diverged { cause: DivergeCause::Rate }]), "{seen:?}");
    let frozen = world.truth().pos_enu;
    run(&mut world, 0.5, [1.0; 4]);
    assert_eq!(world.truth().pos_enu, frozen);
}

#[test]
fn scheduled_faults_are_reported_at_their_time() {
    let faults = vec!["gps-loss@boot+1,2".parse().unwrap(), "push@1,,1,east".parse().unwrap()];
    let mut world = World::new(WorldConfig { faults, ..ideal() }).unwrap();
    let mut seen = Vec::new();
    for step in 0..5000 {
        if step == 3500 {
            let now = world.time();
            world.clock_mut().set_engaged(now);
        }
        world.step(&MotorCommand::default());
        while let Some(WorldEvent { time, kind: WorldEventKind::Fault { fault, on } }) = world.take_event() {
            seen.push((time.0 / 1000, fault.name(), on));
        }
    }
    assert_eq!(seen, [(1000, "gps-loss", true), (3000, "gps-loss", false), (4500, "push", true)]);
}

#[test]
fn a_push_changes_the_momentum() {
    let mut world = lifted(ideal(), 20.0);
    world
        .apply(WorldCommand::FaultOn(Fault::Push(0.53, super::super::fault::Direction::East), None))
        .unwrap();
    run(&mut world, 0.001, [0.0; 4]);
    assert!((world.truth().vel_enu.x - 1.0).abs() < 1e-4);
}

#[test]
fn payload_makes_it_heavier_until_it_is_dropped() {
    let mut world = lifted(ideal(), 20.0);
    let hover = hover_command(world.airframe());
    world.craft.set_rotors([world.airframe().hover_rotor_speed(); 4]);
    let payload = Fault::Payload(0.53);
    world.apply(WorldCommand::FaultOn(payload, None)).unwrap();
    run(&mut world, 0.002, [hover; 4]);
    // The lift per mass is half, in air thinner than the reference.
    assert!((world.truth().specific_force_flu.z - 0.5 * 9.806_65 * 0.97).abs() < 0.05);
    world.apply(WorldCommand::FaultOff(payload.key())).unwrap();
    run(&mut world, 0.002, [hover; 4]);
    assert!((world.truth().specific_force_flu.z - 9.806_65 * 0.97).abs() < 0.1);
}

#[test]
fn thin_air_and_payload_lower_the_thrust_over_weight() {
    let world = |air_density| {
        let switches = Switches { air_density, ..Switches::default() };
        World::new(WorldConfig { switches, ..ideal() }).unwrap()
    };
    let mut at_reference = world(AirDensity::Reference);
    let unladen = Airframe::iris().thrust_to_weight();
    assert!((at_reference.thrust_to_weight() - unladen).abs() < 1e-9, "{}", at_reference.thrust_to_weight());
    let at_home = world(Switches::default().air_density).thrust_to_weight() / unladen;
    assert!((0.95..0.99).contains(&at_home), "300 m above the sea: {at_home}");
    let payload = Fault::Payload(Airframe::iris().mass_kg);
    at_reference.apply(WorldCommand::FaultOn(payload, None)).unwrap();
    assert!(
        (at_reference.thrust_to_weight() - 0.5 * unladen).abs() < 1e-9,
        "{}",
        at_reference.thrust_to_weight()
    );
}

#[test]
fn a_teleport_into_the_ground_stops_at_its_surface() {
    let mut world = World::new(ideal()).unwrap();
    world.apply(WorldCommand::FaultOn(Fault::Teleport([5.0, 0.0, -9.0]), None)).unwrap();
    run(&mut world, 1.0, [0.0; 4]);
    let truth = world.truth();
    assert!((truth.pos_enu - Vector3::new(0.0, 5.0, 0.198)).norm() < 0.01 && !truth.crashed);
}

#[test]
fn link_faults_are_refused_without_a_link() {
    let faults: Vec<ScheduledFault> = vec!["stall@5".parse().unwrap()];
    let refused = World::new(WorldConfig { faults, ..ideal() });
    assert_eq!(refused.err(), Some(WorldError::NeedsLink(FaultKind::Stall)));
}

#[test]
fn values_out_of_range_are_refused_and_change_nothing() {
    let mut world = World::new(ideal()).unwrap();
    let before = format!("{world:?}");
    for command in [
        WorldCommand::SetGust(f64::NAN),
        WorldCommand::SetWind(Wind { speed_mps: -1.0, from_deg: 0.0 }),
        WorldCommand::SetGpsRate(0),
        WorldCommand::FaultOn(Fault::GpsNoise(f64::NAN), None),
        WorldCommand::FaultOn(Fault::GpsLoss, Some(f64::NAN)),
        WorldCommand::FaultOn(Fault::GpsLoss, Some(f64::MAX)),
        WorldCommand::SetSwitch("gust_rise=0".to_owned()),
        WorldCommand::Schedule(ScheduledFault {
            fault: Fault::GpsLoss,
            start: FaultStart::Boot(f64::INFINITY),
            for_s: None,
        }),
    ] {
        let shown = format!("{command:?}");
        assert!(world.apply(command).is_err(), "{shown}");
    }
    assert_eq!(format!("{world:?}"), before);
    assert!(World::new(WorldConfig { gust_mps: -1.0, ..ideal() }).is_err());
    assert!(
        World::new(WorldConfig { home: crate::sim::Home { lat_deg: 91.0, ..Default::default() }, ..ideal() })
            .is_err()
    );
}

#[test]
fn the_status_shows_what_is_set() {
    let mut world = World::new(ideal()).unwrap();
    world.apply(WorldCommand::SetWind("6@90".parse().unwrap())).unwrap();
    world.apply(WorldCommand::SetTurbulence(Turbulence::Light)).unwrap();
    world.apply(WorldCommand::FaultOn(Fault::GpsLoss, Some(3.0))).unwrap();
    run(&mut world, 1.0, [0.0; 4]);
    let status = world.status();
    assert_eq!((status.wind.speed_mps, status.turbulence), (6.0, Turbulence::Light));
    assert_eq!(world.clock().active_faults().collect::<Vec<_>>(), [(Fault::GpsLoss, Some(2.0))]);
    assert!((world.truth().wind_enu.x + 3.0 * 0.396).abs() < 1.0);
}
