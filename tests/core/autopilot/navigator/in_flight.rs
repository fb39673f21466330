//! Commands in flight: fly to a waypoint, hold here, resume, continue on a new plan.

use betadeck_core::plan::Seconds;
use betadeck_core::plan::WaypointType::{AltChange, Flyover, Hold};
use betadeck_core::telemetry::InFlightCommand::{GoTo, HoldHere, Resume};
use betadeck_core::telemetry::{
    InFlightCommand, InFlightRefusal, NavEvent, NavState, PlanSource, Refusal, TransitionReason,
};

use crate::autopilot::flight::{Flight, guide, inputs, plan, set, waypoint};
use crate::autopilot::navigator::three;

fn command(flight: &mut Flight, command: InFlightCommand) -> Result<(), InFlightRefusal> {
    flight.nav.command(command, &flight.inputs, &flight.params, &flight.plan)
}

fn on_the_way() -> Flight {
    let mut flight = Flight::new(guide(), &three().waypoints, 20.0).launch();
    flight.run(6.0);
    assert_eq!((flight.nav.state(), flight.nav.telemetry().wp), (NavState::Approaching, 0));
    flight
}

fn is_reached(flight: &mut Flight, wp: u8) -> bool {
    flight.until(120.0, |f| {
        f.events.iter().any(
            |(_, event)| matches!(event, NavEvent::State { to: NavState::Arrived, wp: at, .. } if *at == wp),
        )
    })
}

#[test]
fn the_craft_goes_straight_to_the_waypoint_it_is_sent_to() {
    let mut flight = on_the_way();
    command(&mut flight, GoTo(2)).unwrap();
    let telemetry = flight.nav.telemetry();
    assert_eq!((telemetry.wp, telemetry.reason), (2, Some(TransitionReason::SetCurrent)));
    assert!(is_reached(&mut flight, 2));
    let visited = flight
        .events
        .iter()
        .filter(|(_, event)| matches!(event, NavEvent::State { to: NavState::Arrived, wp: 0 | 1, .. }));
    assert_eq!(visited.count(), 0);
}

#[test]
fn a_waypoint_that_was_flown_and_a_parked_craft_can_be_gone_back_from() {
    let mut flight = on_the_way();
    assert!(flight.until(120.0, |f| f.nav.state() == NavState::Complete));
    command(&mut flight, GoTo(0)).unwrap();
    flight.run(1.0);
    assert_eq!((flight.nav.state(), flight.nav.telemetry().wp), (NavState::Approaching, 0));
    // The mission continues from there, even after the switch was cycled.
    flight.nav.disengage();
    flight.engage();
    assert_eq!(flight.nav.telemetry().reason, Some(TransitionReason::Resume));
    assert!(is_reached(&mut flight, 0));
}

#[test]
fn the_modifiers_before_the_waypoint_count() {
    let mut higher = waypoint(AltChange, 0.0, 0.0, 35.0, 0.0);
    higher.duration = Seconds::default();
    let waypoints =
        [waypoint(Flyover, 60.0, 0.0, 20.0, 5.0), higher, waypoint(Flyover, 120.0, 0.0, 20.0, 5.0)];
    let mut flight = Flight::new(guide(), &waypoints, 20.0).launch();
    flight.run(2.0);
    command(&mut flight, GoTo(2)).unwrap();
    flight.run(0.1);
    assert_eq!(flight.nav.telemetry().target_alt_m, Some(35.0));
}

#[test]
fn a_hold_by_command_lasts_until_the_next_one() {
    let mut flight = on_the_way();
    let here = flight.plant.pos;
    command(&mut flight, HoldHere).unwrap();
    assert_eq!(flight.nav.state(), NavState::Holding);
    flight.run(60.0);
    let telemetry = flight.nav.telemetry();
    assert_eq!((telemetry.state, telemetry.held_by_command), (NavState::Holding, true));
    assert_eq!((telemetry.hold_remaining_s, telemetry.cannot_hold), (Some(f64::INFINITY), None));
    assert!((flight.plant.pos - here).norm() < 2.0, "{} {here}", flight.plant.pos);
    command(&mut flight, Resume).unwrap();
    let telemetry = flight.nav.telemetry();
    assert_eq!((telemetry.state, telemetry.wp), (NavState::Approaching, 0));
    assert_eq!(telemetry.reason, Some(TransitionReason::Resume));
    assert!(is_reached(&mut flight, 2));
    assert!(!flight.nav.telemetry().held_by_command);
}

