//! Popups by the mouse alone: a click on a shown key presses it, a click on a row selects and then chooses it, a click
//! outside closes.

use betadeck::ui::files::{Entry, FileReply, FileRequest, Listing};
use betadeck::ui::theme::Palette;
use betadeck::ui::{AppState, Effect, Msg, Popup, update};
use crossterm::event::{MouseButton, MouseEventKind};

use crate::ui::fixture;
use crate::ui::hands::{keys, mouse, mouse_button, place_of, screen, state_with_fix};

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

/// Returns the cell of the label of a form's row.
fn label_of(state: &AppState, label: &str) -> (u16, u16) {
    let seen = screen(state);
    let found = seen.lines().enumerate().find_map(|(row, line)| {
        let at = ["│  ", "│▸ "].iter().find_map(|mark| line.find(&format!("{mark}{label} ")))?;
        // Each line of the screen is in quotes.
        Some((line[..at].chars().count() as u16 + 2, row as u16))
    });
    found.unwrap_or_else(|| panic!("no {label} in\n{seen}"))
}

/// Returns the cell of a text after the label of a form's row.
fn value_of(state: &AppState, label: &str, text: &str) -> (u16, u16) {
    let (column, row) = label_of(state, label);
    let seen = screen(state);
    let line: String = seen.lines().nth(usize::from(row)).expect("a row").chars().skip(1).collect();
    let after: String = line.chars().skip(usize::from(column)).collect();
    let at = after.find(text).unwrap_or_else(|| panic!("no {text} in {line}"));
    (column + after[..at].chars().count() as u16, row)
}

/// Returns `true` if the row with this label is selected in the form.
fn is_selected(state: &AppState, label: &str) -> bool {
    screen(state).contains(&format!("│▸ {label} "))
}

/// The keys that open each form, and the labels of its rows. The settings of a plan have the same label.
const FORMS: [(&str, &[&str]); 3] = [
    (
        "2 P",
        &[
            "shape",
            "length",
            "width",
            "spacing",
            "heading",
            "altitude",
            "speed",
            "type",
            "result",
            "beyond 30",
        ],
    ),
    ("2 m", &["altitude", "altitude by", "speed", "move north", "move east", "rotate", "mirror", "reverse"]),
    ("2 E", &["name", "description", "home"]),
];

#[test]
fn every_row_of_every_form_is_selected_by_a_click() {
    for size in [(80, 24), SIZE] {
        for (opened, labels) in FORMS {
            let mut state = state_with_fix(size);
            keys(&mut state, opened);
            for label in labels.iter().rev().chain(labels) {
                let cell = label_of(&state, label);
                mouse(&mut state, MouseEventKind::Down, cell);
                assert!(is_selected(&state, label), "{opened} {label}: {}", screen(&state));
            }
            mouse_button(&mut state, MouseEventKind::ScrollUp, (40, 12));
            assert!(is_selected(&state, labels[labels.len() - 2]), "the wheel moves up: {}", screen(&state));
            mouse_button(&mut state, MouseEventKind::ScrollDown, (40, 12));
            assert!(
                is_selected(&state, labels[labels.len() - 1]),
                "the wheel moves down: {}",
                screen(&state)
            );
            let before = screen(&state);
            mouse(&mut state, MouseEventKind::Down, (1, 3));
            assert_eq!(screen(&state), before, "a click outside loses nothing that was typed");
        }
    }
}

