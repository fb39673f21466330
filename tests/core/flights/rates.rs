//! The same flight at other step rates, repeated, and continued from a frozen copy.

use crate::flights::checks::{Checks, assert_met, greatest};
use crate::flights::rig::{Rig, world};
use betadeck_core::telemetry::{DisarmReason, NavState};

const PLAN: &str = "
waypoint insert 0 40.4636801 -79.5182000 1500 500 HOLD 100 NONE
waypoint insert 1 40.4635000 -79.5182000 1000 500 LAND 0 ORBIT";

fn hold_and_land(rate_hz: u32) -> Option<String> {
    let (mut world, _) = world(0);
    world.rate_hz = rate_hz;
    let mut rig = Rig::new(world, PLAN, 10.0);
    rig.engaged().until(150.0, "disarm", |rig| rig.disarmed().is_some());
    let mut checks = Checks::default();
    let held = rig.entered(NavState::Holding, 0);
    let place = rig.waypoint(0);
    let off = greatest(rig.span(held + 5.0, held + 9.9).map(|s| s.from(place)));
    checks.at_most("hold", off, 1.0);
    checks.same("reason", rig.disarmed().unwrap().1, DisarmReason::Landing);
    checks.at_most("touchdown", rig.samples.last().unwrap().from(rig.waypoint(1)), 1.0);
    checks.within("hold time", rig.entered(NavState::Approaching, 1) - held, 9.99, 10.01);
    checks.verdict(&format!("{rate_hz} Hz"), &rig.story())
}

#[test]
fn every_rate_flies_alike() {
    assert_met([400, 500, 1000, 2000, 4000, 8000].map(hold_and_land));
}

#[test]
fn same_inputs_give_the_same_flight_to_the_last_bit() {
    let fly = || {
        let mut rig = Rig::new(world(3).0, PLAN, 10.0);
        rig.engaged().fly(20.0);
        *rig.vehicle.truth().unwrap()
    };
    assert_eq!(fly(), fly());
}

#[test]
fn frozen_copy_goes_on_identically() {
    let mut rig = Rig::new(world(2).0, PLAN, 10.0);
    rig.engaged().fly(5.0);
    let mut copy = rig.vehicle.clone();
    rig.fly(10.0);
    while copy.time() < rig.vehicle.time() {
        copy.tick();
    }
    assert_eq!(copy.truth().unwrap(), rig.vehicle.truth().unwrap());
    assert_eq!(copy.embedded().unwrap().nav(), rig.vehicle.embedded().unwrap().nav());
}