#[test]
fn a_planned_pattern_is_left_and_flown_again() {
    let mut orbit = waypoint(Hold, 30.0, 0.0, 20.0, 5.0);
    orbit.pattern = betadeck_core::plan::HoldPattern::Orbit;
    orbit.duration = Seconds::new(60.0);
    let mut flight = Flight::new(guide(), &[orbit, waypoint(Flyover, 90.0, 0.0, 20.0, 5.0)], 20.0).launch();
    assert!(flight.until(60.0, |f| f.nav.state() == NavState::Orbiting));
    command(&mut flight, HoldHere).unwrap();
    flight.run(5.0);
    assert_eq!(flight.nav.state(), NavState::Holding, "no pattern by command");
    command(&mut flight, Resume).unwrap();
    assert!(flight.until(60.0, |f| f.nav.state() == NavState::Orbiting));
}

#[test]
fn the_fence_stays_up_in_a_hold_by_command() {
    let mut params = guide();
    set(&mut params, "ap_max_distance_from_home", 200);
    let mut flight = Flight::new(params, &three().waypoints, 20.0).launch();
    flight.run(6.0);
    command(&mut flight, HoldHere).unwrap();
    flight.plant.pos.x = 250.0;
    flight.run(0.1);
    assert_eq!(flight.nav.telemetry().reason, Some(TransitionReason::Fence));
    assert!(!flight.nav.telemetry().held_by_command);
    let refused = command(&mut flight, Resume);
    assert_eq!(refused, Err(InFlightRefusal::Injected(PlanSource::Emergency)));
}

#[test]
fn a_new_plan_is_continued_from_the_chosen_waypoint_only() {
    let mut flight = on_the_way();
    let east = plan(&[40.0, 80.0].map(|east| waypoint(Flyover, 30.0, east, 25.0, 5.0)));
    flight.plan = east.clone();
    flight.run(2.0);
    assert_eq!(flight.nav.active_plan(), &three(), "not before the next engagement");
    command(&mut flight, GoTo(1)).unwrap();
    assert_eq!((flight.nav.active_plan(), flight.nav.telemetry().wp), (&east, 1));
    assert!(is_reached(&mut flight, 1));
    assert!((flight.plant.pos.y - 80.0).abs() < 6.0, "{}", flight.plant.pos);
}

#[test]
fn a_new_plan_beyond_the_fence_is_refused_and_the_old_one_flies_on() {
    let mut params = guide();
    set(&mut params, "ap_max_distance_from_home", 200);
    let mut flight = Flight::new(params, &three().waypoints, 20.0).launch();
    flight.run(6.0);
    flight.plan = plan(&[waypoint(Flyover, 500.0, 0.0, 20.0, 5.0)]);
    let refused = command(&mut flight, GoTo(0)).unwrap_err();
    assert!(matches!(refused, InFlightRefusal::Plan(Refusal::Geofence { wp: 0, .. })), "{refused:?}");
    assert!(refused.sentence().contains("500 m from home"), "{}", refused.sentence());
    assert_eq!((flight.nav.active_plan(), flight.nav.state()), (&three(), NavState::Approaching));
}

#[test]
fn what_cannot_be_done_is_refused_and_changes_nothing() {
    let mut flight = on_the_way();
    assert_eq!(command(&mut flight, Resume), Err(InFlightRefusal::NotHeld));
    assert_eq!(command(&mut flight, GoTo(3)), Err(InFlightRefusal::NoWaypoint { wp: 3, count: 3 }));
    let before = flight.events.len();
    flight.inputs.failsafe = true;
    assert_eq!(command(&mut flight, HoldHere), Err(InFlightRefusal::Failsafe));
    flight.inputs.failsafe = false;
    assert_eq!((flight.events.len(), flight.nav.state()), (before, NavState::Approaching));
    assert!(flight.until(120.0, |f| f.nav.state() == NavState::Complete));
    assert_eq!(command(&mut flight, HoldHere), Err(InFlightRefusal::Parked));
    flight.nav.return_to_home(&flight.inputs, &flight.params, None).unwrap();
    assert_eq!(command(&mut flight, GoTo(0)), Err(InFlightRefusal::Injected(PlanSource::Rth)));
    flight.nav.disengage();
    for refused in [GoTo(0), HoldHere, Resume] {
        assert_eq!(command(&mut flight, refused), Err(InFlightRefusal::NotFlying));
    }
    let mut nav = betadeck_core::autopilot::Navigator::new();
    let refused = nav.command(GoTo(0), &inputs(), &flight.params, &flight.plan);
    assert_eq!(refused, Err(InFlightRefusal::NotFlying));
}
