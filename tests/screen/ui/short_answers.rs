//! What a key answers in a line: nothing to do, a question before a flight ends, the gravest first.

use std::time::Duration;

use betadeck::session::SessionView;
use betadeck::telemetry::{ArmingFlag, EventKind, NavState};
use betadeck::ui::{AppState, Effect, Msg, draw, update};
use ratatui::Terminal;
use ratatui::backend::TestBackend;

use crate::ui::fixture::{self, SimpleFlight};
use crate::ui::hands::{keys, screen, state_with_fix};
use crate::ui::settings::Craft;

fn in_the_air(size: (u16, u16)) -> AppState {
    let mut state = fixture::state(size, fixture::colour());
    let flight = SimpleFlight {
        time_s: 40.0,
        alt: 50.0,
        armed: true,
        fix: true,
        state: NavState::Approaching,
        ..SimpleFlight::default()
    };
    update(&mut state, Msg::View(fixture::view(&flight)));
    state
}

fn changed(state: &mut AppState, change: impl FnOnce(&mut SessionView)) {
    let mut view = state.shared.view.clone();
    change(&mut view);
    update(state, Msg::View(view));
}

#[test]
fn an_alarm_stays_above_the_answer_to_a_key() {
    for size in [(80, 24), (120, 40)] {
        let mut state = in_the_air(size);
        fixture::hear(&mut state, 40.0, EventKind::BatteryEmpty { cell_v: 3.1 });
        assert!(screen(&state).contains("✗ "), "{}", screen(&state));
        let alarm = state.shared.notice.clone().expect("the alarm").text;
        let shown = |state: &AppState| screen(state).matches(&alarm).count();
        let with_log = shown(&state);
        let echo = Msg::WorldReply { line: "wind=5@270".to_owned(), result: Ok(()) };
        update(&mut state, echo);
        let seen = screen(&state);
        assert!(shown(&state) == with_log && seen.contains("✓ World: wind=5@270."), "{seen}");
        // It leaves when it would have left without the answer.
        update(&mut state, Msg::Clock(Duration::from_secs(9)));
        let later = Msg::WorldReply { line: "calm".to_owned(), result: Ok(()) };
        update(&mut state, later);
        assert_eq!(shown(&state), with_log - 1, "only the log has it: {}", screen(&state));
    }
}

#[test]
fn the_key_that_resets_the_craft_asks_in_the_air_and_not_on_the_ground() {
    let resets =
        |effects: &[Effect]| effects.iter().any(|effect| format!("{effect:?}").contains("ResetCraft"));
    let mut state = in_the_air((80, 24));
    assert!(!resets(&keys(&mut state, "R")));
    assert!(
        screen(&state).contains("The flight would end: press `R` again within 2 s"),
        "{}",
        screen(&state)
    );
    // Another question does not answer this one.
    assert!(!resets(&keys(&mut state, "a R")));
    assert!(resets(&keys(&mut state, "R")));
    let mut state = in_the_air((80, 24));
    keys(&mut state, "R");
    update(&mut state, Msg::Clock(Duration::from_secs(3)));
    assert!(!resets(&keys(&mut state, "R")), "too late");
    assert!(resets(&keys(&mut state_with_fix((80, 24)), "R")), "nothing is lost on the ground");
}

#[test]
fn resetting_settings_that_have_their_defaults_says_so_and_asks_nothing() {
    let mut state = state_with_fix((80, 24));
    let mut craft = Craft::with(&[]);
    craft.press(&mut state, "9");
    craft.press(&mut state, "X");
    assert!(state.popups.is_empty());
    assert!(screen(&state).contains("Every setting has its default"), "{}", screen(&state));
    let mut state = state_with_fix((80, 24));
    let mut craft = Craft::with(&["set ap_max_angle = 31"]);
    craft.press(&mut state, "9");
    craft.press(&mut state, "X");
    assert!(screen(&state).contains("This changes 1 setting of the craft"), "{}", screen(&state));
}

#[test]
fn a_lost_link_that_nobody_cut_is_not_restored_by_the_key_that_cuts_it() {
    let advice = |is_cut| {
        let mut state = state_with_fix((80, 24));
        changed(&mut state, |view| {
            view.rc_cut = is_cut;
            let craft = &mut std::sync::Arc::make_mut(&mut view.vehicle).craft;
            craft.arming_blocked_by = Some([ArmingFlag::RxLoss].into_iter().collect());
        });
        keys(&mut state, "a");
        screen(&state)
    };
    assert!(advice(true).contains("`x` restores"), "{}", advice(true));
    assert!(!advice(false).contains("restores"), "{}", advice(false));
}

#[test]
fn the_tutorial_leaves_the_bar_whose_keys_it_names() {
    for size in [(80, 24), (120, 40), (200, 60)] {
        let mut state = state_with_fix(size);
        keys(&mut state, ":");
        keys(&mut state, "'app.tutorial enter");
        let seen = screen(&state);
        assert!(seen.contains("1/5 Press F"), "{seen}");
        assert!(seen.contains("1 Map  2 Plan  3 State"), "{seen}");
    }
}

#[test]
fn a_file_window_says_that_nothing_is_chosen() {
    let mut state = state_with_fix((80, 24));
    keys(&mut state, "o enter");
    assert!(screen(&state).contains("No file is chosen: type a name, or select one"), "{}", screen(&state));
    keys(&mut state, "'square");
    assert!(screen(&state).contains("square"), "it is still open: {}", screen(&state));
}

#[test]
fn a_notice_is_not_older_in_the_log_than_the_event_below_it() {
    let mut state = in_the_air((120, 40));
    fixture::hear(&mut state, 40.3, EventKind::BatteryEmpty { cell_v: 3.1 });
    update(&mut state, Msg::SaveReply(Err("Not saved.".to_owned())));
    let times: Vec<_> = state.shared.log.newest_first().take(2).map(|line| line.time).collect();
    assert!(times[0] >= times[1], "{times:?}");
}

#[test]
fn joined_characters_do_not_move_the_rest_of_a_row() {
    let mut state = state_with_fix((80, 24));
    update(&mut state, Msg::SaveReply(Err("a 👨‍👩‍👧 b 🇨🇭 c ✌🏽 d".to_owned())));
    let mut terminal = Terminal::new(TestBackend::new(80, 24)).expect("a terminal");
    terminal.draw(|frame| draw(&state, frame)).expect("drawn");
    let cells = &terminal.backend().buffer().content;
    assert!(cells.iter().all(|cell| !cell.symbol().contains(['\u{200d}', '\u{1f3fd}', '\u{1f1e8}'])));
    let seen = screen(&state);
    assert!(seen.contains("a ? b ?? c ✌ d"), "{seen}");
}

#[test]
fn a_setting_is_completed_up_to_the_sign_before_its_value() {
    let mut state = state_with_fix((80, 24));
    state.shared.cli_help.complete = |line| betadeck::firmware::cli::complete(line).lines(line);
    keys(&mut state, ":");
    keys(&mut state, "'set");
    update(&mut state, Msg::Paste(" ap_max_distance".to_owned()));
    let seen = screen(&state);
    assert!(seen.contains("ap_max_distance_from_home="), "the whole name is read: {seen}");
    keys(&mut state, "tab '150");
    assert!(screen(&state).contains(":set ap_max_distance_from_home=150"), "{}", screen(&state));
    let effects = keys(&mut state, "enter");
    assert!(format!("{effects:?}").contains("set ap_max_distance_from_home = 150"), "{effects:?}");
}
