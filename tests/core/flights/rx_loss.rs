//! Receiver loss in a mission, under each policy and procedure.

use crate::flights::checks::{Checks, assert_met, greatest};
use crate::flights::rig::{Rig, SEEDS, world};
use betadeck_core::plan::WaypointType;
use betadeck_core::telemetry::{DisarmReason, EventKind, FirmwareEvent, Mode, NavState, PlanSource};
use betadeck_core::vehicle::VehicleCommand;

const MISSION: &str = "
waypoint insert 0 40.4648508 -79.5182000 2000 500 FLYOVER 0 ORBIT
waypoint insert 1 40.4648508 -79.5174926 2000 500 LAND 0 ORBIT";

/// Engages, and cuts the link 14 s later. Returns the time of the cut.
fn cut(seed: u64, policy: &str) -> (Rig, f64) {
    let mut rig = Rig::new(world(seed).0, &format!("set ap_rx_loss_policy = {policy}{MISSION}"), 20.0);
    rig.engaged().fly(14.0);
    rig.vehicle.apply(&VehicleCommand::CutRc(true));
    let cut = rig.t();
    (rig, cut)
}

fn stage_2(rig: &Rig) -> f64 {
    rig.event_at(|kind| matches!(kind, EventKind::Firmware(FirmwareEvent::Failsafe { stage: 2, .. })))
        .unwrap()
}

fn lands(seed: u64) -> Option<String> {
    let extra = world(seed).1;
    let (mut rig, cut) = cut(seed, "LAND");
    rig.until(120.0, "disarm", |rig| rig.disarmed().is_some());
    let mut checks = Checks::default();
    let speed = rig.at(cut).speed();
    let steady = greatest(rig.span(cut, cut + 1.3).map(|s| (s.speed() - speed).abs()));
    checks.at_most("speed keeps", steady, 0.3 + extra.speed);
    checks.holds(
        "state keeps",
        rig.span(cut, cut + 1.3).all(|s| s.state == NavState::Approaching && s.wp == 0),
    );
    let lost = rig.event_at(|kind| matches!(kind, EventKind::Firmware(FirmwareEvent::RxLoss))).unwrap();
    checks.within("rx_loss after", lost - cut, 0.15, 0.21);
    let landing = rig.entered(NavState::Landing, 0);
    checks.within("LANDING after", landing - cut, 1.5, 1.8);
    let (source, plan) = rig.plans().pop().unwrap();
    checks.same("source", source, PlanSource::Emergency);
    checks.same("types", plan.waypoints.iter().map(|w| w.kind).collect::<Vec<_>>(), vec![WaypointType::Land]);
    checks.same("plans", rig.plans().len(), 2);
    let place = rig.place(plan.waypoints[0].position);
    let there = rig.at(landing);
    checks.at_most("plan's place", there.from(place), 0.5 + extra.h);
    let alt = plan.waypoints[0].altitude.above_home_m();
    checks.within("plan's altitude", alt - there.alt, -0.5 - extra.v, 0.5 + extra.v);
    for (mode, on) in [
        (Mode::Failsafe, true),
        (Mode::Angle, true),
        (Mode::AltHold, true),
        (Mode::PosHold, true),
        (Mode::Autopilot, false),
    ] {
        checks.same(&mode.to_string(), rig.at(landing + 0.05).modes.has(mode), on);
    }
    checks.at_most("stops within", greatest(rig.span(landing, 1e9).map(|s| s.from(place))), 8.0 + extra.h);
    checks.at_most("touchdown", rig.samples.last().unwrap().from(place), 2.0 + extra.h);
    checks.same("reason", rig.disarmed().unwrap().1, DisarmReason::Landing);
    checks.same("stored plan", rig.vehicle.embedded().unwrap().stored_plan().waypoints.len(), 2);
    checks.verdict(&format!("RX loss LAND, seed {seed}"), &rig.story())
}

#[test]
fn policy_land_lands_where_the_link_was_lost() {
    assert_met(SEEDS.map(lands));
}

#[test]
fn link_back_with_centred_sticks_keeps_landing() {
    let (mut rig, cut) = cut(0, "LAND");
    rig.fly(10.0);
    rig.vehicle.apply(&VehicleCommand::CutRc(false));
    rig.until(120.0, "disarm", |rig| rig.disarmed().is_some());
    assert_eq!(rig.path(), "APPROACHING 0, LANDING 0, COMPLETE 0");
    assert!(rig.disarmed().unwrap().0 > cut + 30.0);
}

#[test]
fn stick_takes_over_from_the_emergency_landing() {
    let (mut rig, _) = cut(0, "LAND");
    rig.fly(5.0);
    rig.vehicle.apply(&VehicleCommand::CutRc(false));
    rig.vehicle.apply(&VehicleCommand::StopPilot);
    rig.stick(5, 1000);
    rig.fly(1.0);
    assert!(rig.samples.last().unwrap().modes.has(Mode::Failsafe));
    rig.stick(0, 1700);
    rig.fly(0.2);
    let now = *rig.samples.last().unwrap();
    assert!(
        !now.modes.has(Mode::Failsafe) && !now.modes.has(Mode::Autopilot) && now.modes.has(Mode::AltHold)
    );
    assert_eq!(now.state, NavState::Idle);
    assert!(now.armed);
}

