//! The fence, before and during the flight.

use betadeck_core::autopilot::control::FlightControllers;
use betadeck_core::autopilot::fence::pre_flight;
use betadeck_core::autopilot::io::NavInputs;
use betadeck_core::autopilot::machine::{Facts, transition};
use betadeck_core::autopilot::{Navigator, Params};
use betadeck_core::plan::WaypointType::{Flyover, Hold};
use betadeck_core::telemetry::{
    AbortReason, FenceAction, GuardName, NavEvent, NavState, PlanSource, Refusal, TransitionReason,
};

use crate::autopilot::flight::{Flight, guide, inputs, plan, waypoint, worst};

fn fence_flight(action: FenceAction) -> Flight {
    let params = Params { max_distance_from_home: 100, geofence_action: action, ..guide() };
    let mut flight = Flight::new(params, &[waypoint(Hold, 80.0, 0.0, 30.0, 5.0)], 30.0).launch();
    assert!(flight.until(40.0, |f| f.nav.state() == NavState::Holding));
    flight.run(5.0);
    flight.inputs.stick_pitch = 500.0;
    assert!(flight.until(40.0, |f| f.nav.telemetry().source != PlanSource::Stored));
    flight.inputs.stick_pitch = 0.0;
    flight
}

#[test]
fn leaving_the_fence_lands() {
    let mut flight = fence_flight(FenceAction::Land);
    let before = flight.plan.clone();
    let trigger = flight.log[flight.log.len() - 1].pos;
    assert!((100.0..100.2).contains(&trigger.x), "{trigger}");
    assert_eq!(flight.nav.state(), NavState::Landing);
    assert!(flight.until(120.0, |f| f.disarmed));
    assert!((flight.plant.pos - trigger).norm() <= 2.0);
    assert!(worst(flight.log.iter().map(|s| s.pos.norm())) <= 120.0);
    assert_eq!(flight.plan, before);
    let fences = flight.events.iter().filter(|(_, event)| matches!(event, NavEvent::Geofence { .. })).count();
    assert_eq!(fences, 1);
}

#[test]
fn leaving_the_fence_returns_home() {
    let mut flight = fence_flight(FenceAction::Rth);
    let began = flight.t();
    assert_eq!((flight.nav.state(), flight.nav.telemetry().wp), (NavState::Approaching, 0));
    let altitudes: Vec<_> =
        flight.nav.active_plan().waypoints.iter().map(|wp| wp.altitude.above_home_m()).collect();
    assert!(altitudes.iter().all(|alt| (alt - 30.0).abs() <= 0.5), "{altitudes:?}");
    assert!(flight.until(60.0, |f| f.nav.state() == NavState::Arrived));
    assert!((20.0..=28.0).contains(&(flight.t() - began)), "{}", flight.t() - began);
    assert!(flight.until(120.0, |f| f.disarmed));
    assert!(flight.plant.pos.norm() <= 1.0);
}

#[test]
fn a_plan_outside_the_fence_is_refused_once_with_its_distance() {
    let params = Params { max_distance_from_home: 100, ..guide() };
    let stored = plan(&[waypoint(Flyover, 150.0, 0.0, 20.0, 5.0)]);
    let (mut nav, mut controllers) = (Navigator::new(), FlightControllers::default());
    for _ in 0..10 {
        nav.update(&inputs(), &params, &stored, &mut controllers);
        let refusal = nav.engage(&inputs(), &params, &stored).unwrap_err();
        assert!(matches!(refusal, Refusal::Geofence { wp: 0, distance_cm: 14_990..=15_010, limit_m: 100 }));
    }
    assert_eq!(nav.state(), NavState::Idle);
    assert_eq!(std::iter::from_fn(|| nav.take_event()).count(), 1);
    nav.update(&inputs(), &params, &stored, &mut controllers);
    assert!(nav.telemetry().refusal.is_some());
}

#[test]
fn exactly_on_the_fence_is_inside() {
    for (waypoint_m, allowed) in [(100.0, true), (100.01, false)] {
        let verdict = pre_flight(100, true, [(Flyover, waypoint_m)]);
        assert_eq!(verdict.is_ok(), allowed, "a waypoint at {waypoint_m} m");
    }
    for (distance_m, inside) in [(100.0, true), (100.01, false)] {
        let mut facts = Facts::default();
        facts.approach.distance_m = 50.0;
        facts.fence.limit_m = Some(100.0);
        facts.fence.distance_m = Some(distance_m);
        let decision = transition(NavState::Approaching, &facts);
        assert_eq!(decision.is_none(), inside, "the craft at {distance_m} m: {decision:?}");
    }
}

/// Returns a flight whose mission was given up because the craft was carried away, almost to a fence at 100 m.
fn given_up(params: Params) -> Flight {
    let mut flight = Flight::new(params, &[waypoint(Hold, 60.0, 0.0, 30.0, 5.0)], 30.0).launch();
    flight.run(1.0);
    flight.plant.pos.x = -25.0;
    flight.run(0.1);
    assert_eq!(
        (flight.nav.state(), flight.nav.telemetry().reason),
        (NavState::Idle, Some(TransitionReason::GivenUp(AbortReason::Flyaway)))
    );
    flight.plant.pos.x = -99.0;
    flight.run(0.1);
    assert_eq!(flight.nav.state(), NavState::Idle);
    flight
}

/// Returns a flight whose mission was given up and whose craft is then beyond the fence.
fn carried_away(params: Params) -> Flight {
    let mut flight = given_up(params);
    flight.plant.pos.x = -101.0;
    flight.tick();
    flight
}

#[test]
fn the_fence_stays_up_after_a_mission_was_given_up() {
    let fenced = Params { max_distance_from_home: 100, ..guide() };
    let mut flight = carried_away(fenced);
    assert_eq!(
        (flight.nav.state(), flight.nav.telemetry().source),
        (NavState::Landing, PlanSource::Emergency)
    );
    let guard = flight.events.iter().rev().find_map(|(_, event)| match event {
        NavEvent::State { guard, .. } => *guard,
        _ => None,
    });
    assert!(guard.is_some_and(|guard| guard.name == GuardName::Fence && guard.holds()), "{guard:?}");
    let out = flight.log.last().unwrap().out;
    assert!(out.throttle_us >= 1100.0, "it is flown at once: {out:?}");
    assert!(flight.until(120.0, |f| f.disarmed));
    let home = carried_away(Params { geofence_action: FenceAction::Rth, ..fenced });
    assert_eq!((home.nav.state(), home.nav.telemetry().source), (NavState::Approaching, PlanSource::Rth));
    let free = carried_away(Params { max_distance_from_home: 0, ..fenced });
    assert_eq!(free.nav.state(), NavState::Idle);
}

#[test]
fn the_fence_of_a_given_up_mission_leaves_a_craft_alone_that_it_could_not_lead() {
    let fenced = Params { max_distance_from_home: 100, ..guide() };
    let breaks: [fn(&mut NavInputs); 4] = [
        |inputs| inputs.armed = false,
        |inputs| inputs.fix = false,
        |inputs| inputs.altitude_valid = false,
        |inputs| inputs.failsafe = true,
    ];
    for break_it in breaks {
        let mut flight = given_up(fenced);
        break_it(&mut flight.inputs);
        flight.plant.pos.x = -101.0;
        flight.tick();
        assert_eq!(flight.nav.state(), NavState::Idle, "{:?}", flight.inputs);
    }
}
