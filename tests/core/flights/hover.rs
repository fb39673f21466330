//! Flights with a hover throttle that is configured up to 250 µs wrong.

use crate::flights::checks::{Checks, assert_met, greatest};
use crate::flights::rig::{Rig, Sample, world};
use betadeck_core::sim::Airframe;
use betadeck_core::telemetry::{DisarmReason, EventKind, FirmwareEvent, NavEvent, NavState, Refusal};

/// The firmware's default altitude gains, in place of the guide's.
const DEFAULT_GAINS: &str = "
set ap_altitude_p = 15
set ap_altitude_i = 20
set ap_altitude_d = 30
set ap_altitude_f = 30
";

/// The configured hover throttles, for a true one of 1507 µs: 250 µs below it, the firmware's default, the
/// highest value, and 0, which is captured.
const HOVERS: [u16; 4] = [1257, 1275, 1700, 0];

fn hold_and_land(seed: u64, gains: &str, hover: u16) -> Option<String> {
    let (world, extra) = world(seed);
    let lines = format!(
        "{gains}set ap_hover_throttle = {hover}
waypoint insert 0 40.4635901 -79.5182000 2000 500 HOLD 300 NONE
waypoint insert 1 40.4635901 -79.5182000 1200 500 LAND 0 NONE"
    );
    let mut rig = Rig::new(world, &lines, 20.0);
    rig.engaged().until(200.0, "disarm", |rig| rig.disarmed().is_some()).fly(1.0);
    let mut checks = Checks::default();
    let (disarm, reason) = rig.disarmed().unwrap();
    checks.same("reason", reason, DisarmReason::Landing);
    let leaving = rig.entered(NavState::Approaching, 1);
    let off = |s: &Sample| (s.alt - 20.0).abs();
    checks.at_most("altitude after 15 s", greatest(rig.span(15.0, leaving).map(off)), 1.0 + extra.v);
    let contact = rig.event_at(|kind| matches!(kind, EventKind::Contact { .. }));
    checks.within("disarm after contact", disarm - contact.unwrap_or(f64::INFINITY), 1.0, 30.0);
    checks.at_most("height at the disarm", rig.at(disarm).alt, 0.05);
    checks.verdict(&format!("hover {hover}, seed {seed}, gains {gains:?}"), &rig.story())
}

part_and_search!(wrong_hover_throttles, every 5, wrong_hover_throttle_keeps_its_altitude_and_lands, wrong_hover_throttle_keeps_its_altitude_and_lands_in_every_case);

fn wrong_hover_throttles(n: usize) {
    let flights = [0, 1, 2, 3].into_iter().flat_map(|seed| {
        ["\n", DEFAULT_GAINS].into_iter().flat_map(move |gains| HOVERS.map(|hover| (seed, gains, hover)))
    });
    assert_met(flights.step_by(n).map(|(seed, gains, hover)| hold_and_land(seed, gains, hover)));
}

/// Engages on the ground, before anything has been learned.
#[test]
fn wrong_hover_throttle_takes_off() {
    let take_off = |hover: u16, seed: u64| {
        let (world, extra) = world(seed);
        let lines = format!(
            "set ap_hover_throttle = {hover}
waypoint insert 0 40.4635000 -79.5182000 1200 0 TAKEOFF 200 NONE
waypoint insert 1 40.4635901 -79.5182000 1200 300 LAND 0 NONE"
        );
        let mut rig = Rig::new(world, &lines, 0.0);
        rig.engaged().until(200.0, "disarm", |rig| rig.disarmed().is_some());
        let mut checks = Checks::default();
        let leaving = rig.entered(NavState::Approaching, 1);
        let arrived = rig.entered(NavState::Holding, 0);
        let steady = rig.span(arrived.max(15.0), leaving).map(|s| (s.alt - 12.0).abs());
        checks.at_most("altitude after 15 s", greatest(steady), 1.0 + extra.v);
        checks.at_most("climb", greatest(rig.span(0.0, leaving).map(|s| s.alt)), 16.0 + extra.v);
        checks.same("reason", rig.disarmed().unwrap().1, DisarmReason::Landing);
        checks.verdict(&format!("take-off, hover {hover}, seed {seed}"), &rig.story())
    };
    assert_met([1257, 1507, 1700].into_iter().flat_map(|hover| [0, 1].map(|seed| take_off(hover, seed))));
}