#[test]
fn a_choice_of_a_form_goes_on_by_clicks_on_it_and_on_its_arrows() {
    let mut state = state_with_fix(SIZE);
    keys(&mut state, "2 P down");
    let shows = |state: &AppState, shape: &str| {
        is_selected(state, "shape") && screen(state).contains(&format!("◂ {shape} ▸"))
    };
    let label = label_of(&state, "shape");
    mouse(&mut state, MouseEventKind::Down, label);
    assert!(shows(&state, "square"), "the first click selects: {}", screen(&state));
    mouse(&mut state, MouseEventKind::Down, label);
    assert!(shows(&state, "circle"), "a click on the selected one takes the next: {}", screen(&state));
    keys(&mut state, "down");
    let back = value_of(&state, "shape", "◂");
    mouse(&mut state, MouseEventKind::Down, back);
    assert!(shows(&state, "square"), "◂ goes back at once: {}", screen(&state));
    keys(&mut state, "down");
    let on = value_of(&state, "shape", "▸");
    mouse(&mut state, MouseEventKind::Down, on);
    assert!(shows(&state, "circle"), "▸ goes on at once: {}", screen(&state));
}

#[test]
fn a_click_into_a_typed_value_puts_the_cursor_there() {
    let mut state = state_with_fix(SIZE);
    keys(&mut state, "2 E 'square");
    let cell = value_of(&state, "name", "square");
    mouse(&mut state, MouseEventKind::Down, (cell.0 + 2, cell.1));
    keys(&mut state, "'XY");
    assert!(screen(&state).contains("sqXYuare "), "{}", screen(&state));
    // Beyond its end the cursor is after the text.
    mouse(&mut state, MouseEventKind::Down, (cell.0 + 25, cell.1));
    keys(&mut state, "'!");
    assert!(screen(&state).contains("sqXYuare!"), "{}", screen(&state));
}

#[test]
fn a_file_is_chosen_by_clicks() {
    let mut state = state_with_fix(SIZE);
    keys(&mut state, "o");
    let entry = |name: &str, is_directory| Entry { name: name.to_owned(), is_directory };
    let entries = vec![entry("deep", true), entry("orbit.toml", false), entry("zigzag.toml", false)];
    let listing = Listing { directory: "/plans/mine".into(), entries };
    update(&mut state, Msg::Files(FileReply::Listed(listing)));
    click(&mut state, " zigzag.toml");
    assert!(screen(&state).contains("▸zigzag.toml"), "{}", screen(&state));
    click(&mut state, " orbit.toml");
    assert!(screen(&state).contains("▸orbit.toml"), "{}", screen(&state));
    let effects = click(&mut state, " /plans/mine/");
    let is_list = |effects: &[Effect], wanted: &str| {
        let mut listed = effects.iter().filter_map(|effect| match effect {
            Effect::Files(FileRequest::List(Some(directory))) => Some(directory),
            _ => None,
        });
        listed.any(|directory| directory.as_path() == std::path::Path::new(wanted))
    };
    assert!(is_list(&effects, "/plans"), "a click on the directory goes to the one above: {effects:?}");
    click(&mut state, " deep/");
    let effects = click(&mut state, "▸deep/");
    assert!(is_list(&effects, "/plans/mine/deep"), "{effects:?}");
    click(&mut state, " zigzag.toml");
    let effects = click(&mut state, "▸zigzag.toml");
    assert!(
        effects.iter().any(|effect| matches!(effect, Effect::Files(FileRequest::Open { path, .. })
            if path.ends_with("zigzag.toml"))),
        "{effects:?}"
    );
}

#[test]
fn a_command_with_a_word_is_entered_by_clicks_alone() {
    let mut state = approaching();
    keys(&mut state, ": 'th");
    click(&mut state, "theme ");
    assert!(screen(&state).contains(":theme "), "{}", screen(&state));
    click(&mut state, "high-contrast ");
    assert!(screen(&state).contains(":theme high-contrast"), "{}", screen(&state));
    click(&mut state, "│high-contrast ");
    assert!(state.popups.is_empty(), "a click on the entered word runs the line: {}", screen(&state));
    assert_eq!(state.shared.theme.palette, Palette::HighContrast);
    keys(&mut state, ": 'view.zoom");
    click(&mut state, "Enter runs");
    assert!(state.popups.is_empty() && state.shared.zoomed, "{}", screen(&state));
    keys(&mut state, ":");
    click(&mut state, "Esc leaves");
    assert!(state.popups.is_empty(), "{}", screen(&state));
}
