//! The complete navigator, on a point mass.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may stop at a surprise and say what it measured"
)]

mod fence;
mod in_flight;
mod landing;
mod legs;
mod losses;
mod monitors;
mod orders;
mod pilot;
mod reports;
mod states;
mod vectors;
mod windup;

use crate::autopilot::flight::{inputs, plan, waypoint};
use betadeck_core::autopilot::control::FlightControllers;
use betadeck_core::autopilot::io::NavInputs;
use betadeck_core::autopilot::{Navigator, Params};
use betadeck_core::plan::FlightPlan;
use betadeck_core::plan::WaypointType::Flyover;
use betadeck_core::signals::SimTime;

/// Returns a plan of three FLYOVERs on a line north.
fn three() -> FlightPlan {
    plan(&[60.0, 120.0, 180.0].map(|north| waypoint(Flyover, north, 0.0, 20.0, 5.0)))
}

/// Returns a navigator that flies `stored` and approaches waypoint `index`, with its inputs and controllers.
fn flying(index: u8, stored: &FlightPlan, params: &Params) -> (Navigator, NavInputs, FlightControllers) {
    let (mut nav, mut controllers) = (Navigator::new(), FlightControllers::default());
    let mut at = inputs();
    nav.engage(&at, params, stored).unwrap();
    assert!(index == 0 || nav.set_current(index, &at, params, stored));
    at.time = SimTime(at.time.0 + 10_000);
    nav.update(&at, params, stored, &mut controllers);
    (nav, at, controllers)
}
