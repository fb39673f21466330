//! Flights with a GPS that fails, jumps or hangs.

use crate::flights::checks::{Checks, assert_met, greatest};
use crate::flights::rig::{Rig, SEEDS, Sample, world};
use betadeck_core::sim::{Fault, GpsGrade, WorldCommand};
use betadeck_core::telemetry::{DisarmReason, EventKind, FirmwareEvent, Mode, NavState, Turbulence};
use betadeck_core::vehicle::VehicleCommand;

const MISSION: &str = "
waypoint insert 0 40.4640403 -79.5182000 2000 500 FLYOVER 0 ORBIT
waypoint insert 1 40.4640403 -79.5174926 2000 500 FLYOVER 0 ORBIT
waypoint insert 2 40.4635000 -79.5174926 2000 500 LAND 0 ORBIT";

fn outage(seed: u64) -> Option<String> {
    let (world, extra) = world(seed);
    let mut rig = Rig::new(world, MISSION, 20.0);
    rig.engaged().fly(20.0);
    let wp = rig.samples.last().unwrap().wp;
    let began = rig.t();
    rig.vehicle
        .apply(&VehicleCommand::from(WorldCommand::FaultOn(Fault::GpsLoss, Some(6.0))))
        .accepted()
        .unwrap();
    rig.fly(6.0);
    let ended = rig.t();
    rig.until(120.0, "disarm", |rig| rig.disarmed().is_some());
    let mut checks = Checks::default();
    let is_lost = |kind: &EventKind| matches!(kind, EventKind::Firmware(FirmwareEvent::GpsLost { .. }));
    let lost = rig.event_at(is_lost).unwrap();
    checks.at_most("gps_lost after", lost - began, 0.3);
    let idle = rig.transitions().into_iter().find(|entry| entry.to == NavState::Idle).unwrap();
    checks.at_most("IDLE after gps_lost", idle.t - lost, 0.05);
    let away = || rig.span(lost + 1.0, ended);
    checks.at_most("lean", greatest(away().map(Sample::tilt)), 3.0 + extra.angle);
    let alt = rig.at(lost).alt;
    checks.at_most("altitude", greatest(away().map(|s| (s.alt - alt).abs())), 2.0 + extra.v);
    for (mode, on) in [(Mode::Autopilot, false), (Mode::Angle, true), (Mode::AltHold, true)] {
        checks.holds(&format!("{mode} {on}"), away().all(|s| s.modes.has(mode) == on));
    }
    let fix = rig
        .events
        .iter()
        .rev()
        .find(|event| matches!(event.kind, EventKind::Firmware(FirmwareEvent::GpsFix { .. })))
        .map(|event| event.time.as_secs_f64() - rig.vehicle.engaged_at().unwrap().as_secs_f64())
        .unwrap();
    let resumed = rig.transitions().into_iter().find(|entry| entry.t > idle.t).unwrap();
    checks.within("resumed after the fix", resumed.t - fix, 2.0, 2.5);
    checks.same("resumed at", resumed.wp, wp);
    checks.holds("flown to the end", rig.path().ends_with("LANDING 2, COMPLETE 2"));
    checks.verdict(&format!("outage, seed {seed}"), &rig.story())
}

#[test]
fn outage_keeps_level_and_altitude_and_the_mission_resumes() {
    assert_met(SEEDS.map(outage));
}

#[test]
fn hanging_receiver_counts_as_lost() {
    let mut rig = Rig::new(world(1).0, MISSION, 20.0);
    rig.engaged().fly(8.0);
    rig.vehicle
        .apply(&VehicleCommand::from(WorldCommand::FaultOn(Fault::GpsFreeze, None)))
        .accepted()
        .unwrap();
    rig.until(1.0, "gps_lost", |rig| {
        rig.event_at(|kind| matches!(kind, EventKind::Firmware(FirmwareEvent::GpsLost { .. }))).is_some()
    });
    rig.fly(0.1);
    assert_eq!(rig.samples.last().unwrap().state, NavState::Idle);
}

#[test]
fn glitch_does_not_upset_a_hold() {
    assert_met([0, 1].map(|seed| {
        let (world, extra) = world(seed);
        let mut rig = Rig::new(world, "waypoint insert 0 40.4635901 -79.5182000 2000 500 HOLD 0 NONE", 20.0);
        rig.engaged().until_state(60.0, NavState::Holding).fly(10.0);
        let place = rig.waypoint(0);
        rig.vehicle
            .apply(&VehicleCommand::from(WorldCommand::FaultOn(Fault::GpsGlitch(30.0, 90.0), Some(2.0))))
            .accepted()
            .unwrap();
        rig.fly(22.0);
        let mut checks = Checks::default();
        checks.at_most("lean", greatest(rig.span(0.0, 1e9).map(Sample::tilt)), 27.0 + extra.angle);
        checks.at_most("back", rig.samples.last().unwrap().from(place), 1.5 + extra.h);
        checks.holds("state", rig.path().ends_with("HOLDING 0"));
        checks.verdict(&format!("glitch, seed {seed}"), &rig.story())
    }));
}

#[test]
fn landing_among_buildings_does_not_tip_over() {
    const LAND: &str = "waypoint insert 0 40.4635000 -79.5182000 2000 0 LAND 0 ORBIT";
    assert_met((1..=20).map(|seed| {
        let mut world = world(seed).0;
        world.switches.gps = GpsGrade::Urban;
        // Seeds alternate between calm and a breeze with turbulence.
        if seed % 2 == 0 {
            world.wind = "5@200".parse().unwrap();
            world.turbulence = Turbulence::Light;
        }
        let mut rig = Rig::new(world, LAND, 20.0);
        rig.engaged().until(120.0, "disarm", |rig| rig.disarmed().is_some()).fly(2.0);
        let mut checks = Checks::default();
        checks.same("reason", rig.disarmed().unwrap().1, DisarmReason::Landing);
        checks.holds("whole", !rig.vehicle.truth().unwrap().crashed);
        checks.at_most("lean at rest", rig.samples.last().unwrap().tilt(), 2.0);
        checks.verdict(&format!("urban landing, seed {seed}"), &rig.story())
    }));
}
