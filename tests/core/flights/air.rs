//! Flights in wind and gusts, with weak motors, heavy loads and a weak battery.

use crate::flights::checks::{Checks, assert_met, greatest, mean};
use crate::flights::rig::{Rig, Sample, world};
use betadeck_core::sim::{Fault, Wind, WorldCommand};
use betadeck_core::telemetry::{BatteryAlarm, DisarmReason, EventKind, FirmwareEvent, NavEvent, NavState};
use betadeck_core::vehicle::VehicleCommand;

const HOLD: &str = "waypoint insert 0 40.4635901 -79.5182000 2000 500 HOLD 0 NONE";

fn fault(name: &str, value: &str) -> WorldCommand {
    WorldCommand::FaultOn(Fault::parse(name, Some(value)).unwrap(), None)
}

/// Returns a craft that has held its place for ten seconds.
fn holding(seed: u64, wind: &str, gust_mps: f64) -> Rig {
    let mut world = world(seed).0;
    world.wind = wind.parse::<Wind>().unwrap();
    world.gust_mps = gust_mps;
    let mut rig = Rig::new(world, HOLD, 20.0);
    rig.engaged().until_state(60.0, NavState::Holding).fly(10.0);
    rig
}

fn off(rig: &Rig) -> impl Fn(&Sample) -> f64 + use<> {
    let place = rig.waypoint(0);
    move |sample| sample.from(place)
}

fn hold_in_wind(seed: u64, wind: &str, gust_mps: f64, rms: f64) -> Option<String> {
    let extra = world(seed).1;
    let mut rig = holding(seed, wind, gust_mps);
    let start = rig.t();
    rig.fly(60.0);
    let off = off(&rig);
    let mut checks = Checks::default();
    checks.at_most("rms", mean(rig.span(start, 1e9).map(|s| off(s).powi(2))).sqrt(), rms + extra.h);
    let alt = greatest(rig.span(start, 1e9).map(|s| (s.alt - 20.0).abs()));
    checks.at_most("altitude", alt, 0.3 + extra.v);
    checks.verdict(&format!("hold in {wind}, gusts {gust_mps}, seed {seed}"), &rig.story())
}

#[test]
fn place_is_held_in_wind() {
    let airs = [("calm", 0.0, 0.3), ("5@225", 0.8, 0.8), ("8@225", 1.5, 1.3)];
    assert_met(
        [0, 1, 2]
            .into_iter()
            .flat_map(|seed| airs.map(|(wind, gust_mps, rms)| hold_in_wind(seed, wind, gust_mps, rms))),
    );
}

#[test]
fn single_gust_is_ridden_out() {
    assert_met([0, 1].map(|seed| {
        let extra = world(seed).1;
        let mut rig = holding(seed, "calm", 0.0);
        rig.vehicle.apply(&VehicleCommand::from(fault("gust", "8@0"))).accepted().unwrap();
        let start = rig.t();
        rig.fly(20.0);
        let off = off(&rig);
        let mut checks = Checks::default();
        checks.at_most("farthest", greatest(rig.span(start, 1e9).map(&off)), 4.0 + extra.h);
        checks.at_most("back", greatest(rig.span(start + 14.0, 1e9).map(&off)), 1.0 + extra.h);
        let alt = greatest(rig.span(start, 1e9).map(|s| (s.alt - 20.0).abs()));
        checks.at_most("altitude", alt, 1.0 + extra.v);
        checks.verdict(&format!("gust, seed {seed}"), &rig.story())
    }));
}

#[test]
fn weak_motor_is_recovered_from() {
    assert_met([0, 1].map(|seed| {
        let extra = world(seed).1;
        let mut rig = holding(seed, "calm", 0.0);
        rig.vehicle.apply(&VehicleCommand::from(fault("motor", "2:0.8"))).accepted().unwrap();
        let start = rig.t();
        rig.fly(20.0);
        let off = off(&rig);
        let mut checks = Checks::default();
        checks.at_most("attitude", greatest(rig.span(start, 1e9).map(Sample::tilt)), 12.0 + extra.angle);
        checks.at_most("back", greatest(rig.span(start + 10.0, 1e9).map(&off)), 1.0 + extra.h);
        checks.verdict(&format!("weak motor, seed {seed}"), &rig.story())
    }));
}

