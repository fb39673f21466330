//! The pilot's sticks.

use betadeck_core::plan::WaypointType::{Flyover, Hold};

use crate::autopilot::flight::{Flight, guide, waypoint};

#[test]
fn sticks_override_and_release_returns_to_the_line() {
    let waypoints = [waypoint(Flyover, 10.0, 0.0, 20.0, 5.0), waypoint(Flyover, 200.0, 0.0, 20.0, 5.0)];
    let mut flight = Flight::new(guide(), &waypoints, 20.0).launch();
    assert!(flight.until(30.0, |f| f.plant.pos.x > 60.0));
    flight.inputs.stick_roll = 500.0;
    flight.run(2.0);
    assert!(flight.nav.telemetry().stick_override);
    assert!((flight.log.last().unwrap().out.roll_rad.to_degrees() - 25.0).abs() < 0.1);
    assert!((flight.plant.alt - 20.0).abs() < 1.6, "the altitude is still the autopilot's");
    flight.inputs.stick_roll = 0.0;
    let moved = flight.plant.pos.y;
    assert!(moved > 2.0);
    assert!(flight.until(40.0, |f| f.plant.pos.x > 180.0));
    assert!(flight.plant.pos.y.abs() < 1.0, "{}", flight.plant.pos.y);
    assert_eq!(flight.nav.telemetry().wp, 1);
}

#[test]
fn the_throttle_stick_is_no_input_and_the_yaw_stick_takes_only_yaw() {
    let mut flight = Flight::new(guide(), &[waypoint(Hold, 0.0, 0.0, 20.0, 0.0)], 20.0).launch();
    flight.inputs.stick_yaw = 200.0;
    flight.run(1.0);
    let telemetry = flight.nav.telemetry();
    assert!(telemetry.yaw_override && !telemetry.stick_override);
    assert_eq!(flight.log.last().unwrap().out.yaw_rate_rps, None);
}
