//! The reports of the navigator: remaining time, touchdown, hover throttle.

use betadeck_core::plan::WaypointType::{Flyover, Land};
use betadeck_core::telemetry::NavState;

use crate::autopilot::flight::{Flight, guide, waypoint};

#[test]
fn the_remaining_time_of_a_leg_is_the_time_that_it_takes() {
    let mut flight = Flight::new(guide(), &[waypoint(Flyover, 200.0, 0.0, 20.0, 5.0)], 20.0).launch();
    flight.run(0.02);
    assert_eq!(flight.nav.telemetry().eta_s, None, "a craft that does not move yet never arrives");
    assert!(flight.until(60.0, |f| f.plant.pos.x > 50.0));
    let (began, eta_s) = (flight.t(), flight.nav.telemetry().eta_s.unwrap());
    assert!(flight.until(120.0, |f| f.nav.state() == NavState::Complete));
    let took_s = flight.t() - began;
    assert!((eta_s - took_s).abs() < 4.0, "{eta_s} s, took {took_s} s");
}

#[test]
fn a_landing_reports_how_long_its_touchdown_has_held() {
    let mut flight = Flight::new(guide(), &[waypoint(Land, 0.0, 0.0, 8.0, 0.0)], 8.0).launch();
    let held_s = |flight: &Flight| flight.nav.telemetry().touchdown_held_s.unwrap_or_default();
    let mut longest_s = 0.0_f64;
    while !flight.disarmed {
        assert!(flight.t() < 120.0, "it does not land");
        flight.tick();
        let now_s = held_s(&flight);
        assert!(flight.plant.alt < 1.0 || now_s == 0.0, "{now_s} s at {} m", flight.plant.alt);
        longest_s = longest_s.max(now_s);
    }
    let needed_s = f64::from(flight.params.landing_detection_time) / 10.0;
    assert!((longest_s - needed_s).abs() < 0.05, "{longest_s} s of {needed_s} s");
}

#[test]
fn the_reported_hover_throttle_is_the_one_in_use() {
    for hover_us in [1400, 1600] {
        let mut params = guide();
        params.hover_throttle = hover_us;
        let mut flight = Flight::new(params, &[waypoint(Flyover, 100.0, 0.0, 20.0, 5.0)], 20.0);
        flight.engage();
        for _ in 0..500 {
            flight.tick();
            assert_eq!(flight.nav.telemetry().hover_us, flight.controllers.altitude.hover_us());
        }
    }
}
