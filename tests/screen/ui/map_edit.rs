//! Home and fence of a plan edited on the map, by the cursor and by the mouse.

use betadeck::plan::FlightPlan;
use betadeck::ui::{AppState, Msg, update};
use crossterm::event::{MouseButton, MouseEventKind};

use crate::ui::fixture;
use crate::ui::hands::{journal_lines, keys, mouse, mouse_button, place_of, screen};

/// Returns a state with a craft that was carried away from home.
fn away_from_home() -> AppState {
    let mut state = fixture::state((120, 40), fixture::colour());
    let flight = fixture::SimpleFlight { n: 150.0, fix: true, ..fixture::SimpleFlight::default() };
    update(&mut state, Msg::View(fixture::view(&flight)));
    state
}

/// Returns the map on the whole screen with its cursor, wide enough for the fence of 500 m.
fn editing() -> AppState {
    let mut state = away_from_home();
    keys(&mut state, "z p - - - - -");
    state
}

/// Moves the cursor to a cell by arrow keys.
fn move_cursor_to(state: &mut AppState, (column, row): (u16, u16)) {
    let (from_column, from_row) = place_of(state, "┼");
    let step = |from: u16, to: u16, less: &str, more: &str| {
        let key = if to < from { less } else { more };
        format!("{key} ").repeat(usize::from(from.abs_diff(to)))
    };
    keys(state, &step(from_column, column, "left", "right"));
    keys(state, &step(from_row, row, "up", "down"));
}

/// Returns the cursor's distance from home that the title shows, m.
fn metres_from_home(state: &AppState) -> f64 {
    let seen = screen(state);
    let title = seen.lines().find(|line| line.contains("edit ·")).expect("the title of the map");
    let reported = title.rsplit_once(" m ").expect("metres").0;
    reported.rsplit(' ').next().and_then(|text| text.parse().ok()).expect("a number")
}

/// Moves the cursor east from home until it is on the ring of the fence, and returns its cell.
fn find_the_fence(state: &mut AppState, fence_m: f64) -> (u16, u16) {
    let home = place_of(state, "⌂");
    move_cursor_to(state, home);
    while metres_from_home(state) < fence_m - 5.0 {
        keys(state, "right");
    }
    place_of(state, "┼")
}

fn fence(state: &AppState) -> Option<f64> {
    let lines = &state.shared.editor.document().settings;
    let value = lines.iter().find_map(|line| line.strip_prefix("ap_max_distance_from_home = "))?;
    value.parse().ok()
}

#[test]
fn home_is_moved_by_the_cursor_as_one_edit_and_stays_where_it_was_put() {
    let mut state = editing();
    let home = place_of(&state, "⌂");
    move_cursor_to(&mut state, home);
    keys(&mut state, "enter");
    keys(&mut state, "left left left left down down");
    let before_it_is_put_down = state.shared.editor.document().home;
    let effects = keys(&mut state, "enter");
    assert_eq!((before_it_is_put_down, journal_lines(&effects)), (None, 1));
    let put = (home.0 - 4, home.1 + 2);
    let moved = state.shared.editor.document().home.expect("home of the plan").position;
    assert!(moved.lat_e7 < fixture::HOME.lat_e7 && moved.lon_e7 < fixture::HOME.lon_e7, "{moved}");
    keys(&mut state, "left left left");
    assert_eq!(place_of(&state, "⌂"), put, "{}", screen(&state));
    keys(&mut state, "p");
    assert!(screen(&state).contains("home of the plan"), "beside home of the craft: {}", screen(&state));
    keys(&mut state, "u");
    assert_eq!(state.shared.editor.document().home, None);
}

#[test]
fn home_is_moved_by_the_mouse() {
    let mut state = editing();
    assert!(screen(&state).contains("Enter pick"), "{}", screen(&state));
    let home = place_of(&state, "⌂");
    mouse(&mut state, MouseEventKind::Down, home);
    for step in 1..=6 {
        assert!(mouse(&mut state, MouseEventKind::Drag, (home.0 + step, home.1)).is_empty());
    }
    assert!(screen(&state).contains("° from home"), "{}", screen(&state));
    let effects = mouse(&mut state, MouseEventKind::Up, (home.0 + 6, home.1));
    assert_eq!(journal_lines(&effects), 1);
    let moved = state.shared.editor.document().home.expect("home of the plan").position;
    assert!(moved.lon_e7 > fixture::HOME.lon_e7, "{moved}");
    assert_eq!(place_of(&state, "⌂"), (home.0 + 6, home.1));
}

