//! The last metres of a landing.

use betadeck_core::plan::WaypointType::Land;
use betadeck_core::telemetry::NavState;

use crate::autopilot::flight::{Flight, guide, waypoint, worst};

/// Returns a landing in wind, half a metre above the landing altitude.
fn coming_down() -> Flight {
    let mut flight =
        Flight::new(guide(), &[waypoint(Land, 0.0, 0.0, 8.0, 0.0)], 8.0).wind(4.0, 0.0, 0.0).launch();
    assert!(flight.until(60.0, |f| f.nav.state() == NavState::Landing && f.plant.alt < 4.5));
    flight
}

#[test]
fn a_craft_at_rest_is_flown_level_with_its_throttle_off() {
    let mut flight = coming_down();
    assert!(flight.until(60.0, |f| f.plant.alt <= 0.0));
    let (contact, air) = (flight.t(), flight.log.last().unwrap().clone());
    assert!(air.demand_deg > 5.0 && !air.stands, "it leaned into the wind");
    assert!(flight.until(4.0, |f| f.disarmed), "not down after 4 s");
    assert!(flight.t() - contact >= 1.0);
    flight.log.pop();
    let mut stood = flight.since(contact + 2.0);
    assert!(stood.all(|s| s.demand_deg < 0.1 && s.stands));
    let last = flight.log.last().unwrap();
    assert!(last.out.throttle_us < air.throttle_us - 200.0, "{}", last.out.throttle_us);
}

#[test]
fn a_landing_that_was_pushed_below_its_path_goes_on_from_there() {
    let mut flight = coming_down();
    assert!(flight.until(60.0, |f| f.plant.alt < 3.5));
    flight.plant.alt = 1.8;
    let pushed = flight.t();
    assert!(flight.until(5.5, |f| f.plant.alt <= 0.0), "still {} m up", flight.plant.alt);
    let highest = worst(flight.since(pushed + 0.02).map(|s| s.alt));
    assert!(highest < 2.7, "it climbed back to {highest} m");
    assert!(flight.plant.climb > -0.8, "{}", flight.plant.climb);
}

#[test]
fn rising_air_does_not_pass_for_the_ground() {
    let mut flight = coming_down();
    assert!(flight.until(60.0, |f| f.plant.alt < 3.0));
    // An updraught that lifts the craft for two seconds, whatever its throttle.
    let start = flight.t();
    while flight.t() < start + 2.0 {
        flight.plant.climb = 0.2;
        flight.tick();
        assert!(!flight.disarmed);
    }
    assert!(flight.until(60.0, |f| f.disarmed));
    assert!(flight.plant.impact_mps.unwrap() < 1.2, "{:?}", flight.plant.impact_mps);
}
