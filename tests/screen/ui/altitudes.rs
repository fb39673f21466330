//! Altitudes that are probably mistakes: the findings about them, and the questions of an upload in flight.

use std::sync::Arc;

use betadeck::plan::{Altitude, FlightPlan};
use betadeck::telemetry::NavState;
use betadeck::ui::{AppState, Effect, Msg, update};

use crate::ui::fixture;
use crate::ui::fixture::SimpleFlight;
use crate::ui::hands::{keys, screen, state_with_fix};

fn set_altitude(state: &mut AppState, wp: usize, alt_m: i32) {
    let mut plan = state.shared.plan().clone();
    plan.waypoints[wp].altitude = Altitude::above_home(alt_m.into());
    open(state, &plan);
}

/// Replaces the waypoints of the open plan with pasted ones.
fn open(state: &mut AppState, plan: &FlightPlan) {
    keys(state, "2 ctrl-a d");
    let lines: Vec<String> = betadeck::plan::plan_lines(plan).skip(1).collect();
    update(state, Msg::Paste(lines.join("\n")));
    assert_eq!(state.shared.plan(), plan);
    // The lines are selected, the last is under the cursor.
    keys(state, "esc");
}

/// Shows a craft on its way to WP1 of the stored square.
fn fly(state: &mut AppState) {
    let flight = SimpleFlight {
        time_s: 60.0,
        alt: 50.0,
        speed: 5.0,
        armed: true,
        fix: true,
        state: NavState::Approaching,
        wp: 1,
        ..SimpleFlight::default()
    };
    update(state, Msg::View(fixture::view(&flight)));
}

fn uploads(effects: &[Effect]) -> bool {
    effects.iter().any(|effect| matches!(effect, Effect::Upload { .. }))
}

#[test]
fn a_digit_too_many_is_reported_and_one_key_lowers_it() {
    let mut state = state_with_fix((120, 40));
    set_altitude(&mut state, 1, 500);
    keys(&mut state, "up up");
    let seen = screen(&state);
    assert!(seen.contains("waypoint 1 is 500 m above home, far above the others"), "{seen}");
    keys(&mut state, "f");
    assert_eq!(state.shared.plan().waypoints[1].altitude, Altitude::above_home(50.0));
    assert!(!screen(&state).contains("above home"), "{}", screen(&state));
}

#[test]
fn the_limit_of_the_user_counts() {
    let mut state = state_with_fix((120, 40));
    set_altitude(&mut state, 3, 125);
    let seen = screen(&state);
    assert!(seen.contains("waypoint 3 is 125 m above home, the limit") && seen.contains("lower"), "{seen}");
    state.shared.max_altitude_m = 150.0;
    assert!(!screen(&state).contains("above home"), "{}", screen(&state));
    state.shared.max_altitude_m = 120.0;
    keys(&mut state, "f");
    assert_eq!(state.shared.plan().waypoints[3].altitude, Altitude::above_home(120.0));
}

#[test]
fn an_upload_in_flight_that_moves_the_target_far_asks_first() {
    let mut state = state_with_fix((120, 40));
    fly(&mut state);
    set_altitude(&mut state, 1, 101);
    assert!(!uploads(&keys(&mut state, "U")));
    let seen = screen(&state);
    assert!(seen.contains("The craft flies to WP1") && seen.contains("51 m up, to"), "{seen}");
    assert!(!uploads(&keys(&mut state, "n")));
    assert!(!screen(&state).contains("flies to WP1"), "{}", screen(&state));
    keys(&mut state, "U");
    assert!(uploads(&keys(&mut state, "y")));
}

#[test]
fn a_small_change_or_one_of_another_leg_is_not_asked_about() {
    let mut state = state_with_fix((120, 40));
    fly(&mut state);
    set_altitude(&mut state, 1, 100);
    assert!(uploads(&keys(&mut state, "U")), "50 m");
    set_altitude(&mut state, 2, 200);
    assert!(uploads(&keys(&mut state, "U")), "the leg after it");
}

#[test]
fn a_place_far_away_or_no_place_is_asked_about_in_flight_only() {
    let mut state = state_with_fix((120, 40));
    let mut plan = state.shared.plan().clone();
    plan.waypoints[1].position.lat_e7 += 10_000;
    open(&mut state, &plan);
    assert!(uploads(&keys(&mut state, "U")), "on the ground");
    fly(&mut state);
    assert!(!uploads(&keys(&mut state, "U")));
    assert!(screen(&state).contains("111 m to the"), "{}", screen(&state));
    keys(&mut state, "n");
    plan.waypoints.truncate(1);
    open(&mut state, &plan);
    assert!(!uploads(&keys(&mut state, "U")));
    assert!(screen(&state).contains("WP1, which this plan does not have"), "{}", screen(&state));
    // While the craft is armed on the ground, before an engagement, there is no leg yet.
    let mut view = state.shared.view.clone();
    let vehicle = Arc::make_mut(&mut view.vehicle);
    vehicle.active_plan = None;
    vehicle.nav.as_mut().expect("an autopilot").engaged = false;
    keys(&mut state, "n");
    update(&mut state, Msg::View(view));
    assert!(uploads(&keys(&mut state, "U")));
}
