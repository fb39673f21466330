//! The commands to return home and to land in an emergency.

use betadeck_core::autopilot::io::NavInputs;
use betadeck_core::autopilot::{Navigator, Params, Rescue};
use betadeck_core::plan::WaypointType::{Flyover, Hold};
use betadeck_core::telemetry::{AbortReason, NavEvent, NavState, PlanSource, Refusal, TransitionReason};
use nalgebra::Vector2;

use crate::autopilot::flight::{Flight, guide, inputs, plan, waypoint, worst};

#[test]
fn return_home_flies_straight_and_lands() {
    for (north, east) in [(0.0, 0.0), (-3.5, -3.5)] {
        let hold = [waypoint(Hold, 100.0, 50.0, 20.0, 5.0)];
        let mut flight = Flight::new(guide(), &hold, 20.0).wind(north, east, 0.0).launch();
        assert!(flight.until(60.0, |f| f.nav.state() == NavState::Holding));
        flight.run(5.0);
        let began = flight.t();
        flight.nav.return_to_home(&flight.inputs, &flight.params, None).unwrap();
        assert!(flight.until(60.0, |f| f.nav.telemetry().wp == 1));
        assert!((12.0..=26.0).contains(&(flight.t() - began)));
        let along = Vector2::new(100.0, 50.0).normalize();
        let beside = worst(flight.since(began + 5.0).map(|s| (s.pos - along * s.pos.dot(&along)).norm()));
        assert!(beside <= 5.0, "{beside}");
        assert!(flight.until(120.0, |f| f.disarmed));
        assert!(flight.plant.pos.norm() <= 1.5);
    }
}

#[test]
fn a_rescue_climbs_first() {
    let hold = [waypoint(Hold, 60.0, 0.0, 20.0, 5.0)];
    let mut flight = Flight::new(guide(), &hold, 20.0).launch();
    assert!(flight.until(60.0, |f| f.nav.state() == NavState::Holding));
    let rescue = Rescue {
        altitude_m: 45.0,
        near_climb_m: None,
        climb_mps: 3.0,
        speed_mps: 7.5,
        descend_mps: 1.5,
        is_watched: true,
    };
    flight.nav.return_to_home(&flight.inputs, &flight.params, Some(rescue)).unwrap();
    let began = flight.t();
    flight.run(1.0);
    assert!(flight.nav.telemetry().climbing && flight.nav.active_plan().waypoints.len() == 2);
    assert!(flight.until(40.0, |f| !f.nav.telemetry().climbing));
    assert!((flight.plant.pos.x - 60.0).abs() < 2.5 && flight.plant.alt >= 44.0);
    assert!(flight.t() - began > 24.0 / 3.0);
    assert!(flight.until(60.0, |f| f.nav.state() == NavState::Landing));
    let landing = flight.t();
    assert!(flight.until(60.0, |f| f.plant.alt < 4.0));
    let rate = 41.0 / (flight.t() - landing);
    assert!((1.3..=1.6).contains(&rate), "{rate}");
    assert!(flight.until(60.0, |f| f.disarmed));
    assert!(flight.plant.impact_mps.unwrap() <= 0.8);
}

#[test]
fn return_home_without_a_home_lands_here() {
    let mut nav = Navigator::new();
    let at = NavInputs { home: None, ..inputs() };
    nav.return_to_home(&at, &Params::default(), None).unwrap();
    assert_eq!((nav.state(), nav.telemetry().source), (NavState::Landing, PlanSource::Emergency));
}

#[test]
fn commands_need_an_armed_craft_with_a_fix() {
    let mut nav = Navigator::new();
    let params = Params::default();
    let no_fix = NavInputs { fix: false, ..inputs() };
    assert_eq!(nav.emergency_land(&no_fix), Err(Refusal::NoFix));
    let disarmed = NavInputs { armed: false, ..inputs() };
    assert_eq!(nav.return_to_home(&disarmed, &params, None), Err(Refusal::NotArmed));
    assert_eq!(nav.state(), NavState::Idle);
}

#[test]
fn a_return_home_that_makes_no_progress_lands_where_it_is() {
    let hold = [waypoint(Hold, 100.0, 50.0, 20.0, 5.0)];
    let mut flight = Flight::new(guide(), &hold, 20.0).launch();
    assert!(flight.until(60.0, |f| f.nav.state() == NavState::Holding));
    flight.nav.return_to_home(&flight.inputs, &flight.params, None).unwrap();
    let (began, held) = (flight.t(), flight.plant.pos);
    while flight.nav.state() == NavState::Approaching {
        flight.tick();
        flight.plant.pos = held;
        assert!(flight.t() - began < 31.0);
    }
    assert!((flight.t() - began - 30.0).abs() < 0.1, "{}", flight.t() - began);
    assert_eq!(
        (flight.nav.state(), flight.nav.telemetry().source),
        (NavState::Landing, PlanSource::Emergency)
    );
    assert_eq!(flight.nav.telemetry().reason, Some(TransitionReason::GivenUp(AbortReason::Stalled)));
    assert!(flight.until(120.0, |f| f.disarmed));
    assert!((flight.plant.pos - held).norm() < 2.0, "{}", flight.plant.pos);
}

#[test]
fn an_order_during_the_climb_ends_the_climb() {
    let mut flight = Flight::new(guide(), &[waypoint(Flyover, 60.0, 0.0, 20.0, 5.0)], 2.0);
    flight.hover(5.0);
    flight.engage();
    flight.run(0.1);
    assert!(flight.nav.telemetry().climbing);
    flight.nav.emergency_land(&flight.inputs).unwrap();
    flight.run(0.1);
    let climbs = flight.events.iter().filter_map(|(_, event)| match event {
        NavEvent::Climbing(on) => Some(*on),
        _ => None,
    });
    assert_eq!(climbs.collect::<Vec<_>>(), [true, false]);
    assert!(!flight.nav.telemetry().climbing);
}

#[test]
fn a_mission_that_is_reset_without_a_fix_does_not_start() {
    let stored = plan(&[waypoint(Flyover, 100.0, 0.0, 20.0, 5.0)]);
    let mut nav = Navigator::new();
    let lost = NavInputs { fix: false, ..inputs() };
    assert_eq!(nav.reset(&lost, &Params::default(), &stored), Err(Refusal::NoFix));
    assert_eq!(nav.state(), NavState::Idle);
    assert_eq!(nav.reset(&inputs(), &Params::default(), &stored), Ok(()));
    assert_ne!(nav.state(), NavState::Idle);
}
