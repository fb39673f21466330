//! Two versions beside each other: the plan and the craft's, its file and its revisions, and the settings.

use std::sync::Arc;

use betadeck::ui::files::{FileReply, FileRequest};
use betadeck::ui::{AppState, Effect, Msg, Popup, theme, update};
use crossterm::event::{KeyCode, MouseButton, MouseEventKind};

use crate::ui::hands::{key, keys, mouse, mouse_button, place_of, screen, state_with_fix};
use crate::ui::{fixture, settings};

/// Returns a craft with the square, and an open plan that moves one waypoint, raises another and adds one.
fn edited(size: (u16, u16), theme: theme::Theme) -> AppState {
    let mut state = fixture::state(size, theme);
    let flight = fixture::SimpleFlight { time_s: 8.0, fix: true, ..fixture::SimpleFlight::default() };
    update(&mut state, Msg::View(fixture::view(&flight)));
    keys(&mut state, "2 right right right shift-up down left shift-up shift-up i");
    state
}

fn compared(size: (u16, u16)) -> AppState {
    let mut state = edited(size, fixture::colour());
    keys(&mut state, "V");
    state
}

#[test]
fn the_plan_is_beside_that_of_the_craft_with_a_map() {
    for (name, size) in [("80x24", (80, 24)), ("200x60", (200, 60))] {
        insta::assert_snapshot!(format!("diff_craft_{name}"), screen(&compared(size)));
    }
    let mut state = edited((80, 24), fixture::plain());
    keys(&mut state, "V");
    insta::assert_snapshot!("diff_craft_mono_80x24", screen(&state));
    keys(&mut state, "m");
    insta::assert_snapshot!("diff_craft_map_80x24", screen(&state));
}

#[test]
fn both_plans_are_told_apart_on_the_map_without_colours() {
    let mut state = edited((120, 40), fixture::plain());
    keys(&mut state, "V m");
    let seen = screen(&state);
    assert!(seen.contains("-- this plan ... o craft"), "{seen}");
    assert!(seen.contains("o1 FLYBY"), "the place on the craft: {seen}");
    keys(&mut state, "m");
    let seen = screen(&state);
    assert!(seen.contains("! WP1 FLYBY") && seen.contains("+ WP2 FLYBY") && seen.contains("= WP2"), "{seen}");
}

#[test]
fn a_file_changed_on_disk_is_compared_before_it_is_replaced() {
    let mut state = edited((120, 40), fixture::colour());
    let id = state.shared.editor.plan().id();
    update(&mut state, Msg::Files(FileReply::Changed(id)));
    assert!(screen(&state).contains("`V` compares"), "{}", screen(&state));
    let effects = keys(&mut state, "V");
    assert!(screen(&state).contains("Reading the file …"), "{}", screen(&state));
    assert!(matches!(&effects[..], [Effect::Files(FileRequest::ReadDisk { .. })]), "{effects:?}");
    let mut document = state.shared.editor.plan().document().clone();
    document.name = "of another program".to_owned();
    document.settings = vec!["ap_max_velocity = 3".to_owned()];
    document.plan.waypoints.pop();
    let document = Ok(Box::new(document));
    update(&mut state, Msg::Files(FileReply::OnDisk { id, document }));
    let seen = screen(&state);
    assert!(seen.contains("≠ name") && seen.contains("of another program"), "{seen}");
    assert!(seen.contains("- ap_max_velocity") && seen.contains("+ WP4 LAND"), "{seen}");
    // Another change is read, too.
    let effects = update(&mut state, Msg::Files(FileReply::Changed(id)));
    assert!(matches!(&effects[..], [Effect::Files(FileRequest::ReadDisk { .. })]), "{effects:?}");
}

#[test]
fn the_question_about_a_changed_file_offers_the_comparison() {
    let mut state = edited((80, 24), fixture::colour());
    let id = state.shared.editor.plan().id();
    let path = state.shared.editor.plan().file().unwrap().to_owned();
    update(&mut state, Msg::Files(FileReply::Occupied { id, path, changed: true }));
    assert!(screen(&state).contains("v compare"), "{}", screen(&state));
    let effects = keys(&mut state, "v");
    assert!(matches!(&effects[..], [Effect::Files(FileRequest::ReadDisk { .. })]), "{effects:?}");
    assert!(matches!(state.popups[..], [Popup::Diff(_)]));
}

#[test]
fn revisions_are_compared_in_time() {
    let mut state = edited((120, 40), fixture::colour());
    keys(&mut state, "V tab tab");
    let seen = screen(&state);
    assert!(seen.contains("▸revision   settings  longitude"), "the edit of it: {seen}");
    assert!(seen.contains("╌╌ this plan") && seen.contains("○ revision 3 "), "{seen}");
    let shown = |state: &AppState, revision: &str, label: &str| {
        let seen = screen(state);
        assert!(seen.contains(revision) && seen.contains(&format!("settings  {label}")), "{seen}");
    };
    keys(&mut state, "left left");
    shown(&state, "revision 1", "altitude");
    keys(&mut state, "left");
    shown(&state, "revision 0", "as opened");
    keys(&mut state, "right");
    shown(&state, "revision 1", "altitude");
}

