//! Popups by the mouse alone: a click on a shown key presses it, a click on a row selects and then chooses it, a click
//! outside closes.

use betadeck::ui::{AppState, Effect, Popup};
use crossterm::event::{MouseButton, MouseEventKind};

use crate::fixture;
use crate::hands::{keys, mouse, mouse_button, place_of, screen, state_with_fix};

const SIZE: (u16, u16) = (200, 60);

fn approaching() -> AppState {
    let mut state = fixture::state(SIZE, fixture::colour());
    fixture::approach(&mut state);
    state
}

fn click(state: &mut AppState, text: &str) -> Vec<Effect> {
    let (column, row) = place_of(state, text);
    mouse(state, MouseEventKind::Down, (column + 1, row))
}

#[test]
fn questions_are_answered_by_a_click_on_their_keys() {
    let mut state = approaching();
    keys(&mut state, "q");
    assert_eq!(state.popups, [Popup::Quit]);
    mouse(&mut state, MouseEventKind::Down, (3, 30));
    assert_eq!(state.popups, [Popup::Quit], "a click outside answers nothing");
    click(&mut state, " n ");
    assert!(state.popups.is_empty(), "{}", screen(&state));
    keys(&mut state, "q");
    let effects = click(&mut state, " y ");
    assert!(effects.iter().any(|effect| matches!(effect, Effect::Quit)), "{effects:?}");
}

#[test]
fn unsaved_edits_are_kept_by_a_click_on_the_words_of_a_key() {
    let mut state = state_with_fix(SIZE);
    keys(&mut state, "2 i q");
    assert!(screen(&state).contains("discard"), "{}", screen(&state));
    let effects = click(&mut state, "discard");
    assert!(effects.iter().any(|effect| matches!(effect, Effect::Quit)), "{effects:?}");
}

#[test]
fn a_row_is_selected_by_a_click_and_chosen_by_another() {
    let mut state = approaching();
    keys(&mut state, "G");
    click(&mut state, "waypoint  3");
    assert!(screen(&state).contains("▸ waypoint  3"), "{}", screen(&state));
    mouse_button(&mut state, MouseEventKind::ScrollUp, (100, 30));
    assert!(screen(&state).contains("▸ waypoint  2"), "{}", screen(&state));
    click(&mut state, "waypoint  3");
    let effects = click(&mut state, "waypoint  3");
    assert!(state.popups.is_empty() && !effects.is_empty(), "{effects:?}");
    for opened in ["w", "6 enter", "6 /", "G", ":"] {
        keys(&mut state, opened);
        assert!(!state.popups.is_empty(), "{opened}");
        mouse_button(&mut state, MouseEventKind::Down(MouseButton::Left), (1, 3));
        assert!(state.popups.is_empty(), "a click outside closes {opened}: {}", screen(&state));
    }
}

#[test]
fn a_form_is_closed_by_a_click_on_its_key() {
    let mut state = state_with_fix(SIZE);
    keys(&mut state, "2 P");
    assert!(screen(&state).contains("Generate a pattern"), "{}", screen(&state));
    click(&mut state, "Esc close");
    assert!(!screen(&state).contains("Generate a pattern"), "{}", screen(&state));
}
