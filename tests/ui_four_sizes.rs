//! Every panel and every popup at the four sizes that the screen is designed for.

use betadeck::telemetry::NavState;
use betadeck::ui::editor::{Entry, FileReply, Listing};
use betadeck::ui::{AppState, Msg, update};
use crossterm::event::{KeyCode, KeyModifiers};

#[path = "ui/fixture.rs"]
mod fixture;
#[path = "ui/hands.rs"]
mod hands;

use hands::{keys, press, screen, state_with_fix};

const SIZES: [(u16, u16); 4] = [(60, 20), (80, 24), (120, 40), (200, 60)];

/// The screens at the four sizes, one below the other.
fn at_four_sizes(draw: impl Fn((u16, u16)) -> AppState) -> String {
    SIZES.map(|size| screen(&draw(size))).join("\n")
}

fn approaching(size: (u16, u16)) -> AppState {
    let mut state = fixture::state(size, fixture::colour());
    fixture::approach(&mut state);
    state
}

#[test]
fn every_panel() {
    for (key, name) in [("1", "map"), ("2", "plan"), ("3", "state"), ("4", "rc"), ("5", "cli"), ("8", "log")]
    {
        let seen = at_four_sizes(|size| {
            let mut state = approaching(size);
            keys(&mut state, key);
            state
        });
        assert_eq!(seen.matches(&format!("▸{key} ")).count(), SIZES.len(), "{name} has the focus\n{seen}");
        insta::assert_snapshot!(format!("panel_{name}"), seen);
    }
}

#[test]
fn every_popup() {
    let typed = [
        ("generate", "2 P"),
        ("bulk", "2 m"),
        ("properties", "2 E"),
        ("value", "2 right right right enter"),
        ("help", "?"),
        ("palette", "ctrl-p"),
        ("command_line", ":"),
        ("plots", "6 enter"),
        ("unsaved", "2 i q"),
    ];
    for (name, opened) in typed {
        let seen = at_four_sizes(|size| {
            let mut state = state_with_fix(size);
            keys(&mut state, opened);
            state
        });
        insta::assert_snapshot!(format!("popup_{name}"), seen);
    }
    for (name, opened) in [("go_to", "G"), ("what_if", "w"), ("quit", "q")] {
        let seen = at_four_sizes(|size| {
            let mut state = approaching(size);
            keys(&mut state, opened);
            assert!(!state.popups.is_empty(), "{name}");
            state
        });
        insta::assert_snapshot!(format!("popup_{name}"), seen);
    }
}

#[test]
fn the_file_browser() {
    let entry = |name: &str, is_directory| Entry { name: name.to_owned(), is_directory };
    let seen = at_four_sizes(|size| {
        let mut state = state_with_fix(size);
        keys(&mut state, "2 o");
        let names = (0..30).map(|number| entry(&format!("survey-{number:02}.toml"), false));
        let entries = std::iter::once(entry("older", true)).chain(names).collect();
        let listing = Listing { directory: "/home/pilot/plans".into(), entries };
        update(&mut state, Msg::Files(FileReply::Listed(listing)));
        press(&mut state, KeyCode::Down, KeyModifiers::NONE);
        state
    });
    insta::assert_snapshot!("popup_browser", seen);
}

#[test]
fn the_timeline_after_a_rewind() {
    let seen = at_four_sizes(|size| {
        let mut state = fixture::state(size, fixture::colour());
        fixture::rewind(&mut state);
        assert_eq!(state.view.vehicle.nav.as_ref().map(|nav| nav.state), Some(NavState::Approaching));
        state
    });
    assert_eq!(seen.matches("REWOUND").count(), SIZES.len(), "{seen}");
    insta::assert_snapshot!("timeline_after_a_rewind", seen);
}