#[test]
fn the_fence_is_made_wider_by_the_cursor_and_follows_home() {
    let mut state = editing();
    find_the_fence(&mut state, 500.0);
    let effects = keys(&mut state, "enter right right right right right enter");
    assert_eq!(journal_lines(&effects), 1);
    let wider = fence(&state).expect("a fence");
    assert!((wider - metres_from_home(&state)).abs() < 1.0 && wider > 520.0, "{wider}");
    assert!(screen(&state).contains(&format!("Fence of the plan: {wider:.0} m around home.")));
    // A new home takes the fence along: the ring is found at the same distance from it as before.
    let home = place_of(&state, "⌂");
    move_cursor_to(&mut state, home);
    keys(&mut state, "enter left left left left left left left left enter");
    find_the_fence(&mut state, wider);
    keys(&mut state, "enter left left left left enter");
    let narrower = fence(&state).expect("a fence");
    assert!(narrower < wider && (narrower - metres_from_home(&state)).abs() < 1.0, "{narrower}");
    keys(&mut state, "u u u");
    assert_eq!((fence(&state), state.shared.editor.document().home), (None, None));
}

#[test]
fn the_fence_is_dragged_by_the_mouse_and_put_down_wherever_the_button_is_released() {
    let mut state = editing();
    let (column, row) = find_the_fence(&mut state, 500.0);
    mouse(&mut state, MouseEventKind::Down, (column, row));
    mouse(&mut state, MouseEventKind::Drag, (column - 6, row));
    let effects = mouse(&mut state, MouseEventKind::Up, (column - 6, 0));
    assert_eq!(journal_lines(&effects), 1, "released on the status line");
    let narrower = fence(&state).expect("a fence");
    assert!((300.0..490.0).contains(&narrower), "{narrower}");
}

#[test]
fn without_the_cursor_the_mouse_drags_the_map_over_home_and_fence() {
    let mut state = away_from_home();
    keys(&mut state, "z 2 ctrl-a d 1");
    assert_eq!(*state.shared.plan(), FlightPlan::default());
    let home = place_of(&state, "⌂");
    mouse(&mut state, MouseEventKind::Down, home);
    mouse(&mut state, MouseEventKind::Drag, (home.0 + 5, home.1));
    assert!(mouse(&mut state, MouseEventKind::Up, (home.0 + 5, home.1)).is_empty());
    assert_eq!(state.shared.editor.document().home, None);
}

#[test]
fn the_right_button_opens_a_menu_that_keys_and_clicks_choose_from() {
    let mut state = away_from_home();
    keys(&mut state, "z");
    let right = MouseEventKind::Down(MouseButton::Right);
    mouse_button(&mut state, right, (40, 20));
    assert!(screen(&state).contains("i  add a waypoint here"), "{}", screen(&state));
    let effects = keys(&mut state, "down enter");
    assert_eq!(journal_lines(&effects), 1);
    assert!(state.shared.editor.document().home.is_some() && state.popups.is_empty());
    mouse_button(&mut state, right, (40, 20));
    assert_eq!(journal_lines(&keys(&mut state, "i")), 1);
    assert_eq!(state.shared.plan().waypoints.len(), 5);
    mouse_button(&mut state, right, (20, 10));
    let row = place_of(&state, "fence through here");
    assert_eq!(journal_lines(&mouse(&mut state, MouseEventKind::Down, row)), 1);
    assert!(fence(&state).is_some());
    // At a waypoint the menu is about that waypoint. A click elsewhere or Esc closes it.
    let place = place_of(&state, "▼");
    mouse_button(&mut state, right, place);
    assert!(screen(&state).contains("delete WP"), "{}", screen(&state));
    mouse(&mut state, MouseEventKind::Down, (100, 3));
    mouse_button(&mut state, right, place);
    keys(&mut state, "esc");
    assert_eq!((state.shared.plan().waypoints.len(), state.popups.len()), (5, 0));
    mouse_button(&mut state, right, place);
    keys(&mut state, "d");
    assert_eq!(state.shared.plan().waypoints.len(), 4);
}
