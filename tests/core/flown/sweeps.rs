//! Sweeps: one fault at every second of a flight.

use betadeck_core::vehicle::VehicleCommand;
use std::collections::BTreeSet;

use betadeck_core::flight::sweep::{Fate, Sweep, SweepPoint};
use betadeck_core::flight::{Flight, FlightEnd, FlightOptions, FlightResult, FlightSetup};
use betadeck_core::plan::builtin::BuiltinPlan;
use betadeck_core::plan::{Seconds, Waypoint, WaypointType};
use betadeck_core::sim::WorldCommand;

/// The time for which the plans hold at their first waypoint, s. The flights last longer than fifty seconds.
const HOLD_S: f64 = 20.0;

fn flight(plan: &str) -> Flight {
    let mut plan = BuiltinPlan::find(plan).unwrap().read().unwrap();
    let first = plan.plan.waypoints[0];
    let hold = Waypoint { kind: WaypointType::Hold, duration: Seconds::new(HOLD_S), ..first };
    plan.plan.waypoints.insert(0, hold);
    let mut setup = FlightSetup { plan: plan.clone(), ..FlightSetup::default() };
    setup.world.wind = "4@270".parse().unwrap();
    setup.stored.plan = plan.plan;
    let (vehicle, _) = setup.build().unwrap();
    Flight::new(vehicle, &FlightOptions::default()).unwrap()
}

fn swept(plan: &str, fault: &str) -> Vec<SweepPoint> {
    let mut sweep = Sweep::new(flight(plan), fault.parse().unwrap());
    let mut points = Vec::new();
    while let Some(branch) = sweep.next_branch(&|| false).unwrap() {
        points.extend(branch.fly(&|| false));
    }
    assert_eq!(sweep.end().map(|end| end.verdict.result), Some(FlightResult::Complete));
    points
}

/// Flies the whole flight with a fault that is scheduled before boot.
fn whole(plan: &str, fault: &str) -> (FlightEnd, [f64; 3]) {
    let mut flight = flight(plan);
    flight
        .vehicle_mut()
        .apply(&VehicleCommand::from(WorldCommand::Schedule(fault.parse().unwrap())))
        .accepted()
        .unwrap();
    loop {
        if let Some(end) = flight.tick(drop) {
            return (end, flight.vehicle().truth().unwrap().pos_enu.into());
        }
    }
}

part_and_search!(agrees_with_whole_flights, every 8, a_sweep_agrees_with_whole_flights, a_sweep_agrees_with_whole_flights_at_fifty_seconds);

fn agrees_with_whole_flights(n: usize) {
    let points = swept("land", "gps-loss@0,6");
    let seconds: Vec<u32> = points.iter().map(|point| point.second).collect();
    assert_eq!(seconds, (0..points.len() as u32).collect::<Vec<_>>());
    // Fifty seconds, in an order without a pattern.
    let count = points.len();
    assert!(count >= 50, "{count}");
    let chosen: BTreeSet<usize> = (0..count).map(|i| i * 7919 % count).take(50).collect();
    assert_eq!(chosen.len(), 50);
    for index in chosen.into_iter().step_by(n) {
        let point = &points[index];
        let (end, [east, north, _]) = whole("land", &format!("gps-loss@{index},6"));
        assert_eq!((point.result, &point.reason), (end.verdict.result, &end.verdict.reason), "at {index} s");
        let home = east.hypot(north);
        assert!(point.off_m <= home, "at {index} s: {} m, and {home} m from home", point.off_m);
        let begun = end.time.as_secs_f64() - end.flown_s + index as f64;
        assert!((point.after_s - (end.time.as_secs_f64() - begun).max(0.0)).abs() < 0.1, "at {index} s");
    }
}

#[test]
fn a_lost_motor_loses_the_craft_in_the_air_and_not_on_the_ground() {
    let points = swept("land", "motor@0,,1:0");
    assert!(points.iter().any(|point| point.fate == Fate::Lost && point.result == FlightResult::Crashed));
    let last = points.last().unwrap();
    assert_eq!(last.fate, Fate::Home, "after the touchdown: {}", last.reason);
    assert!(points[5].place_enu[2] > 1.0, "the craft flies when its motor stops");
}

#[test]
fn a_fault_that_the_flight_cannot_have_is_refused() {
    let mut sweep = Sweep::new(flight("land"), "stall@0,1".parse().unwrap());
    assert!(sweep.next_branch(&|| false).is_err());
}
