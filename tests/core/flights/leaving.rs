//! The ends of a mission before its time: the modes that stay on, and the ways to resume.

use crate::flights::rig::{Rig, world};
use betadeck_core::sim::{Fault, WorldCommand};
use betadeck_core::telemetry::{
    AbortReason, Event, EventKind, FirmwareEvent, Mode, NavEvent, NavState, Refusal, VehicleNotice,
};
use betadeck_core::vehicle::VehicleCommand;

const MISSION: &str = "
waypoint insert 0 40.4640403 -79.5182000 2000 500 FLYOVER 0 ORBIT
waypoint insert 1 40.4640403 -79.5174926 2000 500 HOLD 0 NONE";

/// The AUX channels of the starter modes.
const AUTOPILOT: usize = 5;
const HOLDS: usize = 6;

/// Returns a craft eight seconds into its mission whose pilot no longer acts. Only the AUTOPILOT switch is
/// on.
fn on_its_way() -> Rig {
    let mut rig = Rig::new(world(0).0, MISSION, 20.0);
    rig.engaged().fly(8.0);
    rig.vehicle.apply(&VehicleCommand::StopPilot);
    rig.stick(HOLDS, 1000);
    rig.fly(0.1);
    assert_eq!(modes(&rig), "ARM ANGLE ALTHOLD POS HOLD AUTOPILOT");
    rig
}

fn modes(rig: &Rig) -> String {
    let names: Vec<_> = rig.vehicle.embedded().unwrap().modes().iter().map(|mode| mode.to_string()).collect();
    names.join(" ")
}

fn refusals(rig: &Rig) -> Vec<Refusal> {
    rig.events
        .iter()
        .filter_map(|event| match event.kind {
            EventKind::Firmware(FirmwareEvent::Nav(NavEvent::Refused(refusal))) => Some(refusal),
            _ => None,
        })
        .collect()
}

#[test]
fn switch_off_leaves_what_the_pilots_switches_say_and_on_again_resumes() {
    let mut rig = on_its_way();
    rig.until_state(30.0, NavState::Arrived).fly(1.0);
    rig.stick(AUTOPILOT, 1000);
    rig.stick(HOLDS, 2000);
    rig.until(0.1, "IDLE", |rig| rig.vehicle.embedded().unwrap().nav().state == NavState::Idle);
    rig.fly(0.011);
    assert_eq!(modes(&rig), "ARM ANGLE ALTHOLD POS HOLD");
    rig.fly(2.0);
    rig.stick(AUTOPILOT, 2000);
    rig.until_state(0.2, NavState::Approaching);
    assert!(rig.path().ends_with("IDLE 1, APPROACHING 1"), "{}", rig.path());
}

#[test]
fn lost_fix_keeps_level_and_altitude_only() {
    let mut rig = on_its_way();
    rig.vehicle
        .apply(&VehicleCommand::from(WorldCommand::FaultOn(Fault::GpsLoss, Some(3.0))))
        .accepted()
        .unwrap();
    rig.until_state(1.0, NavState::Idle).fly(0.1);
    assert_eq!(modes(&rig), "ARM ANGLE ALTHOLD");
    rig.until_state(10.0, NavState::Approaching);
    rig.fly(0.1);
    assert_eq!(modes(&rig), "ARM ANGLE ALTHOLD POS HOLD AUTOPILOT");
    assert_eq!(refusals(&rig), [Refusal::Aborted(AbortReason::GpsLost)]);
}

#[test]
fn flyaway_parks_the_craft_until_the_switch_is_cycled() {
    let mut rig = on_its_way();
    rig.vehicle
        .apply(&VehicleCommand::from(WorldCommand::FaultOn(Fault::Teleport([-80.0, -60.0, 0.0]), None)))
        .accepted()
        .unwrap();
    rig.until_state(3.0, NavState::Idle).fly(5.0);
    assert_eq!(modes(&rig), "ARM ANGLE ALTHOLD POS HOLD");
    assert_eq!(refusals(&rig), [Refusal::Aborted(AbortReason::Flyaway)], "reported once");
    rig.stick(AUTOPILOT, 1000);
    rig.fly(0.2);
    assert_eq!(modes(&rig), "ARM", "acro, as the pilot's switches say");
    rig.stick(AUTOPILOT, 2000);
    rig.until_state(0.2, NavState::Approaching);
}

#[test]
fn cleared_plan_parks_the_craft() {
    let mut rig = on_its_way();
    rig.cli("waypoint clear");
    rig.until_state(0.1, NavState::Idle).fly(0.1);
    assert_eq!(modes(&rig), "ARM ANGLE ALTHOLD POS HOLD");
    rig.cli(MISSION);
    rig.until_state(0.2, NavState::Approaching);
}

#[test]
fn edited_plan_does_not_touch_the_mission() {
    let mut rig = on_its_way();
    rig.cli("waypoint update 0 40.4700000 -79.5182000 9000 500 HOLD 0 ORBIT");
    rig.until_state(30.0, NavState::Arrived);
    assert!(rig.samples.last().unwrap().from([60.0, 0.0]) < 1.5);
    assert_eq!(rig.plans().len(), 1);
}

#[test]
fn mode_events_tell_every_change_and_nothing_else() {
    let mut rig = on_its_way();
    rig.stick(AUTOPILOT, 1000);
    rig.fly(1.0);
    let reported: Vec<_> = rig
        .events
        .iter()
        .filter_map(|event| match event.kind {
            EventKind::Firmware(FirmwareEvent::Mode(modes)) => Some(modes),
            _ => None,
        })
        .collect();
    assert!(reported.windows(2).all(|pair| pair[0] != pair[1]), "{reported:?}");
    assert_eq!(reported.last().copied(), Some(rig.vehicle.embedded().unwrap().modes()));
    let counted = reported.iter().filter(|modes| modes.has(Mode::Autopilot)).count();
    assert_eq!(counted, 1);
    let lost = |event: &&Event| matches!(&event.kind, EventKind::Notice(VehicleNotice::EventsLost(_)));
    assert_eq!(rig.events.iter().find(lost), None);
}