#[test]
fn dead_motor_is_a_crash_without_nonsense() {
    let mut rig = holding(0, "calm", 0.0);
    rig.vehicle.apply(&VehicleCommand::from(fault("motor", "2:0"))).accepted().unwrap();
    rig.until(20.0, "crash", |rig| rig.vehicle.truth().unwrap().crashed).fly(1.0);
    let last = rig.samples.last().unwrap();
    assert!([last.n, last.e, last.alt, last.roll].iter().all(|value| value.is_finite()));
    let firmware = rig.vehicle.embedded().unwrap();
    assert!(firmware.control().motors.0.iter().all(|motor| motor.is_finite()));
}

#[test]
fn load_is_carried_and_landed() {
    let lines = "waypoint insert 0 40.4635901 -79.5182000 2000 500 HOLD 300 NONE
waypoint insert 1 40.4635901 -79.5182000 1000 500 LAND 0 NONE";
    let mut rig = Rig::new(world(0).0, lines, 20.0);
    rig.engaged().until_state(60.0, NavState::Holding).fly(5.0);
    rig.vehicle.apply(&VehicleCommand::from(fault("payload", "0.1"))).accepted().unwrap();
    let start = rig.t();
    rig.until(120.0, "disarm", |rig| rig.disarmed().is_some());
    let landing = rig.entered(NavState::Approaching, 1);
    let alt = greatest(rig.span(start + 10.0, landing).map(|s| (s.alt - 20.0).abs()));
    assert!(alt <= 1.0, "{alt}");
    assert_eq!(rig.disarmed().unwrap().1, DisarmReason::Landing);
}

#[test]
fn biased_inertial_sensors_still_hold() {
    let mut rig = holding(0, "calm", 0.0);
    rig.vehicle.apply(&VehicleCommand::from(fault("gyro-bias", "2"))).accepted().unwrap();
    rig.vehicle.apply(&VehicleCommand::from(fault("acc-bias", "0.3"))).accepted().unwrap();
    let start = rig.t();
    rig.fly(60.0);
    let off = off(&rig);
    let far = greatest(rig.span(start + 20.0, 1e9).map(&off));
    assert!(far <= 2.0, "{far}");
}

fn at_the_fence(rig: &Rig) -> bool {
    let fence =
        |kind: &EventKind| matches!(kind, EventKind::Firmware(FirmwareEvent::Nav(NavEvent::Geofence { .. })));
    rig.event_at(fence).is_some()
}

#[test]
fn craft_that_cannot_come_back_is_landed_at_the_fence() {
    // The wind carries the craft away before it can fly its leg. It gives up and holds its place as well as
    // it can.
    let (mut world, _) = world(0);
    world.wind = "14@0".parse().unwrap();
    let lines = "set ap_max_distance_from_home = 100
waypoint insert 0 40.4635000 -79.5182000 2000 500 HOLD 0 NONE";
    for (action, path) in [
        ("LAND", "APPROACHING 0, IDLE 0, LANDING 0, COMPLETE 0"),
        ("RTH", "APPROACHING 0, IDLE 0, APPROACHING 0, LANDING 0, COMPLETE 0"),
    ] {
        let lines = format!("{lines}\nset ap_geofence_action = {action}");
        let mut rig = Rig::new(world.clone(), &lines, 20.0);
        rig.engaged().until(60.0, "giving up", |rig| rig.path().ends_with("IDLE 0"));
        rig.until(120.0, "the fence", at_the_fence);
        rig.until(120.0, "disarm", |rig| rig.disarmed().is_some());
        assert_eq!(rig.path(), path);
        assert_eq!(rig.disarmed().unwrap().1, DisarmReason::Landing);
    }
}

