//! The states: the events they send, their duration, and the values that survive them.

use betadeck_core::autopilot::io::NavInputs;
use betadeck_core::autopilot::{Navigator, Params};
use betadeck_core::plan::WaypointType::{AltChange, Flyby, Flyover, Hold, Land};
use betadeck_core::plan::{FlightPlan, HoldPattern, Seconds};
use betadeck_core::telemetry::{AbortReason, NavEvent, NavState, TransitionReason};
use nalgebra::Vector2;

use crate::autopilot::flight::{Flight, guide, inputs, plan, waypoint, worst};
use crate::autopilot::navigator::{flying, three};

#[test]
fn arrived_and_holding_before_a_pattern_last_one_update() {
    let mut hold = waypoint(Hold, 20.0, 0.0, 20.0, 5.0);
    hold.pattern = HoldPattern::Orbit;
    hold.duration = Seconds::new(5.0);
    let mut flight = Flight::new(guide(), &[hold, waypoint(Flyover, 60.0, 0.0, 20.0, 5.0)], 20.0).launch();
    flight.run(40.0);
    let at = |state, wp| flight.entered(state, wp).unwrap();
    let arrived = at(NavState::Arrived, 0);
    assert!((at(NavState::Holding, 0) - arrived - 0.01).abs() < 1e-9);
    assert!((at(NavState::Orbiting, 0) - arrived - 0.02).abs() < 1e-9);
    assert!((at(NavState::Approaching, 1) - at(NavState::Holding, 0) - 5.0).abs() < 1e-9);
}

#[test]
fn every_state_event_carries_the_guard_that_fired() {
    let mut hold = waypoint(Hold, 20.0, 0.0, 20.0, 5.0);
    hold.duration = Seconds::new(1.0);
    let waypoints = [waypoint(Flyby, 10.0, 0.0, 20.0, 5.0), hold, waypoint(Land, 30.0, 0.0, 20.0, 5.0)];
    let mut flight = Flight::new(guide(), &waypoints, 20.0).launch();
    assert!(flight.until(120.0, |f| f.disarmed));
    let fired: Vec<(&str, NavState)> = flight
        .events
        .iter()
        .filter_map(|(_, event)| match event {
            NavEvent::State { guard: Some(guard), to, .. } => {
                assert!(guard.holds() && guard.margin() >= 0.0, "{guard:?}");
                Some((guard.name.into(), *to))
            }
            _ => None,
        })
        .collect();
    assert_eq!(
        fired,
        [
            ("turn radius", NavState::Arrived),
            ("arrival", NavState::Arrived),
            ("hold time", NavState::Approaching),
            ("arrival", NavState::Arrived),
            ("touchdown time", NavState::Complete),
        ]
    );
}

#[test]
fn a_plan_of_modifiers_completes_at_once() {
    let stored = plan(&[waypoint(AltChange, 0.0, 0.0, 30.0, 0.0)]);
    let mut nav = Navigator::new();
    nav.engage(&inputs(), &Params::default(), &stored).unwrap();
    assert_eq!(nav.state(), NavState::Complete);
}

#[test]
fn disarming_forgets_the_index_and_a_touchdown_shows_until_the_next_arming() {
    let stored = three();
    let params = Params::default();
    let (mut nav, mut at, mut controllers) = flying(2, &stored, &params);
    at.armed = false;
    nav.update(&at, &params, &stored, &mut controllers);
    assert_eq!(nav.state(), NavState::Idle);
    at.armed = true;
    nav.engage(&at, &params, &stored).unwrap();
    assert_eq!(nav.telemetry().wp, 0);

    let mut flight = Flight::new(guide(), &[waypoint(Land, 0.0, 0.0, 6.0, 0.0)], 6.0).launch();
    assert!(flight.until(60.0, |f| f.disarmed));
    flight.nav.on_disarm();
    flight.inputs.armed = false;
    flight.run(1.0);
    assert_eq!(flight.nav.state(), NavState::Complete);
    assert!(!flight.nav.is_flying() && !flight.nav.telemetry().engaged);
    flight.inputs.armed = true;
    flight.tick();
    assert_eq!(flight.nav.state(), NavState::Idle);
}

#[test]
fn complete_in_the_air_stays_parked() {
    let mut flight = Flight::new(guide(), &[waypoint(Flyover, 40.0, 0.0, 20.0, 5.0)], 20.0).launch();
    assert!(flight.until(60.0, |f| f.nav.state() == NavState::Complete));
    let at = flight.t();
    flight.run(45.0);
    assert!(flight.nav.is_flying());
    let off = worst(flight.since(at + 12.0).map(|s| (s.pos - Vector2::new(40.0, 0.0)).norm()));
    assert!(off <= 1.0, "{off}");
}

#[test]
fn clearing_the_stored_plan_in_flight_ends_the_mission_and_editing_does_not() {
    let stored = three();
    let params = Params::default();
    let (mut nav, at, mut controllers) = flying(0, &stored, &params);
    let edited = plan(&[waypoint(Hold, 1.0, 1.0, 1.0, 1.0)]);
    nav.update(&at, &params, &edited, &mut controllers);
    assert_eq!(nav.active_plan(), &stored);
    nav.update(&at, &params, &FlightPlan::default(), &mut controllers);
    assert_eq!(
        (nav.state(), nav.telemetry().reason),
        (NavState::Idle, Some(TransitionReason::GivenUp(AbortReason::NoPlan)))
    );
    let away = NavInputs { pos_ne: Vector2::new(50.0, 0.0), ..at };
    nav.return_to_home(&away, &params, None).unwrap();
    nav.update(&away, &params, &FlightPlan::default(), &mut controllers);
    assert_eq!(nav.state(), NavState::Approaching, "an injected plan does not depend on the stored one");
}
