//! Legs: the climb before them, missed corners, modifiers, offset legs, and the heading along them.

use betadeck_core::autopilot::control::FlightControllers;
use betadeck_core::autopilot::io::NavInputs;
use betadeck_core::autopilot::params::YawMode;
use betadeck_core::autopilot::{Navigator, Params};
use betadeck_core::geo::{LatLon, distance_bearing, offset_to_latlon};
use betadeck_core::plan::WaypointType::{AltChange, Delay, Flyover, Hold, Takeoff, YawRate};
use betadeck_core::plan::{Seconds, Waypoint};
use betadeck_core::telemetry::{GuardName, L1Mode, NavEvent, NavState};
use nalgebra::Vector2;

use crate::autopilot::flight::{Flight, HOME, guide, inputs, plan, waypoint, worst};

#[test]
fn climbing_comes_before_the_first_leg() {
    let mut flight = Flight::new(guide(), &[waypoint(Flyover, 60.0, 0.0, 20.0, 5.0)], 2.0);
    flight.hover(5.0);
    flight.engage();
    flight.run(0.02);
    assert!(flight.nav.telemetry().climbing);
    assert_eq!(flight.nav.telemetry().guards[1].name, GuardName::Climb);
    assert!(flight.until(30.0, |f| !f.nav.telemetry().climbing));
    assert!(flight.plant.pos.norm() < 0.3 && flight.plant.alt >= 5.0, "it climbed on the spot");
    let events: Vec<_> = flight
        .events
        .iter()
        .filter_map(|(_, event)| if let NavEvent::Climbing(on) = event { Some(*on) } else { None })
        .collect();
    assert_eq!(events, [true, false]);
    assert!(flight.until(60.0, |f| f.nav.state() == NavState::Complete));
}

#[test]
fn a_low_waypoint_does_not_climb_again() {
    let waypoints = [waypoint(Flyover, 60.0, 0.0, 3.0, 5.0), waypoint(Hold, 90.0, 0.0, 3.0, 5.0)];
    let mut flight = Flight::new(guide(), &waypoints, 20.0).launch();
    flight.run(60.0);
    assert!(!flight.events.iter().any(|(_, event)| matches!(event, NavEvent::Climbing(_))));
    assert!((flight.plant.alt - 3.0).abs() < 0.5);
}

#[test]
fn takeoff_climbs_over_its_place() {
    let mut takeoff = waypoint(Takeoff, 900.0, 900.0, 15.0, 0.0);
    takeoff.duration = Seconds::new(2.0);
    let waypoints = [takeoff, waypoint(Hold, 30.0, 0.0, 15.0, 5.0)];
    let mut flight = Flight::new(guide(), &waypoints, 1.5);
    flight.hover(5.0);
    flight.engage();
    assert!(flight.until(40.0, |f| f.nav.telemetry().wp == 1));
    assert!(flight.plant.pos.norm() < 0.3 && (flight.plant.alt - 15.0).abs() < 2.0);
    let waited = flight.t() - flight.entered(NavState::Holding, 0).unwrap();
    assert!((waited - 2.0).abs() < 1e-9);
    assert!(flight.until(40.0, |f| f.nav.state() == NavState::Holding));
}

#[test]
fn a_takeoff_is_reached_at_its_altitude_only() {
    for (from_m, to_m) in [(1.5, 30.0), (30.0, 10.0)] {
        let waypoints = [waypoint(Takeoff, 0.0, 0.0, to_m, 0.0), waypoint(Hold, 30.0, 0.0, to_m, 5.0)];
        let mut flight = Flight::new(guide(), &waypoints, from_m).launch();
        assert!(flight.until(60.0, |f| f.nav.state() != NavState::Approaching));
        assert!((flight.plant.alt - to_m).abs() < 2.5, "{} m of {to_m} m", flight.plant.alt);
    }
}

#[test]
fn a_missed_flyover_is_come_back_to() {
    let params = Params { waypoint_arrival_radius: 100, ..guide() };
    let waypoints = [waypoint(Flyover, 60.0, 0.0, 20.0, 5.0), waypoint(Flyover, 60.0, 60.0, 20.0, 5.0)];
    let mut flight = Flight::new(params, &waypoints, 20.0).launch();
    flight.run(8.0);
    // The wind moves the craft 10 m sideways, so it crosses the waypoint's plane far from the waypoint.
    for _ in 0..1000 {
        if flight.plant.pos.x > 60.1 {
            break;
        }
        flight.plant.pos.y = 10.0;
        flight.tick();
    }
    assert_eq!((flight.nav.state(), flight.nav.telemetry().wp), (NavState::Approaching, 0));
    assert!(flight.until(40.0, |f| f.nav.telemetry().wp == 1));
    let at = flight.log.last().unwrap().pos;
    assert!((at - Vector2::new(60.0, 0.0)).norm() < 1.2, "{at}");
}

#[test]
fn modifiers_change_the_next_leg() {
    let mut slow = waypoint(Delay, 0.0, 0.0, 0.0, 0.0);
    slow.duration = Seconds::new(30.0);
    let mut cap = waypoint(YawRate, 0.0, 0.0, 0.0, 0.0);
    cap.yaw_rate_dps = 5;
    let waypoints = [
        waypoint(Flyover, 0.0, 40.0, 20.0, 5.0),
        waypoint(AltChange, 0.0, 0.0, 26.0, 0.0),
        slow,
        cap,
        waypoint(Hold, 60.0, 40.0, 20.0, 5.0),
    ];
    let mut flight = Flight::new(guide(), &waypoints, 20.0).launch();
    assert!(flight.until(60.0, |f| f.nav.telemetry().wp == 4));
    let began = flight.t();
    assert!(flight.until(60.0, |f| f.nav.state() == NavState::Holding));
    let took = flight.t() - began;
    assert!((26.0..=33.0).contains(&took), "{took}");
    assert!((flight.plant.alt - 26.0).abs() < 0.5);
    let yaw = worst(flight.since(began).map(|s| s.out.yaw_rate_rps.unwrap().abs().to_degrees()));
    assert!(yaw <= 5.0 + 1e-9, "{yaw}");
}

