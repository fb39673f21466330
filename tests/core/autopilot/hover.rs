//! Flights with a hover throttle that is wrong by up to 250 µs. The craft keeps its altitude, and no
//! touchdown is declared in the air.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may stop at a surprise and say what it measured"
)]

use crate::autopilot::flight::{Flight, guide, waypoint, worst};
use betadeck_core::autopilot::Params;
use betadeck_core::autopilot::control::FlightControllers;
use betadeck_core::plan::WaypointType::{Hold, Land};
use betadeck_core::telemetry::NavState;

/// The state of the craft at the moment the autopilot takes over.
#[derive(Debug, Clone, Copy)]
enum Before {
    /// Held still for some seconds.
    Steady,
    /// Held still, but the autopilot's controllers start without a history of it.
    Unseen,
    /// Climbing at 2 m/s.
    Climbing,
    /// Sinking at 2 m/s.
    Sinking,
    /// Climbing hard, throttle high.
    Punching,
}

fn engage(flight: &mut Flight, before: Before) {
    flight.hover(5.0);
    match before {
        Before::Steady => {}
        Before::Unseen => flight.controllers = FlightControllers::default(),
        Before::Climbing => flight.plant.climb = 2.0,
        Before::Sinking => flight.plant.climb = -2.0,
        Before::Punching => {
            flight.plant.thrust = 2.0;
            flight.plant.climb = 3.0;
            flight.inputs.throttle_us = flight.plant.hover_us + 300.0;
        }
    }
    flight.engage();
}

const ALL: [Before; 5] =
    [Before::Steady, Before::Unseen, Before::Climbing, Before::Sinking, Before::Punching];

fn wrong_hovers() -> impl Iterator<Item = (&'static str, Params, f64, u16)> {
    let tunes = [("default", Params::default()), ("guide", guide())];
    tunes.into_iter().flat_map(|(name, params)| {
        [
            (1500.0, 1250),
            (1500.0, 1275),
            (1500.0, 1500),
            (1500.0, 1700),
            (1450.0, 1700),
            (1250.0, 1500),
            (1600.0, 1350),
            // A configured 0 captures the hover throttle when the autopilot engages.
            (1500.0, 0),
        ]
        .into_iter()
        .map(move |(hover, configured)| (name, params, hover, configured))
    })
}

#[test]
fn altitude_within_a_metre_after_15_s() {
    for (name, params, hover, configured) in wrong_hovers() {
        for before in ALL {
            let params = Params { hover_throttle: configured, ..params };
            let mut flight = Flight::new(params, &[waypoint(Hold, 0.0, 0.0, 30.0, 0.0)], 30.0);
            flight.plant.hover_us = hover;
            engage(&mut flight, before);
            flight.run(30.0);
            let dip = worst(flight.log.iter().map(|s| (s.alt - 30.0).abs()));
            let late = worst(flight.since(15.0).map(|s| (s.alt - 30.0).abs()));
            println!("{name} {configured} on {hover} {before:?}: ±{dip:.2}, after 15 s ±{late:.2}");
            assert!(late < 1.0, "{name} {configured} on {hover} {before:?}: {late}");
        }
    }
}

#[test]
fn no_touchdown_in_the_air() {
    for (name, params, hover, configured) in wrong_hovers() {
        for before in ALL {
            for height in [2.5, 12.0] {
                let params = Params { hover_throttle: configured, landing_detection_time: 5, ..params };
                let mut flight = Flight::new(params, &[waypoint(Land, 0.0, 0.0, height, 0.0)], height);
                flight.plant.hover_us = hover;
                engage(&mut flight, before);
                flight.until(120.0, |f| f.disarmed);
                let contact = flight.log.iter().find(|s| s.alt <= 0.0).map(|s| s.t);
                assert!(
                    contact.is_some_and(|contact| contact < flight.t()),
                    "{name} {configured} on {hover} {before:?} from {height} m: disarmed in the air"
                );
                assert!(flight.disarmed, "{name} {configured} on {hover} {before:?}: never disarmed");
                assert_eq!(flight.nav.state(), NavState::Complete);
            }
        }
    }
}