#[test]
fn weak_motor_in_cruise_costs_a_degree() {
    let line = "waypoint insert 0 40.4635901 -79.5182000 2000 500 FLYOVER 0 NONE
waypoint insert 1 40.4662000 -79.5182000 2000 500 FLYOVER 0 NONE";
    assert_met([0, 1].map(|seed| {
        let mut rig = Rig::new(world(seed).0, line, 20.0);
        rig.engaged().fly(20.0);
        let start = rig.t();
        let before = greatest(rig.span(start - 5.0, start).map(Sample::tilt));
        rig.vehicle.apply(&VehicleCommand::from(fault("motor", "2:0.8"))).accepted().unwrap();
        rig.fly(15.0);
        let mut checks = Checks::default();
        checks.at_most("lean", greatest(rig.span(start, 1e9).map(Sample::tilt)), before + 1.0);
        checks.at_most("altitude", greatest(rig.span(start, 1e9).map(|s| (s.alt - 20.0).abs())), 1.0);
        checks.verdict(&format!("weak motor in cruise, seed {seed}"), &rig.story())
    }));
}

#[test]
fn wind_near_the_limit_is_held_and_beyond_it_ends_at_the_fence() {
    let mut rig = holding(0, "12@0", 0.0);
    let off = off(&rig);
    let start = rig.t();
    rig.fly(30.0);
    let far = greatest(rig.span(start, 1e9).map(&off));
    assert!(far <= 5.0, "{far}");

    let lines = "waypoint insert 0 40.4635000 -79.5182000 2000 500 HOLD 0 NONE";
    let mut rig = Rig::new(world(0).0, lines, 20.0);
    rig.engaged().until_state(60.0, NavState::Holding).fly(5.0);
    rig.vehicle
        .apply(&VehicleCommand::from(WorldCommand::SetWind("14@0".parse().unwrap())))
        .accepted()
        .unwrap();
    let start = rig.t();
    rig.until(1200.0, "the fence", at_the_fence);
    let tilt: Vec<f64> = rig.span(start + 15.0, 1e9).map(Sample::tilt).collect();
    let middle = mean(tilt.iter().copied());
    let swing = greatest(tilt.iter().map(|tilt| (tilt - middle).abs()));
    assert!(swing <= 5.0, "{swing}");
}

#[test]
fn sagging_battery_is_made_up_for() {
    let mut world = world(0).0;
    world.switches.battery_sag = true;
    world.switches.battery_capacity_ah = Some(0.5);
    let mut rig = Rig::new(world, HOLD, 20.0);
    rig.engaged().until_state(60.0, NavState::Holding).fly(10.0);
    let start = rig.t();
    let is_warning = |kind: &EventKind| {
        matches!(kind, EventKind::Firmware(FirmwareEvent::Battery { state: BatteryAlarm::Warning, .. }))
    };
    rig.until(400.0, "a warning", |rig| rig.event_at(is_warning).is_some());
    let alt = greatest(rig.span(start, 1e9).map(|s| (s.alt - 20.0).abs()));
    assert!(alt <= 0.7, "{alt}");
    let (first, last) = (rig.at(start), rig.samples.last().unwrap());
    assert!(last.throttle_us > first.throttle_us, "throttle rises as the voltage falls");
}

#[test]
fn flat_battery_ends_the_flight() {
    let mut world = world(1).0;
    world.switches.battery_sag = true;
    world.switches.battery_capacity_ah = Some(0.1);
    let mut rig = Rig::new(world, HOLD, 20.0);
    rig.until(300.0, "the end", |rig| rig.vehicle.truth().unwrap().crashed);
    let alarms: Vec<BatteryAlarm> = rig
        .events
        .iter()
        .filter_map(|event| match event.kind {
            EventKind::Firmware(FirmwareEvent::Battery { state, .. }) => Some(state),
            EventKind::BatteryEmpty { .. } => Some(BatteryAlarm::Empty),
            _ => None,
        })
        .collect();
    assert_eq!(
        alarms,
        [BatteryAlarm::Warning, BatteryAlarm::Critical, BatteryAlarm::Empty],
        "{}",
        rig.story()
    );
}

#[test]
fn battery_alarms_change_nothing_in_the_mission() {
    let mut with = world(0).0;
    with.switches.battery_capacity_ah = Some(0.1);
    let path = |world| {
        let mut rig = Rig::new(world, HOLD, 20.0);
        rig.fly(180.0);
        (rig.path(), rig.vehicle.truth().unwrap().pos_enu)
    };
    assert_eq!(path(with), path(world(0).0));
}
