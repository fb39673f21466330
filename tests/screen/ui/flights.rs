//! The library of recorded flights: listed, searched, shown, compared and deleted.

use std::path::PathBuf;
use std::time::Duration;

use betadeck::ui::flights::LibraryFlight;
use betadeck::ui::{AppState, Effect, Msg, Popup, update};
use crossterm::event::{KeyCode, MouseButton, MouseEventKind};

use crate::ui::hands::{key, keys, mouse, mouse_button, press, screen, state_with_fix};

const SIZES: [(u16, u16); 4] = [(60, 20), (80, 24), (120, 40), (200, 60)];

fn flight(minute: u32, plan: &str, verdict: &str, reason: &str) -> LibraryFlight {
    LibraryFlight {
        file: format!("/state/flights/2026-05-09T07-{minute:02}-33-{plan}.flight").into(),
        date: format!("2026-05-09 07:{minute:02}:33"),
        plan: plan.to_owned(),
        verdict: verdict.to_owned(),
        reason: reason.to_owned(),
        duration: "3:45".to_owned(),
        bytes: 712_345,
        is_readable: true,
        is_growing: false,
    }
}

/// Returns a flight under way, four that are over, and a damaged file.
pub(crate) fn library() -> Vec<LibraryFlight> {
    vec![
        LibraryFlight { is_growing: true, bytes: 83_000, ..flight(50, "square", "recording", "") },
        flight(40, "square", "complete", "mission complete, landed 0.3 m from its place and disarmed"),
        flight(30, "survey-of-the-long-field-north", "crashed", "the hull touched the ground at 8.1 m/s"),
        flight(20, "land", "cut short", "its program was ended in flight"),
        LibraryFlight { bytes: 3_400_000, ..flight(10, "\u{1b}[2Jorbit", "complete", "mission complete") },
        LibraryFlight {
            file: "/state/flights/damaged.flight".into(),
            date: String::new(),
            plan: String::new(),
            duration: String::new(),
            bytes: 3,
            is_readable: false,
            ..flight(0, "", "unreadable", "it is no recording")
        },
    ]
}

fn opened(size: (u16, u16)) -> AppState {
    let mut state = state_with_fix(size);
    let effects = keys(&mut state, "ctrl-f");
    assert!(matches!(effects[..], [Effect::ListFlights { after: Duration::ZERO }]), "{effects:?}");
    update(&mut state, Msg::Flights(Ok(library())));
    state
}

fn files(effects: &[Effect]) -> Vec<PathBuf> {
    match effects {
        [Effect::ShowFlights { files, again: false }] => files.clone(),
        other => panic!("{other:?}"),
    }
}

fn notice(state: &AppState) -> String {
    state.shared.notice.as_ref().map(|notice| notice.text.clone()).unwrap_or_default()
}

#[test]
fn the_library_lists_date_plan_verdict_time_and_size() {
    let seen = SIZES.map(|size| {
        let mut state = opened(size);
        keys(&mut state, "down");
        screen(&state)
    });
    insta::assert_snapshot!(seen.join("\n"));
}

#[test]
fn typing_finds_flights_and_enter_shows_one() {
    let mut state = opened((80, 24));
    keys(&mut state, "'squa 'complete");
    // A blank between two words.
    keys(&mut state, "esc ctrl-f 'squ");
    press(&mut state, ' ');
    let effects = keys(&mut state, "'comp enter");
    assert_eq!(files(&effects), [library()[1].file.clone()]);
    assert!(matches!(state.popups[..], [Popup::Flights(_)]), "the list is the way back");
    keys(&mut state, "'zzz");
    assert!(screen(&state).contains("Nothing found"), "{}", screen(&state));
    assert!(keys(&mut state, "enter").is_empty());
}

#[test]
fn a_flight_is_flown_again_by_another_key_unless_it_is_under_way() {
    let mut state = opened((80, 24));
    assert!(keys(&mut state, "ctrl-o").is_empty());
    assert!(notice(&state).contains("still being recorded"), "{}", notice(&state));
    let effects = keys(&mut state, "down ctrl-o");
    let [Effect::ShowFlights { files, again: true }] = &effects[..] else { panic!("{effects:?}") };
    assert_eq!(*files, [library()[1].file.clone()]);
}

#[test]
fn two_marked_flights_are_shown_beside_each_other() {
    let mut state = opened((80, 24));
    keys(&mut state, "down tab down down tab");
    let shown = screen(&state);
    assert!(shown.contains("compare A and B"), "{shown}");
    let list = library();
    assert_eq!(files(&keys(&mut state, "enter")), [list[1].file.clone(), list[3].file.clone()]);
    // A third mark replaces the first, and a second press removes one.
    keys(&mut state, "up tab");
    assert_eq!(files(&keys(&mut state, "enter")), [list[3].file.clone(), list[2].file.clone()]);
    keys(&mut state, "tab");
    assert_eq!(files(&keys(&mut state, "enter")), [list[2].file.clone()]);
}

#[test]
fn a_damaged_file_is_listed_with_its_reason_and_can_only_be_deleted() {
    let mut state = opened((80, 24));
    keys(&mut state, "'unread");
    assert!(screen(&state).contains("damaged.flight: it is no recording"), "{}", screen(&state));
    for refused in ["enter", "tab", "ctrl-o"] {
        assert!(keys(&mut state, refused).is_empty());
        assert!(notice(&state).contains("damaged.flight cannot be shown: it is no recording."));
    }
    key(&mut state, KeyCode::Delete);
    let effects = keys(&mut state, "'y");
    assert!(
        matches!(&effects[..], [Effect::DeleteFlight(file)] if *file == library()[5].file),
        "{effects:?}"
    );
}

