//! Search by `/` in the help, in the transitions and in the log, what the palette remembers, and clicks on hints and in
//! popups.

use betadeck::ui::files::FileRequest;
use betadeck::ui::{AppState, Effect, LineField, Popup};
use crossterm::event::{MouseButton, MouseEventKind};

use crate::ui::fixture;
use crate::ui::hands::{keys, mouse, mouse_button, place_of, screen, state_with_fix};

fn approaching(size: (u16, u16)) -> AppState {
    let mut state = fixture::state(size, fixture::colour());
    fixture::approach(&mut state);
    state
}

fn said(state: &AppState) -> String {
    state.shared.notice.as_ref().map(|notice| notice.text.clone()).unwrap_or_default()
}

#[test]
fn the_help_shows_only_the_keys_that_are_searched() {
    let mut state = state_with_fix((80, 24));
    keys(&mut state, "? / 'last enter");
    let seen = screen(&state);
    assert!(seen.contains("Undo the last edit of the plan") && seen.contains("Keys — /last"), "{seen}");
    assert!(!seen.contains("Open a plan file") && !seen.contains("Mouse"), "{seen}");
    keys(&mut state, "/ 'qqqq");
    assert!(screen(&state).contains("Nothing found"), "{}", screen(&state));
    keys(&mut state, "esc");
    assert!(screen(&state).contains("Keys — / searches"), "{}", screen(&state));
    // A typed letter is text, and no key that closes the help.
    keys(&mut state, "/ 'x");
    assert!(matches!(state.popups[..], [Popup::Help(_)]));
    keys(&mut state, "esc esc");
    assert!(state.popups.is_empty());
}

#[test]
fn a_search_in_the_help_finds_the_keys_of_all_panels() {
    let mut state = state_with_fix((80, 24));
    keys(&mut state, "1 ? / 'CLI enter");
    let seen = screen(&state);
    assert!(seen.contains("In 9 Settings") && !seen.contains("Nothing found"), "{seen}");
    keys(&mut state, "esc");
    assert!(!screen(&state).contains("In 9 Settings"), "{}", screen(&state));
}

#[test]
fn n_and_capital_n_go_on_in_the_found_keys() {
    let mut state = state_with_fix((80, 24));
    keys(&mut state, "? / 'the enter");
    let first = screen(&state);
    keys(&mut state, "n n");
    assert_ne!(screen(&state), first);
    keys(&mut state, "N N");
    assert_eq!(screen(&state), first);
}

#[test]
fn transitions_are_found_by_state_waypoint_and_cause() {
    for size in [(80, 24), (120, 40)] {
        let mut state = approaching(size);
        keys(&mut state, "3 / 'arrived");
        let seen = screen(&state);
        assert!(seen.contains("/arrived"), "{seen}");
        keys(&mut state, "enter");
        assert!(
            !screen(&state).contains("mission starts"),
            "the first one did not arrive: {}",
            screen(&state)
        );
        keys(&mut state, "n n n");
        assert_eq!(said(&state), "No older transition has \"arrived\".");
        keys(&mut state, "N N N");
        assert_eq!(said(&state), "No newer transition has \"arrived\".");
        keys(&mut state, "/ 'qqqq");
        assert!(screen(&state).contains("None has these words."), "{}", screen(&state));
        keys(&mut state, "esc");
        assert!(screen(&state).contains("ORBITING"), "the diagram is back: {}", screen(&state));
        keys(&mut state, "n");
        assert_eq!(said(&state), "No search yet: `/` begins.");
    }
}

#[test]
fn the_log_shows_only_the_lines_that_are_searched() {
    let mut state = approaching((80, 24));
    keys(&mut state, "8 z");
    let shown = |state: &AppState, text: &str| screen(state).contains(text);
    assert!(shown(&state, "IDLE → APPROACHING"), "{}", screen(&state));
    keys(&mut state, "/ 'arrived enter");
    assert!(shown(&state, "→ ARRIVED") && !shown(&state, "IDLE → APPROACHING"), "{}", screen(&state));
    keys(&mut state, "/ 'qqqq enter");
    assert!(shown(&state, "No line has \"qqqq\"."), "{}", screen(&state));
    keys(&mut state, "esc");
    assert!(!shown(&state, "No line has"), "{}", screen(&state));
}

#[test]
fn the_palette_shows_keys_and_begins_with_what_was_chosen() {
    let mut state = state_with_fix((80, 24));
    let first = |state: &AppState| {
        let seen = screen(state);
        seen.lines().skip_while(|line| !line.contains("> ")).nth(1).unwrap_or_default().to_owned()
    };
    keys(&mut state, "ctrl-p");
    assert!(!first(&state).contains("map.fit"), "{}", first(&state));
    let effects = keys(&mut state, "'map.fit enter");
    let kept = effects.iter().any(|effect| {
        matches!(effect, Effect::Files(FileRequest::KeepLine(LineField::Palette, name)) if name == "map.fit")
    });
    assert!(kept, "{effects:?}");
    keys(&mut state, "ctrl-p");
    let row = first(&state);
    assert!(row.contains("map.fit") && row.contains("0│"), "{row}");
}

#[test]
fn hints_help_and_palette_are_used_by_the_mouse() {
    let mut state = state_with_fix((200, 60));
    let help = place_of(&state, "? help");
    mouse(&mut state, MouseEventKind::Down, help);
    assert!(matches!(state.popups[..], [Popup::Help(_)]), "{:?}", state.popups);
    let before = screen(&state);
    mouse_button(&mut state, MouseEventKind::ScrollDown, (100, 30));
    assert_ne!(screen(&state), before, "the wheel scrolls");
    mouse_button(&mut state, MouseEventKind::Down(MouseButton::Left), (0, 0));
    assert!(state.popups.is_empty(), "a click outside closes");
    keys(&mut state, "? / 'settings enter");
    let entry = place_of(&state, "Settings panel");
    mouse(&mut state, MouseEventKind::Down, entry);
    assert!(state.popups.is_empty() && screen(&state).contains("▸9 Settings"), "{}", screen(&state));
    keys(&mut state, "ctrl-p 'view.log");
    let entry = place_of(&state, "view.log  ");
    mouse(&mut state, MouseEventKind::Down, entry);
    assert!(state.popups.is_empty() && screen(&state).contains("▸8 Log"), "{}", screen(&state));
}
