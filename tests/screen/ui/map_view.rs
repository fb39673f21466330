//! The window of the map: course up, waypoint by waypoint, the craft in view, and the tracks of earlier flights.

use std::time::Duration;

use betadeck::events::{Event, SessionEvent};
use betadeck::signals::SimTime;
use betadeck::telemetry::{EventKind, FirmwareEvent};
use betadeck::ui::{AppState, MapMode, Msg, update};
use crossterm::event::MouseEventKind;

use crate::ui::fixture::{self, SimpleFlight};
use crate::ui::hands::{journal_lines, keys, mouse, screen, state_with_fix};

fn approaching(size: (u16, u16)) -> AppState {
    let mut state = fixture::state(size, fixture::colour());
    fixture::approach(&mut state);
    state
}

fn fly_to(state: &mut AppState, time_s: f64, (n, e): (f64, f64)) {
    let mut view = fixture::view(&SimpleFlight { time_s, fix: true, ..SimpleFlight::default() });
    let vehicle = std::sync::Arc::make_mut(&mut view.vehicle);
    let truth = vehicle.truth.as_mut().expect("a simulated craft");
    (truth.n, truth.e) = (n, e);
    update(state, Msg::View(view));
}

fn arm(state: &mut AppState, time_s: f64) {
    let kind = SessionEvent::Vehicle(EventKind::Firmware(FirmwareEvent::Armed));
    update(state, Msg::Event(Event { time: SimTime::from_secs_f64(time_s), kind }));
}

#[test]
fn the_course_of_the_craft_is_up_on_request_and_north_while_one_edits() {
    let mut state = approaching((120, 40));
    keys(&mut state, "1 z");
    let north_up = screen(&state);
    assert!(north_up.contains("N ↑"), "{north_up}");
    keys(&mut state, "c");
    let course_up = screen(&state);
    assert!(course_up.contains("N ↓"), "the craft flies south\n{course_up}");
    let row_of =
        |seen: &str, mark: &str| seen.lines().position(|line| line.contains(mark)).expect("on the map");
    assert!(row_of(&north_up, "◆0") < row_of(&north_up, "◇1"), "{north_up}");
    assert!(row_of(&course_up, "◇1") < row_of(&course_up, "◆0"), "{course_up}");
    insta::assert_snapshot!("course_up_120x40", course_up);
    keys(&mut state, "p");
    assert!(screen(&state).contains("N ↑"), "the map does not turn under the cursor");
    keys(&mut state, "esc c");
    assert!(screen(&state).contains("N ↑"));
}

#[test]
fn the_cursor_goes_from_waypoint_to_waypoint() {
    let mut state = state_with_fix((120, 40));
    keys(&mut state, "1 p n");
    assert_eq!(state.shared.editor.row(), 0);
    keys(&mut state, "n n");
    assert_eq!(state.shared.editor.row(), 2);
    let seen = screen(&state);
    assert!(seen.contains("0.0 m 000° from WP2") || seen.contains("┼2 HOLD"), "{seen}");
    keys(&mut state, "n n");
    assert_eq!(state.shared.editor.row(), 0, "after the last comes the first");
    keys(&mut state, "N");
    assert_eq!(state.shared.editor.row(), 3);
    // The waypoint that is picked there is moved.
    keys(&mut state, "enter up up");
    assert_eq!(journal_lines(&keys(&mut state, "enter")), 1);
    // Without a cursor the map itself goes there.
    keys(&mut state, "esc 0 n");
    assert!(matches!(state.shared.map.mode, MapMode::Free { .. }));
}

#[test]
fn a_double_click_adds_a_waypoint_and_two_slow_clicks_do_not() {
    let mut state = state_with_fix((120, 40));
    let before = state.shared.plan().waypoints.len();
    let cell = (20, 12);
    let click = |state: &mut AppState, at_ms: u64| {
        update(state, Msg::Clock(Duration::from_millis(at_ms)));
        let mut effects = mouse(state, MouseEventKind::Down, cell);
        effects.extend(mouse(state, MouseEventKind::Up, cell));
        journal_lines(&effects)
    };
    assert_eq!(click(&mut state, 1000), 0);
    assert_eq!(click(&mut state, 1900), 0, "too late for a double click");
    assert_eq!(click(&mut state, 2100), 1);
    assert_eq!(state.shared.plan().waypoints.len(), before + 1);
    assert_eq!(click(&mut state, 2200), 0, "a third click adds nothing");
}

/// Returns `true` if an arrow with a distance leads to the craft.
fn is_off_screen(state: &AppState) -> bool {
    let seen = screen(state);
    seen.match_indices("craft ")
        .any(|(at, word)| seen[at + word.len()..].starts_with(|c: char| c.is_ascii_digit()))
}

#[test]
fn after_zooming_in_the_craft_stays_in_view() {
    let mut state = state_with_fix((80, 24));
    keys(&mut state, "1 z + + +");
    assert!(screen(&state).contains("keeps the craft in view"), "{}", screen(&state));
    for (time_s, n, e) in [(9.0, 200.0, 0.0), (12.0, 200.0, 300.0), (15.0, -40.0, 310.0)] {
        fly_to(&mut state, time_s, (n, e));
        assert!(!is_off_screen(&state), "no arrow at the edge leads to it\n{}", screen(&state));
    }
    keys(&mut state, "left left left left left left");
    assert!(is_off_screen(&state), "a map that is moved by hand stays\n{}", screen(&state));
}

#[test]
fn the_track_of_the_flight_before_stays_faintly_on_the_map() {
    let mut state = state_with_fix((80, 24));
    keys(&mut state, "1 z");
    arm(&mut state, 8.5);
    let empty = screen(&state);
    for step in 0..20 {
        fly_to(&mut state, 9.0 + f64::from(step), (-3.0 * f64::from(step), 40.0));
    }
    fly_to(&mut state, 40.0, (0.0, 0.0));
    arm(&mut state, 41.0);
    let with_past = screen(&state);
    assert_ne!(with_past, empty);
    // The notice about it is above the frame of the map.
    let toggled = |state: &mut AppState, notice: &str| {
        keys(state, "v");
        assert!(screen(state).contains(notice), "{}", screen(state));
        state.shared.notice = None;
        screen(state)
    };
    let without = toggled(&mut state, "The tracks of earlier flights are hidden.");
    assert_ne!(without, with_past, "hidden on request");
    let shown = toggled(&mut state, "The tracks of earlier flights are shown.");
    assert_eq!(shown, with_past);
}