#[test]
fn an_offset_leg_is_cut_into_and_a_far_one_starts_again() {
    let mut flight = Flight::new(
        guide(),
        &[waypoint(Flyover, 10.0, 0.0, 20.0, 5.0), waypoint(Flyover, 210.0, 0.0, 20.0, 5.0)],
        20.0,
    )
    .launch();
    assert!(flight.until(60.0, |f| f.plant.pos.x > 70.0));
    flight.plant.pos.y = 20.0;
    let (from, x) = (flight.t(), flight.plant.pos.x);
    assert!(flight.until(60.0, |f| f.plant.pos.y.abs() < 2.0));
    assert!(flight.t() - from <= 14.0 && flight.plant.pos.x - x <= 60.0, "{} s", flight.t() - from);
    let began = flight.t();
    flight.run(10.0);
    assert!(-worst(flight.since(began).map(|s| -s.pos.y)) >= -2.0);
    flight.params.l1_max_cross_track_error = 1000;
    flight.plant.pos.y = 30.0;
    flight.run(0.05);
    let start = flight.nav.telemetry().leg_start.unwrap();
    assert!((distance_bearing(start, offset_to_latlon(HOME, flight.plant.pos)).0) < 1.0);
    assert_eq!(flight.nav.telemetry().l1_mode, Some(L1Mode::Track));
}

#[test]
fn yaw_follows_the_course_in_velocity_mode_and_the_point_in_bearing_mode() {
    for (mode, east) in [(YawMode::Velocity, 60.0), (YawMode::Bearing, 60.0)] {
        let params = Params { yaw_mode: mode, ..guide() };
        let mut flight = Flight::new(params, &[waypoint(Hold, 0.0, east, 20.0, 5.0)], 20.0).launch();
        assert!(flight.until(60.0, |f| f.plant.pos.y > 40.0));
        assert!((flight.plant.heading.to_degrees() - 90.0).abs() < 5.0, "{mode}: {}", flight.plant.heading);
    }
}

#[test]
fn legs_cross_the_antimeridian() {
    let origin = LatLon::new(100_000_000, 1_799_999_000);
    let record = |east: f64| Waypoint {
        position: offset_to_latlon(origin, Vector2::new(0.0, east)),
        ..waypoint(Flyover, 0.0, 0.0, 20.0, 5.0)
    };
    let stored = plan(&[record(50.0), record(100.0)]);
    assert!(stored.waypoints[0].position.lon_e7 < 0);
    let (mut nav, mut controllers) = (Navigator::new(), FlightControllers::default());
    let at = NavInputs { origin, home: Some(origin), ..inputs() };
    nav.engage(&at, &Params::default(), &stored).unwrap();
    nav.update(&at, &Params::default(), &stored, &mut controllers);
    let telemetry = nav.telemetry();
    assert!((telemetry.distance_m.unwrap() - 50.0).abs() < 0.05);
    assert!((telemetry.bearing_rad.unwrap().to_degrees() - 90.0).abs() < 0.1);
}

#[test]
fn a_delay_counts_the_height_of_its_leg() {
    let mut slow = waypoint(Delay, 0.0, 0.0, 0.0, 0.0);
    slow.duration = Seconds::new(50.0);
    // 60 m along the leg and 80 m up make a path of 100 m, flown in 50 s.
    let mut flight = Flight::new(guide(), &[slow, waypoint(Hold, 60.0, 0.0, 100.0, 5.0)], 20.0).launch();
    let mut fastest: f64 = 0.0;
    while flight.t() < 25.0 {
        flight.tick();
        fastest = fastest.max(flight.nav.telemetry().speed_setpoint_mps.unwrap_or(0.0));
    }
    assert!((fastest - 2.0).abs() < 0.1, "{fastest} m/s");
}

#[test]
fn a_resumed_mission_keeps_the_yaw_rate_cap_of_the_plan_before_it() {
    let mut cap = waypoint(YawRate, 0.0, 0.0, 0.0, 0.0);
    cap.yaw_rate_dps = 5;
    let waypoints = [cap, waypoint(Flyover, 0.0, 40.0, 20.0, 5.0), waypoint(Hold, 60.0, 40.0, 20.0, 5.0)];
    let mut flight = Flight::new(guide(), &waypoints, 20.0).launch();
    assert!(flight.until(60.0, |f| f.nav.telemetry().wp == 2));
    flight.nav.disengage();
    flight.engage();
    assert_eq!((flight.nav.state(), flight.nav.telemetry().wp), (NavState::Approaching, 2));
    let resumed = flight.t();
    flight.run(8.0);
    let rates = || flight.since(resumed).map(|s| s.out.yaw_rate_rps.unwrap().abs().to_degrees());
    assert!(worst(rates()) > 4.0, "it turns to the new leg");
    assert!(worst(rates()) <= 5.0 + 1e-9, "{}", worst(rates()));
}
