//! Help for a new user to find the way: the bar of panels, laps of a ring, words for the guards, zoom around the craft.

use betadeck::telemetry::{Guard, GuardName, GuardOp, NavState};
use betadeck::ui::{AppState, Msg, Panel, update};
use crossterm::event::MouseEventKind;

use crate::ui::fixture;
use crate::ui::fixture::SimpleFlight;
use crate::ui::hands::{keys, mouse, place_of, screen, state_with_fix as state};

#[test]
fn a_bar_names_the_panels_and_the_mouse_clicks_them() {
    for size in [(60, 20), (80, 24), (120, 40), (200, 60)] {
        let mut state = state(size);
        for (name, panel) in [
            ("2 Plan", Panel::Plan),
            ("5 CLI", Panel::Cli),
            ("7 World", Panel::World),
            ("8 Log", Panel::Log),
            ("1 Map", Panel::Map),
        ] {
            // In the CLI digits are text.
            let name = if state.shared.focus == Panel::Cli { &name[2..] } else { name };
            let row =
                screen(&state).lines().position(|line| line.contains("World") && line.contains("Graphs"));
            let (column, at) = place_of(&state, name);
            assert_eq!(Some(usize::from(at)), row, "{name} in\n{}", screen(&state));
            mouse(&mut state, MouseEventKind::Down, (column, at));
            mouse(&mut state, MouseEventKind::Up, (column, at));
            assert_eq!(state.shared.focus, panel, "{}", screen(&state));
        }
    }
}

/// Returns a craft that has circled for 11.6 of 30 s.
fn orbits(size: (u16, u16)) -> AppState {
    let mut state = fixture::state(size, fixture::colour());
    fixture::orbit(&mut state);
    state
}

#[test]
fn the_state_panel_says_how_much_of_a_lap_the_time_allows() {
    for size in [(80, 24), (120, 40), (200, 60)] {
        let state = orbits(size);
        assert!(screen(&state).contains("0.25 of a lap in 30 s"), "{}", screen(&state));
    }
}

#[test]
fn a_key_explains_the_guards_and_abbreviations() {
    for size in [(60, 20), (80, 24), (120, 40)] {
        let mut state = state(size);
        let guards = vec![
            Guard { name: GuardName::Beside, value: 0.3, limit: 5.0, op: GuardOp::AtMost },
            Guard { name: GuardName::NoProgress, value: 1.0, limit: 30.0, op: GuardOp::Above },
        ];
        let flight = SimpleFlight {
            time_s: 40.0,
            armed: true,
            fix: true,
            state: NavState::Approaching,
            guards,
            ..SimpleFlight::default()
        };
        update(&mut state, Msg::View(fixture::view(&flight)));
        keys(&mut state, "3 enter");
        assert!(screen(&state).contains("Nearer than the limit"), "{}", screen(&state));
        keys(&mut state, "down");
        assert!(screen(&state).contains("last came nearer"), "{}", screen(&state));
        keys(&mut state, "down");
        assert!(screen(&state).contains("Cross-track error"), "{}", screen(&state));
        keys(&mut state, "esc");
        assert!(!screen(&state).contains("Cross-track error"));
    }
}

#[test]
fn plus_zooms_around_the_craft() {
    let mut state = state((120, 40));
    let flight =
        SimpleFlight { time_s: 40.0, n: 50.0, e: 55.0, armed: true, fix: true, ..SimpleFlight::default() };
    update(&mut state, Msg::View(fixture::view(&flight)));
    keys(&mut state, "+ + + + + +");
    assert!(screen(&state).contains('↑'), "{}", screen(&state));
    let craft = place_of(&state, "↑");
    keys(&mut state, "+ +");
    assert_eq!(place_of(&state, "↑"), craft, "{}", screen(&state));
}

#[test]
fn the_tutorial_goes_on_from_what_was_pressed() {
    let mut state = state((120, 40));
    keys(&mut state, ":");
    keys(&mut state, "'app.tutorial enter");
    let mut view = state.shared.view.clone();
    view.pilot = Some("climbing");
    update(&mut state, Msg::View(view.clone()));
    assert!(screen(&state).contains("1/5 The pilot"), "{}", screen(&state));
    std::sync::Arc::make_mut(&mut view.vehicle).nav.as_mut().unwrap().engaged = true;
    update(&mut state, Msg::View(view.clone()));
    view.speed_wanted = 2.0;
    update(&mut state, Msg::View(view.clone()));
    assert!(screen(&state).contains("2/5 That is 2×"), "{}", screen(&state));
    view.speed_wanted = 4.0;
    update(&mut state, Msg::View(view));
    assert!(screen(&state).contains("3/5 Press 2 for the plan"), "{}", screen(&state));
    keys(&mut state, "2");
    assert!(screen(&state).contains("3/5 Arrows choose a value"), "{}", screen(&state));
}
