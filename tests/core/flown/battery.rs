//! The battery in the verdict of a flight.

use betadeck_core::flight::{Flight, FlightEnd, FlightOptions, FlightResult, FlightSetup};
use betadeck_core::plan::builtin::BuiltinPlan;
use betadeck_core::signals::SimTime;

/// Returns the end of a flight of the built-in `land` with a battery that lasts for half a minute.
fn with_a_small_battery(battery_sag: bool) -> FlightEnd {
    let plan = BuiltinPlan::find("land").unwrap().read().unwrap();
    let mut setup = FlightSetup { plan: plan.clone(), ..FlightSetup::default() };
    setup.world.switches.battery_capacity_ah = Some(0.035);
    setup.world.switches.battery_sag = battery_sag;
    setup.stored.plan = plan.plan;
    let (vehicle, _) = setup.build().unwrap();
    let options = FlightOptions { takeoff_m: 10.0, timeout: SimTime(600_000_000), tolerance_m: 10.0 };
    let mut flight = Flight::new(vehicle, &options).unwrap();
    loop {
        if let Some(end) = flight.tick(|_| {}) {
            return end;
        }
    }
}

#[test]
fn the_verdict_says_when_the_battery_was_empty() {
    let real = with_a_small_battery(true).verdict;
    assert_eq!(real.result, FlightResult::Crashed);
    assert!(real.reason.contains("; the battery was empty "), "{}", real.reason);
    let ideal = with_a_small_battery(false).verdict;
    assert_eq!(ideal.result, FlightResult::Complete);
    assert!(ideal.reason.contains("; a real battery would have been empty "), "{}", ideal.reason);
}