#[test]
fn rows_are_found_by_their_words_and_n_goes_on_in_them() {
    for size in [(60, 20), (80, 24), (200, 60)] {
        let mut state = edited(size, fixture::colour());
        keys(&mut state, "V");
        assert!(screen(&state).contains("Differences — / searches"), "{}", screen(&state));
        keys(&mut state, "/ 'wp1");
        let seen = screen(&state);
        assert!(seen.contains("Differences — Enter keeps the search") && seen.contains("/wp1"), "{seen}");
        assert!(seen.contains("≠ WP1") && seen.contains("≠   longitude") && !seen.contains("WP0 "), "{seen}");
        keys(&mut state, "enter");
        assert!(screen(&state).contains("Differences — /wp1, Esc shows all"), "{}", screen(&state));
        assert!(screen(&state).contains("n N match"), "{}", screen(&state));
        keys(&mut state, "/ 'altitude enter n n N");
        assert!(screen(&state).contains("≠   altitude"), "a value leads to its waypoint: {}", screen(&state));
        keys(&mut state, "/ 'qqqq");
        assert!(screen(&state).contains("None has these words."), "{}", screen(&state));
        keys(&mut state, "esc");
        let seen = screen(&state);
        assert!(seen.contains("≠ WP0") && seen.contains("n N difference"), "all rows are back: {seen}");
        keys(&mut state, "esc");
        assert!(state.popups.is_empty());
    }
}

#[test]
fn the_line_below_names_both_versions_as_their_columns_do() {
    for (size, wanted) in [
        ((60, 20), "+ 1 only in this plan"),
        ((80, 24), "≠ 2 changed   + 1 only in this plan   = 2 the same"),
    ] {
        let seen = screen(&compared(size));
        assert!(seen.contains(wanted), "{seen}");
    }
    let mut state = edited((80, 24), fixture::colour());
    keys(&mut state, "d V tab tab");
    let seen = screen(&state);
    assert!(seen.contains("- 1 only in revision 4   = "), "{seen}");
}

#[test]
fn settings_are_beside_the_defaults_the_plans_and_the_saved_ones() {
    for (name, size) in [("80x24", (80, 24)), ("200x60", (200, 60))] {
        let mut state = settings::opened_with(size, "V f");
        insta::assert_snapshot!(format!("diff_settings_{name}"), screen(&state));
        keys(&mut state, "right");
        assert!(screen(&state).contains("plan"), "{}", screen(&state));
        keys(&mut state, "right right f");
        assert!(screen(&state).contains("= "), "{}", screen(&state));
    }
}

#[test]
fn the_selected_difference_leads_to_its_waypoint() {
    let mut state = compared((80, 24));
    keys(&mut state, "N enter");
    assert!(state.popups.is_empty() && screen(&state).contains("▸2 Plan"), "{}", screen(&state));
    assert_eq!(state.shared.editor.row(), 2, "the added one");
}

#[test]
fn the_mouse_chooses_tabs_and_rows() {
    let mut state = compared((200, 60));
    let row = place_of(&state, "+ WP2");
    mouse(&mut state, MouseEventKind::Down, row);
    mouse_button(&mut state, MouseEventKind::ScrollDown, row);
    let tab = place_of(&state, " revision  ");
    mouse(&mut state, MouseEventKind::Down, (tab.0 + 2, tab.1));
    assert!(screen(&state).contains("▸revision"), "{}", screen(&state));
    mouse_button(&mut state, MouseEventKind::Down(MouseButton::Left), (0, 0));
    assert!(state.popups.is_empty());
}

#[test]
fn a_craft_whose_plan_is_unknown_is_said_to_be_so() {
    let mut state = state_with_fix((80, 24));
    Arc::make_mut(&mut state.shared.view.vehicle).stored_plan = None;
    keys(&mut state, "2 V");
    assert!(
        screen(&state).contains("The plan of the craft is not known: `D` reads it."),
        "{}",
        screen(&state)
    );
    key(&mut state, KeyCode::Esc);
    assert!(state.popups.is_empty());
}

/// Returns a row of the screen, counted from the last one.
fn row_from_below(state: &AppState, back: usize) -> String {
    screen(state).lines().nth(usize::from(state.shared.size.1) - 1 - back).unwrap_or_default().to_owned()
}

#[test]
fn while_words_are_typed_the_last_line_has_their_keys_and_counts_what_they_find() {
    let mut state = compared((120, 40));
    let keys_at = 2;
    assert!(row_from_below(&state, keys_at).contains("f only differences"), "{}", screen(&state));
    keys(&mut state, "/ 'wp1");
    let typed = row_from_below(&state, keys_at);
    assert!(!typed.contains("f only differences") && typed.contains("Enter keep"), "{}", screen(&state));
    let found = screen(&state).lines().filter(|line| line.contains("WP1 ")).count();
    assert!(found > 0 && row_from_below(&state, keys_at + 1).contains("found"), "{}", screen(&state));
    keys(&mut state, "enter");
    let kept = row_from_below(&state, keys_at);
    assert!(kept.contains("n N match") && kept.contains("f only differences"), "{}", screen(&state));
    keys(&mut state, "esc");
    assert!(!row_from_below(&state, keys_at + 1).contains("found"), "{}", screen(&state));
}

#[test]
fn the_large_map_comes_back_after_a_search() {
    let mut state = compared((80, 24));
    keys(&mut state, "m");
    let map = screen(&state);
    keys(&mut state, "/ 'wp1 enter");
    assert_ne!(screen(&state), map, "the rows have the place");
    keys(&mut state, "/ esc");
    assert_eq!(screen(&state), map);
}

#[test]
fn no_key_of_the_panel_behind_is_below_the_comparison() {
    let mut state = compared((120, 40));
    let hints = row_from_below(&state, 0);
    assert!(!hints.contains("insert") && !hints.contains("quit") && hints.contains("ws"), "{hints}");
    keys(&mut state, "esc");
    assert!(row_from_below(&state, 0).contains("q quit"), "{}", screen(&state));
}