/// Returns a craft that loses three times as much thrust in a climb and has three times the drag.
fn draggy(airframe: Airframe) -> Airframe {
    let mut airframe = airframe;
    airframe.inflow_coeff *= 3.0;
    airframe.body_drag.z *= 3.0;
    airframe
}

fn climb(airframe: Airframe, gains: &str, to_m: f64, takeoff_m: f64) -> Option<String> {
    let (mut world, _) = world(0);
    let flight = format!("{} from {takeoff_m} to {to_m} m, gains {gains:?}", airframe.name);
    world.airframe = draggy(airframe);
    let lines = format!("{gains}waypoint insert 0 40.4635000 -79.5182000 {:.0} 0 HOLD 0 NONE", 100.0 * to_m);
    let mut rig = Rig::new(world, &lines, takeoff_m);
    rig.engaged().fly(60.0);
    let mut checks = Checks::default();
    checks.at_most("above its altitude", greatest(rig.span(0.0, 60.0).map(|s| s.alt - to_m)), 1.5);
    checks.at_most("off after 50 s", greatest(rig.span(50.0, 60.0).map(|s| (s.alt - to_m).abs())), 1.0);
    checks.verdict(&flight, &rig.story())
}

#[test]
fn a_climb_against_drag_is_not_taken_for_hover() {
    let airframes = [Airframe::iris(), Airframe::five_inch()];
    assert_met(airframes.iter().flat_map(|airframe| {
        ["\n", DEFAULT_GAINS].into_iter().flat_map(|gains| {
            [(20.0, 10.0), (40.0, 10.0), (10.0, 0.0)]
                .map(|(to_m, takeoff_m)| climb(airframe.clone(), gains, to_m, takeoff_m))
        })
    }));
}

/// Flies with a throttle minimum that lifts the craft. In the air it is refused with the numbers. A craft
/// that engages on the ground still stays where it is sent.
#[test]
fn a_throttle_floor_above_the_hover_does_not_carry_the_craft_away() {
    let (mut world, _) = world(0);
    world.airframe = Airframe::five_inch();
    let lines = "set ap_throttle_min = 1400\nwaypoint insert 0 40.4635901 -79.5182000 2000 500 HOLD 0 NONE";
    let highest = |rig: &Rig| greatest(rig.samples.iter().map(|s| s.alt));
    for (gains, takeoff_m) in [("", 20.0), (DEFAULT_GAINS, 10.0)] {
        let mut in_the_air = Rig::new(world.clone(), &format!("{gains}{lines}"), takeoff_m);
        in_the_air.until(90.0, "the refusal", |rig| {
            rig.events.iter().any(|event| {
                matches!(
                    event.kind,
                    EventKind::Firmware(FirmwareEvent::Nav(NavEvent::Refused(Refusal::ThrottleMin {
                        throttle_min_us: 1400,
                        hover_us: 1200..1400
                    })))
                )
            })
        });
        in_the_air.fly(20.0);
        let refusals = in_the_air.events.iter().filter(|event| {
            matches!(event.kind, EventKind::Firmware(FirmwareEvent::Nav(NavEvent::Refused(_))))
        });
        assert_eq!(refusals.count(), 1, "one report of one cause");
        assert!(highest(&in_the_air) < 40.0, "{} m", highest(&in_the_air));
    }
    let mut on_the_ground = Rig::new(world, lines, 0.0);
    on_the_ground.engaged().fly(60.0);
    assert!(highest(&on_the_ground) < 30.0, "{} m", highest(&on_the_ground));
}
