//! A craft that cannot stay in its place reports it, and reports when it can again.

use betadeck_core::sim::{BatteryFault, Fault, WorldCommand};
use betadeck_core::telemetry::{CannotHold, EventKind, FirmwareEvent, HoldLimit, NavEvent, NavState};
use betadeck_core::vehicle::VehicleCommand;

use crate::flights::rig::{Rig, world};

const HOLD: &str = "waypoint insert 0 40.4635901 -79.5182000 2000 500 HOLD 0 NONE";

fn holding(seed: u64, lines: &str) -> Rig {
    let mut rig = Rig::new(world(seed).0, &format!("{lines}\nset ap_max_distance_from_home = 0"), 20.0);
    rig.engaged().until_state(60.0, NavState::Holding).fly(10.0);
    rig
}

/// Returns the reports in order, with the time since engagement.
fn reported(rig: &Rig) -> Vec<(bool, CannotHold)> {
    rig.events
        .iter()
        .filter_map(|event| match &event.kind {
            EventKind::Firmware(FirmwareEvent::Nav(NavEvent::CannotHold { on, deviation })) => {
                Some((*on, *deviation))
            }
            _ => None,
        })
        .collect()
}

fn shown(rig: &Rig) -> Option<CannotHold> {
    rig.vehicle.embedded().unwrap().nav().cannot_hold
}

fn wind(rig: &mut Rig, wind: &str) {
    rig.vehicle
        .apply(&VehicleCommand::from(WorldCommand::SetWind(wind.parse().unwrap())))
        .accepted()
        .unwrap();
}

#[test]
fn a_craft_blown_off_its_hold_says_so() {
    for seed in [0, 1] {
        let mut rig = holding(seed, HOLD);
        wind(&mut rig, "17@0");
        rig.until(25.0, "it is reported", |rig| !reported(rig).is_empty());
        let (on, deviation) = reported(&rig)[0];
        assert!(on && deviation.distance_m > 4.0, "{deviation:?}");
        assert_eq!(deviation.limit, HoldLimit::Tilt);
        rig.fly(5.0);
        assert!(shown(&rig).unwrap().distance_m > deviation.distance_m + 5.0, "the picture keeps up");
        wind(&mut rig, "calm");
        rig.until(60.0, "it holds again", |rig| reported(rig).len() == 2);
        assert!(!reported(&rig)[1].0);
        assert_eq!(shown(&rig), None);
        assert_eq!(rig.samples.last().unwrap().state, NavState::Holding, "nothing ends the mission");
        rig.fly(30.0);
        assert_eq!(reported(&rig).len(), 2, "{}", rig.story());
    }
}

#[test]
fn a_craft_that_sinks_from_its_hold_says_so() {
    let mut rig = holding(0, HOLD);
    rig.cli("set ap_throttle_max = 1480");
    rig.until(30.0, "it is reported", |rig| !reported(rig).is_empty());
    let (_, deviation) = reported(&rig)[0];
    assert!(deviation.vertical_m < -3.0, "{deviation:?}");
    assert_eq!(deviation.limit, HoldLimit::Throttle);
    rig.cli("set ap_throttle_max = 1900");
    rig.until(60.0, "it holds again", |rig| reported(rig).len() == 2);
}

#[test]
fn a_craft_that_sinks_on_a_tired_battery_says_so() {
    let (mut world, _) = world(0);
    world.switches.battery_sag = true;
    let mut rig = Rig::new(world, &format!("{HOLD}\nset ap_max_distance_from_home = 0"), 20.0);
    rig.engaged().until_state(60.0, NavState::Holding).fly(10.0);
    rig.vehicle
        .apply(&VehicleCommand::from(WorldCommand::FaultOn(Fault::Battery(BatteryFault::Offset(-8.0)), None)))
        .accepted()
        .unwrap();
    rig.until(60.0, "it is reported", |rig| !reported(rig).is_empty());
    let (_, deviation) = reported(&rig)[0];
    assert!(deviation.vertical_m < -3.0, "{deviation:?}");
    assert_eq!(deviation.limit, HoldLimit::Battery);
}

#[test]
fn a_landing_that_is_blown_away_says_so() {
    let land = "waypoint insert 0 40.4635000 -79.5182000 3000 500 LAND 0 NONE";
    let mut rig = Rig::new(world(0).0, &format!("{land}\nset ap_max_distance_from_home = 0"), 30.0);
    rig.engaged().until_state(60.0, NavState::Landing).fly(5.0);
    wind(&mut rig, "17@0");
    rig.until(25.0, "it is reported", |rig| !reported(rig).is_empty());
}

#[test]
fn what_holds_says_nothing() {
    let air = |rig: &mut Rig| wind(rig, "8@225");
    for pattern in ["NONE", "ORBIT", "FIGURE8"] {
        let lines = format!(
            "waypoint insert 0 40.4635901 -79.5182000 2000 500 HOLD 300 {pattern}
             waypoint insert 1 40.4640390 -79.5182000 4000 0 FLYOVER 0 NONE
             waypoint insert 2 40.4635000 -79.5182000 2000 0 LAND 0 NONE"
        );
        let mut rig = holding(1, &lines);
        air(&mut rig);
        rig.until(300.0, "the landing", |rig| rig.disarmed().is_some());
        assert!(reported(&rig).is_empty(), "{pattern}: {}", rig.story());
    }
}
