//! Every panel and every popup at the four sizes that the screen is designed for, and at any other size without a panic.

use betadeck::telemetry::NavState;
use betadeck::ui::editor::{EditorPopup, FormKind};
use betadeck::ui::files::{Conversion, ConversionLosses, Entry, FileReply, Listing};
use betadeck::ui::{AppState, Msg, Panel, Popup, draw, update};
use crossterm::event::KeyCode;
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::layout::Position;
use strum::VariantNames as _;

use crate::ui::hands::{key, keys, screen, state_with_fix};
use crate::ui::{fixture, hands, settings};

const SIZES: [(u16, u16); 4] = [(60, 20), (80, 24), (120, 40), (200, 60)];

/// Returns the screens at the four sizes, one below the other.
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
        ("diff", "2 i V"),
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
        key(&mut state, KeyCode::Down);
        state
    });
    insta::assert_snapshot!("popup_browser", seen);
}

#[test]
fn the_timeline_after_a_rewind() {
    let seen = at_four_sizes(|size| {
        let mut state = fixture::state(size, fixture::colour());
        fixture::rewind(&mut state);
        assert_eq!(state.shared.view.vehicle.nav.as_ref().map(|nav| nav.state), Some(NavState::Approaching));
        state
    });
    assert_eq!(seen.matches("REWOUND").count(), SIZES.len(), "{seen}");
    insta::assert_snapshot!("timeline_after_a_rewind", seen);
}

#[test]
fn lost_edits_are_named_until_esc_takes_the_notice_away() {
    for size in SIZES {
        let mut state = approaching(size);
        for number in [3, 4] {
            let text = format!(
                "{number} edits of /home/pilot/plans/survey.toml could not be read: line 4 of the journal is damaged, or \
                 written by a later version. It is kept as /home/pilot/.local/state/betadeck/plans/survey-0.bad."
            );
            update(&mut state, Msg::Files(FileReply::EditsLost(text)));
        }
        update(&mut state, Msg::Files(FileReply::KeptAgain));
        assert!(screen(&state).contains("Edits are kept again."));
        let later = state.shared.now + std::time::Duration::from_secs(3600);
        update(&mut state, Msg::Clock(later));
        keys(&mut state, "1 2 q");
        let seen = screen(&state);
        assert!(seen.contains("✗ 3 edits of") && seen.contains("Esc closes this."), "{seen}");
        keys(&mut state, "esc");
        assert!(
            state.popups.is_empty() && screen(&state).contains("✗ 3 edits of"),
            "what is open is left first"
        );
        keys(&mut state, "esc");
        assert!(screen(&state).contains("✗ 4 edits of"), "the next one");
        keys(&mut state, "esc");
        assert!(!screen(&state).contains("Esc closes this."));
        keys(&mut state, "8 z");
        assert_eq!(screen(&state).matches("edits of /home/pilot").count(), 2, "both are in the log");
    }
}

/// The name of an open element, and a state in which it is open.
type Open = (String, AppState);

/// Opens something with keys while the craft waits at home.
fn waiting(opened: &str) -> Open {
    let mut state = state_with_fix((120, 40));
    keys(&mut state, opened);
    (format!("waiting, {opened}"), state)
}

/// Opens something with keys while the craft flies.
fn flying(opened: &str) -> Open {
    let mut state = approaching((120, 40));
    keys(&mut state, opened);
    (format!("flying, {opened}"), state)
}

/// Returns a state for every popup, prompt and text field, with it open.
fn everything_open() -> Vec<Open> {
    let mut open: Vec<Open> = [
        "ctrl-p",
        "ctrl-p 'wi",
        "ctrl-p 'zzzz",
        ":",
        ": 'w",
        ": 'set",
        "?",
        "? / 'fly",
        "3 / 'arrived",
        "6 / 'vel",
        "6 /",
        "ctrl-l",
        "ctrl-l s",
        "2 i V",
        "2 i V m",
        "2 i V tab",
        "2 i V tab tab",
        "2 i V tab tab tab",
        "6 enter",
        "2 o",
        "2 s 'name",
        "2 P",
        "2 P down down 'x",
        "2 m",
        "2 m 'x",
        "2 E",
        "2 E down '47",
        "2 right right right enter",
        "2 right right right enter 'x",
        "2 i q",
        "5",
        "5 'set",
        "5 'ap_ tab",
        "8 /",
        "8 / 'wind",
        "7 enter",
        "7 enter '12",
        "q",
    ]
    .into_iter()
    .map(waiting)
    .collect();
    let in_flight = ["G", "w", "q", "2 i q", "5 'get", "G enter", "ctrl-p 'go", ": 'go", "6 enter", "m"];
    open.extend(in_flight.into_iter().map(flying));
    for typed in
        ["", "/ 'vel", "/ 'zzzz enter", "enter", "enter 'x enter", "w '9", "f", "f f", "V", "V f", "X", "z"]
    {
        open.push((format!("settings, {typed}"), settings::opened_with((120, 40), typed)));
    }
    let mut menu = settings::opened_with((120, 40), "");
    let right = crossterm::event::MouseEventKind::Down(crossterm::event::MouseButton::Right);
    hands::mouse_button(&mut menu, right, (80, 20));
    open.push(("settings menu".to_owned(), menu));
    let listing = Listing {
        directory: "/home/pilot/plans".into(),
        entries: (0..30)
            .map(|number| Entry { name: format!("survey-{number:02}.toml"), is_directory: number < 3 })
            .collect(),
    };
    for purpose in ["2 o", "2 s"] {
        let (name, mut state) = waiting(purpose);
        update(&mut state, Msg::Files(FileReply::Listed(listing.clone())));
        key(&mut state, KeyCode::Down);
        open.push((format!("{name}, listed"), state));
    }
    for changed in [true, false] {
        let (name, mut state) = waiting("2 i");
        let id = state.shared.editor.plan().id();
        let path = "/home/pilot/plans/survey.toml".into();
        update(&mut state, Msg::Files(FileReply::Occupied { id, path, changed }));
        open.push((format!("{name}, replace"), state));
    }
    for opened in ["ctrl-f", "ctrl-f tab", "ctrl-f 'zzzz"] {
        let (name, mut state) = waiting(opened);
        update(&mut state, Msg::Flights(Ok(crate::ui::flights::library())));
        open.push((format!("{name}, listed"), state));
    }
    for popup in [Popup::Permission, Popup::Guards { selected: 0 }, Popup::ResetSettings] {
        let (_, mut asked) = flying("");
        open.push((variant(&popup), {
            asked.popups.push(popup);
            asked
        }));
    }
    let (_, mut lossy) = waiting("2");
    let losses = ConversionLosses {
        conversion: Conversion::Open("/home/pilot/plans/survey.waypoints".into()),
        lines: (0..40).map(|number| format!("waypoint {number}: a dropped value")).collect(),
        summary: "40 values are dropped".to_owned(),
    };
    update(&mut lossy, Msg::Files(FileReply::Losses(Box::new(losses))));
    open.push(("losses".to_owned(), lossy));
    let (_, mut state) = flying("");
    hands::mouse_button(
        &mut state,
        crossterm::event::MouseEventKind::Down(crossterm::event::MouseButton::Right),
        (20, 10),
    );
    open.push(("map menu".to_owned(), state));
    let mut rewound = fixture::state((120, 40), fixture::colour());
    fixture::rewind(&mut rewound);
    open.push(("rewound".to_owned(), rewound));
    let (_, mut noticed) = flying("");
    update(&mut noticed, Msg::Files(FileReply::Failed("A sentence that is longer than a line. ".repeat(9))));
    open.push(("notice".to_owned(), noticed));
    open
}

