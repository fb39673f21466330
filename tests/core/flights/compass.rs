//! Flights with a wrong compass and without a compass.

use crate::flights::checks::{Checks, assert_met};
use crate::flights::rig::{Rig, world};
use betadeck_core::sim::{Fault, WorldCommand};
use betadeck_core::telemetry::{DisarmReason, EventKind, FirmwareEvent, NavEvent, Refusal};
use betadeck_core::vehicle::VehicleCommand;

const LAND: &str = "waypoint insert 0 40.4635000 -79.5182000 2000 0 LAND 0 ORBIT";
const SQUARE: &str = "
waypoint insert 0 40.4640403 -79.5182000 2000 500 FLYOVER 0 ORBIT
waypoint insert 1 40.4640403 -79.5174926 2000 500 FLYOVER 0 ORBIT
waypoint insert 2 40.4635000 -79.5174926 2000 500 LAND 0 ORBIT";

/// Returns the error of the estimated heading, degrees.
fn heading_error_deg(rig: &Rig) -> f64 {
    let believed = rig.vehicle.embedded().unwrap().estimate().heading_rad.to_degrees();
    let truth = rig.vehicle.truth().unwrap().heading_deg();
    ((believed - truth + 180.0).rem_euclid(360.0) - 180.0).abs()
}

fn doubts(rig: &Rig) -> Vec<bool> {
    let doubt = |kind: &EventKind| match kind {
        EventKind::Firmware(FirmwareEvent::HeadingDoubt { on, .. }) => Some(*on),
        _ => None,
    };
    rig.events.iter().filter_map(|event| doubt(&event.kind)).collect()
}

fn landing_with_bias(seed: u64, plan: &str, bias_deg: f64) -> Option<String> {
    let mut rig = Rig::new(world(seed).0, &format!("set trust_mag = ON\n{plan}"), 20.0);
    rig.engaged().fly(5.0);
    rig.vehicle
        .apply(&VehicleCommand::from(WorldCommand::FaultOn(Fault::MagBias(bias_deg), None)))
        .accepted()
        .unwrap();
    rig.until(240.0, "disarm", |rig| rig.disarmed().is_some() || rig.vehicle.truth().unwrap().crashed);
    let mut checks = Checks::default();
    checks.holds("whole", !rig.vehicle.truth().unwrap().crashed);
    checks.same("reason", rig.disarmed().map(|(_, reason)| reason), Some(DisarmReason::Landing));
    checks.holds("reported", doubts(&rig).first() == Some(&true));
    checks.at_most("heading", heading_error_deg(&rig), 25.0);
    let last = *rig.samples.last().unwrap();
    let place = rig.waypoint(rig.vehicle.embedded().unwrap().stored_plan().waypoints.len() - 1);
    checks.at_most("from the landing point", last.from(place), 5.0);
    checks.verdict(&format!("compass {bias_deg}° off, seed {seed}"), &rig.story())
}

#[test]
fn trusted_compass_that_goes_wrong_does_not_crash_the_craft() {
    assert_met([0, 1, 2, 3].into_iter().flat_map(|seed| {
        [(LAND, 60.0), (LAND, -90.0), (SQUARE, 60.0), (SQUARE, 150.0)]
            .map(|(plan, bias)| landing_with_bias(seed, plan, bias))
    }));
}

#[test]
fn sound_compass_is_not_doubted() {
    for (seed, wind) in [(1, "calm"), (2, "8@225"), (3, "5@90")] {
        let mut world = world(seed).0;
        world.wind = wind.parse().unwrap();
        world.gust_mps = 3.0;
        let mut rig = Rig::new(world, &format!("set trust_mag = ON\n{SQUARE}"), 20.0);
        rig.engaged().until(240.0, "disarm", |rig| rig.disarmed().is_some());
        assert!(doubts(&rig).is_empty(), "{}", rig.story());
    }
}

/// Flies a craft that does not know its heading until it has flown straight.
fn without_compass(seed: u64, heading_deg: f64, wind: &str) -> Option<String> {
    let mut world = world(seed).0;
    world.home.heading_deg = heading_deg;
    world.wind = wind.parse().unwrap();
    world.faults.push("mag-off@boot+0".parse().unwrap());
    let mut rig = Rig::new(world, SQUARE, 20.0);
    let is_refusal = |kind: &EventKind| {
        matches!(kind, EventKind::Firmware(FirmwareEvent::Nav(NavEvent::Refused(Refusal::NoHeading))))
    };
    let mut checks = Checks::default();
    // In wind, a craft that is only levelled drifts straight enough to show its heading.
    if wind == "calm" {
        rig.until(60.0, "a refusal", |rig| rig.event_at(is_refusal).is_some());
        checks.holds("unknown", !rig.vehicle.embedded().unwrap().estimate().heading_valid);
    }
    rig.engaged();
    checks.at_most("heading at the engagement", heading_error_deg(&rig), 15.0);
    rig.until(240.0, "disarm", |rig| rig.disarmed().is_some());
    checks.same("reason", rig.disarmed().unwrap().1, DisarmReason::Landing);
    checks.holds("whole", !rig.vehicle.truth().unwrap().crashed);
    let last = *rig.samples.last().unwrap();
    checks.at_most("from the landing point", last.from(rig.waypoint(2)), 3.0);
    checks.verdict(&format!("no compass, facing {heading_deg}, {wind}, seed {seed}"), &rig.story())
}

#[test]
fn flight_without_compass_finds_its_heading_by_flying_ahead() {
    assert_met(
        [(0, 0.0, "calm"), (1, 0.0, "calm"), (2, 120.0, "calm"), (3, 250.0, "5@30")]
            .map(|(seed, heading, wind)| without_compass(seed, heading, wind)),
    );
}