#[test]
fn policy_continue_flies_the_mission_to_its_touchdown() {
    assert_met([0, 1].map(|seed| {
        let extra = world(seed).1;
        let (mut rig, _) = cut(seed, "CONTINUE");
        rig.until(180.0, "disarm", |rig| rig.disarmed().is_some());
        let mut checks = Checks::default();
        checks.same(
            "states",
            rig.path().as_str(),
            "APPROACHING 0, ARRIVED 0, APPROACHING 1, ARRIVED 1, LANDING 1, COMPLETE 1",
        );
        let place = rig.waypoint(1);
        checks.at_most("touchdown", rig.samples.last().unwrap().from(place), 1.5 + extra.h);
        let on = stage_2(&rig) + 0.1;
        checks.holds("FAILSAFE and AUTOPILOT", {
            let modes = rig.at(on).modes;
            modes.has(Mode::Failsafe) && modes.has(Mode::Autopilot)
        });
        checks.verdict(&format!("RX loss CONTINUE, seed {seed}"), &rig.story())
    }));
}

#[test]
fn policy_disable_runs_the_procedure() {
    let (mut rig, cut) = cut(0, "DISABLE");
    rig.until(5.0, "disarm", |rig| rig.disarmed().is_some()).fly(0.02);
    let (at, reason) = rig.disarmed().unwrap();
    assert_eq!(reason, DisarmReason::Failsafe);
    assert!((1.5..=1.8).contains(&(at - cut)), "{}", at - cut);
    assert_eq!(rig.samples.last().unwrap().state, NavState::Idle);
}

#[test]
fn auto_land_descends_and_disarms() {
    let mut rig = Rig::new(world(0).0, &format!("set failsafe_procedure = AUTO-LAND{MISSION}"), 20.0);
    rig.engaged().fly(14.0);
    rig.vehicle.apply(&VehicleCommand::CutRc(true));
    rig.until(60.0, "disarm", |rig| rig.disarmed().is_some());
    assert_eq!(rig.disarmed().unwrap().1, DisarmReason::Landing);
    let began = stage_2(&rig);
    let landed = rig.disarmed().unwrap().0;
    // 1.9 m/s at 20 m, 1 m/s near the ground.
    assert!((10.0..=25.0).contains(&(landed - began)), "{}", landed - began);
    let impact = rig.events.iter().find_map(|event| match event.kind {
        EventKind::Contact { impact_mps } => Some(impact_mps),
        _ => None,
    });
    assert!(impact.unwrap() < 1.3, "{impact:?}");
    rig.fly(0.2);
    let flags = rig.vehicle.embedded().unwrap().arming_flags();
    assert!(flags.iter().any(|flag| flag.to_string() == "FAILSAFE"));
}

#[test]
fn a_link_lost_in_a_fast_climb_does_not_stop_the_motors_up_there() {
    let lines = format!("set failsafe_procedure = AUTO-LAND{MISSION}");
    let mut rig = Rig::new(world(1).0, &lines, 0.5);
    rig.engaged();
    rig.until(30.0, "a fast climb", |rig| rig.samples.last().is_some_and(|now| now.vu > 3.5));
    rig.vehicle.apply(&VehicleCommand::CutRc(true));
    rig.until(120.0, "disarmed", |rig| rig.disarmed().is_some());
    let truth = rig.vehicle.truth().unwrap();
    assert!(truth.on_ground && !truth.crashed, "{}", rig.story());
}

#[test]
fn rescue_flies_home_at_its_altitude() {
    let lines = format!(
        "set failsafe_procedure = GPS-RESCUE\nset gps_rescue_alt_mode = FIXED_ALT\nset gps_rescue_return_alt = 30{MISSION}"
    );
    let mut rig = Rig::new(world(0).0, &lines, 20.0);
    rig.engaged().fly(14.0);
    rig.vehicle.apply(&VehicleCommand::CutRc(true));
    rig.until(180.0, "disarm", |rig| rig.disarmed().is_some());
    assert_eq!(rig.plans().last().unwrap().0, PlanSource::Rth);
    let began = stage_2(&rig);
    let top = greatest(rig.span(began, 1e9).map(|s| s.alt));
    assert!((29.5..=32.0).contains(&top), "{top}");
    let last = rig.samples.last().unwrap();
    assert!(last.from([0.0, 0.0]) < 1.0, "{last:?}");
    assert_eq!(rig.disarmed().unwrap().1, DisarmReason::Landing);
}

#[test]
fn lost_fix_in_the_emergency_landing_descends_by_altitude_alone() {
    use betadeck_core::sim::{Fault, WorldCommand};
    let (mut rig, _) = cut(0, "LAND");
    rig.fly(5.0);
    rig.vehicle.apply(&VehicleCommand::from(WorldCommand::FaultOn(Fault::GpsLoss, None))).accepted().unwrap();
    rig.until(60.0, "disarm", |rig| rig.disarmed().is_some());
    let procedures: Vec<&str> = rig
        .events
        .iter()
        .filter_map(|event| match event.kind {
            EventKind::Firmware(FirmwareEvent::Failsafe { stage: 2, procedure, .. }) => {
                Some(procedure.into())
            }
            _ => None,
        })
        .collect();
    assert_eq!(procedures, ["LAND", "AUTO-LAND"]);
    assert_eq!(rig.disarmed().unwrap().1, DisarmReason::Landing);
}