#[test]
fn a_flight_is_deleted_only_after_a_question() {
    let mut state = opened((80, 24));
    key(&mut state, KeyCode::Delete);
    assert!(notice(&state).contains("can be deleted once it is over"), "{}", notice(&state));
    keys(&mut state, "down");
    key(&mut state, KeyCode::Delete);
    let shown = screen(&state);
    assert!(shown.contains("Delete the recording 2026-05-09 07:40:33 square?"), "{shown}");
    assert!(keys(&mut state, "'x enter").is_empty() && screen(&state).contains("Delete the recording"));
    assert!(keys(&mut state, "'n").is_empty() && !screen(&state).contains("Delete the recording"));
    key(&mut state, KeyCode::Delete);
    let effects = keys(&mut state, "'y");
    let [Effect::DeleteFlight(file)] = &effects[..] else { panic!("{effects:?}") };
    update(&mut state, Msg::FlightDeleted { file: file.clone(), result: Ok(()) });
    assert!(!screen(&state).contains("07:40:33  square") && notice(&state).contains("is deleted."));
    let file = library()[3].file.clone();
    update(&mut state, Msg::FlightDeleted { file, result: Err("permission denied".to_owned()) });
    assert!(
        notice(&state).ends_with("-land.flight is not deleted: permission denied."),
        "{}",
        notice(&state)
    );
}

#[test]
fn a_flight_recorded_meanwhile_appears_and_the_selected_one_stays_selected() {
    let mut state = opened((80, 24));
    keys(&mut state, "down down tab");
    let mut longer = library();
    longer.insert(0, flight(55, "newest", "complete", "mission complete"));
    let effects = update(&mut state, Msg::Flights(Ok(longer.clone())));
    assert!(matches!(effects[..], [Effect::ListFlights { after }] if after > Duration::ZERO), "{effects:?}");
    let shown = screen(&state);
    assert!(shown.contains("newest"), "{shown}");
    let row = shown.lines().find(|line| line.contains("▸ A")).expect("a selected row");
    assert!(row.contains("survey-of-the"), "{shown}");
    // A deleted flight loses its mark.
    longer.remove(3);
    update(&mut state, Msg::Flights(Ok(longer)));
    assert!(!screen(&state).contains("▸ A"), "{}", screen(&state));
    // A closed list is not read again, and one look is asked for at a time.
    keys(&mut state, "esc");
    assert!(keys(&mut state, "ctrl-f").is_empty(), "an answer is under way");
    keys(&mut state, "esc");
    assert!(update(&mut state, Msg::Flights(Ok(Vec::new()))).is_empty());
    assert_eq!(keys(&mut state, "ctrl-f").len(), 1);
    assert!(screen(&state).contains("No flights yet"), "{}", screen(&state));
}

#[test]
fn the_mouse_selects_shows_marks_and_scrolls() {
    let mut state = opened((200, 60));
    let shown = screen(&state);
    let row_of = |text: &str| shown.lines().position(|line| line.contains(text)).expect("a row") as u16;
    let (land, orbit) = (row_of("land"), row_of("orbit"));
    assert!(mouse(&mut state, MouseEventKind::Down, (100, land)).is_empty());
    assert_eq!(files(&mouse(&mut state, MouseEventKind::Down, (100, land))), [library()[3].file.clone()]);
    for row in [land, orbit] {
        mouse_button(&mut state, MouseEventKind::Down(MouseButton::Right), (100, row));
    }
    assert!(screen(&state).contains("▸ B"), "{}", screen(&state));
    mouse_button(&mut state, MouseEventKind::ScrollUp, (100, land));
    assert_eq!(
        files(&keys(&mut state, "enter")),
        [library()[3].file.clone(), library()[4].file.clone()],
        "the marked ones"
    );
    mouse(&mut state, MouseEventKind::Down, (2, 2));
    assert!(state.popups.is_empty(), "a click beside it closes it");
}

#[test]
fn a_library_of_a_thousand_flights_is_scrolled_to_its_end() {
    let mut state = opened((80, 24));
    let many =
        (0..1000).map(|number| flight(number % 60, &format!("plan-{number}"), "complete", "")).collect();
    update(&mut state, Msg::Flights(Ok(many)));
    for _ in 0..120 {
        key(&mut state, KeyCode::PageDown);
    }
    let shown = screen(&state);
    assert!(shown.contains("Recorded flights — 1000") && shown.contains("plan-999 "), "{shown}");
    keys(&mut state, "'plan-77");
    assert!(screen(&state).contains("Recorded flights — 11 of 1000"), "{}", screen(&state));
}

#[test]
fn a_library_that_cannot_be_read_says_why() {
    let mut state = state_with_fix((80, 24));
    keys(&mut state, "ctrl-f");
    assert!(screen(&state).contains("Reading the library…"));
    update(
        &mut state,
        Msg::Flights(Err("The library of flights /state/flights cannot be read: it is a file.".into())),
    );
    assert!(screen(&state).contains("cannot be read: it is a file."), "{}", screen(&state));
    update(&mut state, Msg::FlightsShown(Err("square.flight cannot be shown.".to_owned())));
    assert_eq!(notice(&state), "square.flight cannot be shown.");
}
