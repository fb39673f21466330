//! The fence. It refuses plans beyond it, and lands or returns a craft that leaves it.

use crate::flights::checks::{Checks, assert_met, greatest};
use crate::flights::rig::{Rig, SEEDS, world};
use betadeck_core::pilot::StickInput;
use betadeck_core::plan::WaypointType;
use betadeck_core::telemetry::{EventKind, FirmwareEvent, Mode, NavEvent, NavState, PlanSource, Refusal};
use betadeck_core::vehicle::VehicleCommand;

const FENCE: &str = "set ap_max_distance_from_home = 100\n";

#[test]
fn plan_beyond_the_fence_is_refused() {
    let lines = format!("{FENCE}waypoint insert 0 40.4648508 -79.5182000 2000 500 FLYOVER 0 ORBIT");
    let mut rig = Rig::new(world(0).0, &lines, 20.0);
    rig.until(60.0, "refusal", |rig| {
        rig.event_at(|kind| {
            matches!(
                kind,
                EventKind::Firmware(FirmwareEvent::Nav(NavEvent::Refused(Refusal::Geofence { .. })))
            )
        })
        .is_some()
    });
    let before = *rig.samples.last().unwrap();
    rig.fly(8.0);
    let refused: Vec<_> = rig
        .events
        .iter()
        .filter_map(|event| match &event.kind {
            EventKind::Firmware(FirmwareEvent::Nav(NavEvent::Refused(refusal))) => Some(*refusal),
            _ => None,
        })
        .collect();
    let [Refusal::Geofence { wp: 0, distance_cm, limit_m: 100 }] = refused[..] else { panic!("{refused:?}") };
    assert_eq!((distance_cm + 50) / 100, 150);
    assert_eq!(refused[0].sentence(), "Waypoint 0 is 150 m from home, the fence is 100 m.");
    assert_eq!(rig.transitions(), []);
    let last = *rig.samples.last().unwrap();
    assert!(last.armed && !last.modes.has(Mode::Autopilot) && last.modes.has(Mode::AltHold));
    let step = greatest((0..4).map(|motor| (last.motors[motor] - before.motors[motor]).abs()));
    assert!(step <= 0.03, "{step}");
}

/// Flies to a HOLD 80 m north and pushes the stick forward until the state changes.
fn pushed_out(seed: u64, action: &str, alt_cm: u32, takeoff_m: f64) -> Rig {
    let lines = format!(
        "{FENCE}set ap_geofence_action = {action}\nset ap_max_velocity = 1000\n\
         waypoint insert 0 40.4642204 -79.5182000 {alt_cm} 500 HOLD 0 NONE"
    );
    let mut rig = Rig::new(world(seed).0, &lines, takeoff_m);
    rig.engaged().until_state(60.0, NavState::Holding).fly(5.0);
    let forward = StickInput { channel: 1, value_us: 2000, at_s: 0.0, for_s: None, from_boot: true };
    rig.vehicle.apply(&VehicleCommand::HoldChannel(forward));
    let seen = rig.transitions().len();
    rig.until(30.0, "the fence", |rig| rig.transitions().len() > seen);
    rig.release_channels();
    rig
}

fn trigger_checks(checks: &mut Checks, rig: &Rig, extra: crate::flights::rig::Allowance) -> f64 {
    let trigger = rig
        .event_at(|kind| matches!(kind, EventKind::Firmware(FirmwareEvent::Nav(NavEvent::Geofence { .. }))))
        .unwrap();
    let fences = rig
        .events
        .iter()
        .filter(|event| {
            matches!(event.kind, EventKind::Firmware(FirmwareEvent::Nav(NavEvent::Geofence { .. })))
        })
        .count();
    checks.same("geofence events", fences, 1);
    checks.within("triggered at", rig.at(trigger).n, 99.0 - extra.h, 100.3 + extra.h);
    checks.same("stored plan", rig.vehicle.embedded().unwrap().stored_plan().waypoints.len(), 1);
    checks.same(
        "stored type",
        rig.vehicle.embedded().unwrap().stored_plan().waypoints[0].kind,
        WaypointType::Hold,
    );
    trigger
}

fn fence_lands(seed: u64) -> Option<String> {
    let extra = world(seed).1;
    let mut rig = pushed_out(seed, "LAND", 2000, 20.0);
    rig.until(120.0, "disarm", |rig| rig.disarmed().is_some());
    let mut checks = Checks::default();
    let trigger = trigger_checks(&mut checks, &rig, extra);
    let (source, plan) = rig.plans().pop().unwrap();
    checks.same("source", source, PlanSource::Emergency);
    checks.same("count", plan.waypoints.len(), 1);
    checks.same("type", plan.waypoints[0].kind, WaypointType::Land);
    let place = rig.place(plan.waypoints[0].position);
    checks.at_most("plan's place", rig.at(trigger).from(place), 0.5 + extra.h);
    checks.at_most("farthest", greatest(rig.span(0.0, 1e9).map(|s| s.n.hypot(s.e))), 120.0 + extra.h);
    checks.at_most("touchdown", rig.samples.last().unwrap().from(place), 2.0 + extra.h);
    checks.verdict(&format!("fence LAND, seed {seed}"), &rig.story())
}

fn fence_returns(seed: u64) -> Option<String> {
    let extra = world(seed).1;
    let mut rig = pushed_out(seed, "RTH", 3000, 30.0);
    rig.until(180.0, "disarm", |rig| rig.disarmed().is_some());
    let mut checks = Checks::default();
    let trigger = trigger_checks(&mut checks, &rig, extra);
    let (source, plan) = rig.plans().pop().unwrap();
    checks.same("source", source, PlanSource::Rth);
    let kinds: Vec<_> = plan.waypoints.iter().map(|waypoint| waypoint.kind).collect();
    checks.same("types", kinds, vec![WaypointType::Flyover, WaypointType::Land]);
    for waypoint in &plan.waypoints {
        let alt = waypoint.altitude.above_home_m();
        checks.within("altitude", alt - rig.at(trigger).alt, -0.5 - extra.v, 0.5 + extra.v);
    }
    let home = rig.transitions().into_iter().find(|entry| entry.t > trigger + 0.1).unwrap();
    checks.within("home after", home.t - trigger, 12.0, 24.0);
    checks.at_most("home within", rig.at(home.t).from([0.0, 0.0]), 5.0 + extra.h);
    checks.holds(
        "states",
        rig.path().ends_with("APPROACHING 0, ARRIVED 0, APPROACHING 1, ARRIVED 1, LANDING 1, COMPLETE 1"),
    );
    checks.at_most("touchdown", rig.samples.last().unwrap().from([0.0, 0.0]), 1.0 + extra.h);
    checks.verdict(&format!("fence RTH, seed {seed}"), &rig.story())
}

#[test]
fn leaving_the_fence_lands_on_the_spot() {
    assert_met(SEEDS.map(fence_lands));
}

#[test]
fn leaving_the_fence_returns_home() {
    assert_met(SEEDS.map(fence_returns));
}
