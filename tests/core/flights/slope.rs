//! Landings on sloping ground, below and above home.

use crate::flights::checks::{Checks, assert_met};
use crate::flights::rig::{Rig, world};
use betadeck_core::sim::{Fault, WorldCommand};
use betadeck_core::telemetry::{DisarmReason, EventKind, NavState};
use betadeck_core::vehicle::VehicleCommand;

/// A LAND 100 m east of home, 20 m above it.
const LAND_EAST: &str = "waypoint insert 0 40.4635000 -79.5170205 2000 500 LAND 0 NONE";

/// Returns the sink rate at the last touchdown, m/s, and `true` if the craft crashed.
fn impact(rig: &Rig) -> (f64, bool) {
    let mut impact_mps = f64::NAN;
    let mut crashed = false;
    for event in &rig.events {
        match event.kind {
            EventKind::Touchdown { impact_mps: speed, .. } => impact_mps = speed,
            EventKind::Crash { .. } => crashed = true,
            _ => {}
        }
    }
    (impact_mps, crashed)
}

fn is_down_at(checks: &mut Checks, rig: &Rig, ground_m: f64, impact_limit_mps: f64) {
    let (disarm, reason) = rig.disarmed().unwrap();
    checks.same("reason", reason, DisarmReason::Landing);
    let (impact_mps, crashed) = impact(rig);
    checks.holds("no crash", !crashed);
    checks.at_most("touchdown", impact_mps, impact_limit_mps);
    checks.holds("a touchdown", impact_mps.is_finite());
    checks.at_most("height at the disarm", (rig.at(disarm).alt - ground_m).abs(), 0.6);
    checks.at_most("place", rig.samples.last().unwrap().from(rig.waypoint(0)), 4.0);
    checks.holds("stands", rig.vehicle.truth().unwrap().on_ground);
}

#[test]
fn a_land_below_and_above_home_ends_gently_on_the_ground_there() {
    let rows = [("slope,8,270", -8.0), ("slope,8,90", 8.0), ("slope,15,270", -15.0), ("slope,15,90", 15.0)];
    assert_met(rows.into_iter().flat_map(|(ground, ground_m)| {
        [0, 1].map(|seed| {
            let mut world = world(seed).0;
            world.switches.set(&format!("ground={ground}")).unwrap();
            let mut rig = Rig::new(world, LAND_EAST, 20.0);
            rig.engaged().until_state(60.0, NavState::Landing);
            rig.until(180.0, "disarm", |rig| rig.disarmed().is_some()).fly(2.0);
            let mut checks = Checks::default();
            // On steep ground one leg touches first, and the craft may bounce.
            is_down_at(&mut checks, &rig, ground_m, if ground_m.abs() > 10.0 { 1.5 } else { 1.0 });
            checks.verdict(&format!("{ground}, seed {seed}"), &rig.story())
        })
    }));
}

#[test]
fn a_descent_without_a_fix_ends_on_sloping_ground_too() {
    assert_met([("slope,8,270", -8.0), ("slope,8,90", 8.0)].map(|(ground, ground_m)| {
        let mut world = world(1).0;
        world.switches.set(&format!("ground={ground}")).unwrap();
        let mut rig = Rig::new(world, LAND_EAST, 20.0);
        rig.engaged().until_state(60.0, NavState::Landing).fly(2.0);
        rig.vehicle
            .apply(&VehicleCommand::from(WorldCommand::FaultOn(Fault::GpsLoss, None)))
            .accepted()
            .unwrap();
        rig.until(240.0, "disarm", |rig| rig.disarmed().is_some()).fly(2.0);
        let mut checks = Checks::default();
        let (disarm, reason) = rig.disarmed().unwrap();
        checks.same("reason", reason, DisarmReason::Landing);
        let (impact_mps, crashed) = impact(&rig);
        checks.holds("no crash", !crashed);
        checks.at_most("touchdown", impact_mps, 1.0);
        checks.at_most("height at the disarm", (rig.at(disarm).alt - ground_m).abs(), 2.0);
        checks.holds("stands", rig.vehicle.truth().unwrap().on_ground);
        checks.verdict(ground, &rig.story())
    }));
}