/// Returns the name of the variant of a value.
fn variant(value: &impl std::fmt::Debug) -> String {
    format!("{value:?}").chars().take_while(|c| c.is_alphanumeric()).collect()
}

#[test]
fn no_popup_and_no_form_is_left_out_of_the_storm() {
    let open = everything_open();
    let seen = |is: &dyn Fn(&AppState) -> bool| open.iter().any(|(_, state)| is(state));
    for name in Popup::VARIANTS {
        assert!(seen(&|state| state.popups.iter().any(|popup| variant(popup) == *name)), "{name}");
    }
    // The popup of the editor is not public.
    let editors: Vec<String> = open.iter().map(|(_, state)| format!("{:?}", state.shared.editor)).collect();
    for name in EditorPopup::VARIANTS {
        let text = format!("popup: Some({name}(");
        assert!(editors.iter().any(|editor| editor.contains(&text)), "{name}");
    }
    for name in FormKind::VARIANTS {
        let text = format!("popup: Some(Form(Form {{ kind: {name}");
        assert!(editors.iter().any(|editor| editor.contains(&text)), "{name}");
    }
}

/// Draws in a window of this size, regardless of the size in the state. The cursor must be in the window.
fn drawn_in(state: &AppState, size: (u16, u16), what: &str) {
    let mut terminal = Terminal::new(TestBackend::new(size.0, size.1)).unwrap();
    let drawn = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        terminal.draw(|frame| draw(state, frame)).unwrap();
    }));
    assert!(drawn.is_ok(), "{what} in {}x{}, drawn for {:?}", size.0, size.1, state.shared.size);
    let Position { x, y } = terminal.get_cursor_position().unwrap();
    assert!(x < size.0 && y < size.1, "{what} in {}x{}: the cursor is at {x}, {y}", size.0, size.1);
}

#[test]
fn every_popup_prompt_and_editor_is_drawn_in_every_window_down_to_one_cell() {
    let mut sizes: Vec<(u16, u16)> = Vec::new();
    for width in [1, 2, 3, 4, 5, 6, 7, 9, 12, 16, 20, 31, 45, 59, 60, 61, 80, 120, 200] {
        sizes.extend([1, 2, 3, 4, 5, 6, 7, 8, 11, 15, 19, 20, 21, 24, 34, 60].map(|height| (width, height)));
    }
    // Each state in a quarter of the sizes, each size with a quarter of the states.
    for (nth, (what, mut state)) in everything_open().into_iter().enumerate() {
        for (at, &size) in sizes.iter().enumerate().skip(nth % 4).step_by(4) {
            update(&mut state, Msg::Resize(size.0, size.1));
            drawn_in(&state, size, &what);
            // The window changes its size again before the program notices.
            drawn_in(&state, sizes[(at * 7 + 3) % sizes.len()], &what);
        }
    }
}

#[test]
fn every_panel_is_drawn_in_every_window_with_a_field_open_in_another() {
    for (what, mut state) in everything_open().into_iter().step_by(3) {
        for panel in Panel::ALL {
            state.shared.focus = panel;
            for size in [(1, 1), (2, 1), (80, 1), (1, 80), (80, 2), (60, 19), (60, 20), (79, 23), (120, 34)] {
                for zoomed in [true, false] {
                    state.shared.zoomed = zoomed;
                    update(&mut state, Msg::Resize(size.0, size.1));
                    drawn_in(&state, size, &what);
                }
            }
        }
    }
}
