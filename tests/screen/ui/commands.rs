//! Commands by name: keys, palette and the `:` line reach the same actions, and typed characters are text.

use betadeck::session::Command;
use betadeck::ui::action::{ACTIONS, Action};
use betadeck::ui::command;
use betadeck::ui::enabled;
use betadeck::ui::files::FileRequest;
use betadeck::ui::keymap::KeyPress;
use betadeck::ui::{AppState, Effect, EnteredLines, FlightForm, LineField, Msg, Panel, Popup, update};
use betadeck::vehicle::VehicleCommand;
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers, MouseEventKind};

use crate::ui::fixture;
use crate::ui::fixture::SimpleFlight;
use crate::ui::hands::{mouse, mouse_button, place_of, screen};

fn key(state: &mut AppState, code: KeyCode) -> Vec<Effect> {
    let mut effects = update(state, Msg::Key(KeyEvent::new(code, KeyModifiers::NONE)));
    // Lines stored for the next start have their own test.
    effects.retain(|effect| !matches!(effect, Effect::Files(FileRequest::KeepLine(..))));
    effects
}

fn ctrl(state: &mut AppState, c: char) -> Vec<Effect> {
    update(state, Msg::Key(KeyEvent::new(KeyCode::Char(c), KeyModifiers::CONTROL)))
}

fn type_text(state: &mut AppState, text: &str) {
    for c in text.chars() {
        assert!(key(state, KeyCode::Char(c)).is_empty(), "{c} of {text} is text");
    }
}

/// Enters a `:` line.
fn enter(state: &mut AppState, line: &str) -> Vec<Effect> {
    key(state, KeyCode::Char(':'));
    type_text(state, line);
    key(state, KeyCode::Enter)
}

fn ready() -> AppState {
    ready_at((120, 40))
}

fn ready_at(size: (u16, u16)) -> AppState {
    let mut state = fixture::state(size, fixture::colour());
    let view = fixture::view(&SimpleFlight { time_s: 8.0, fix: true, ..SimpleFlight::default() });
    update(&mut state, Msg::View(view));
    state
}

fn notice(state: &AppState) -> String {
    state.shared.notice.as_ref().map(|notice| notice.text.clone()).unwrap_or_default()
}

/// Returns the effects of an action as text, as far as they can be compared.
fn outcome(state: &AppState, effects: &[Effect]) -> String {
    let popups: Vec<_> = state.popups.iter().filter(|popup| !matches!(popup, Popup::Palette(_))).collect();
    format!("{effects:?} {:?} {} {popups:?} {}", state.shared.focus, state.shared.zoomed, notice(state))
}

#[test]
fn every_action_does_the_same_by_key_palette_and_name() {
    for spec in ACTIONS {
        let focus = Panel::ALL
            .into_iter()
            .find(|&panel| spec.context.applies(panel) && panel != Panel::Cli)
            .unwrap_or_else(|| panic!("{} applies nowhere", spec.name));
        let start = || {
            let mut state = ready();
            state.shared.focus = focus;
            state.shared.slots.visit(focus);
            state
        };

        let mut by_key = start();
        let first = spec.keys.first().unwrap_or_else(|| panic!("{} has no key", spec.name));
        let press = KeyPress::parse(first).expect("a key");
        assert_eq!(by_key.shared.keymap.action(press, focus), Some(spec.action), "{}", spec.name);
        let effects = update(&mut by_key, Msg::Key(press.event()));
        let wanted = outcome(&by_key, &effects);

        let mut by_name = start();
        let effects = enter(&mut by_name, spec.name);
        assert_eq!(outcome(&by_name, &effects), wanted, ":{}", spec.name);

        let mut by_palette = start();
        ctrl(&mut by_palette, 'p');
        if spec.action == Action::Palette {
            assert!(matches!(by_palette.popups[..], [Popup::Palette(_)]), "it is the palette");
            continue;
        }
        type_text(&mut by_palette, spec.name);
        let shown = screen(&by_palette);
        assert!(shown.contains(spec.name), "{}\n{shown}", spec.name);
        let effects = key(&mut by_palette, KeyCode::Enter);
        assert_eq!(outcome(&by_palette, &effects), wanted, "{} by the palette", spec.name);
    }
}

/// Returns a screen with the palette, opened and scrolled by the mouse so that this entry is selected, and the row of it.
fn scrolled_to(focus: Panel, entry: usize) -> (AppState, (u16, u16)) {
    let mut state = ready_at((200, 60));
    state.shared.focus = focus;
    state.shared.slots.visit(focus);
    mouse(&mut state, MouseEventKind::Down, (4, 0));
    assert!(matches!(state.popups[..], [Popup::Palette(_)]), "a click on the status opens the palette");
    for _ in 0..entry {
        mouse_button(&mut state, MouseEventKind::ScrollDown, (100, 30));
    }
    let prompt = place_of(&state, "│> ");
    (state, (prompt.0 + 4, prompt.1 + 1 + entry.min(13) as u16))
}

#[test]
fn every_command_is_reached_by_the_mouse_alone() {
    let actions = ACTIONS.iter().filter(|spec| spec.action != Action::Palette);
    let mut count = 0;
    for (at, spec) in actions.enumerate() {
        let applies = |panel: &Panel| spec.context.applies(*panel) && *panel != Panel::Cli;
        let focus = Panel::ALL.into_iter().find(applies).unwrap_or_else(|| panic!("{}", spec.name));
        let mut by_name = ready_at((200, 60));
        by_name.shared.focus = focus;
        by_name.shared.slots.visit(focus);
        let effects = enter(&mut by_name, spec.name);
        let wanted = outcome(&by_name, &effects);
        let (mut by_mouse, cell) = scrolled_to(focus, at);
        let shown: String = spec.name.chars().take(20).collect();
        assert_eq!(place_of(&by_mouse, &format!(" {shown}")).1, cell.1, "{shown} is where it is clicked");
        let mut effects = mouse(&mut by_mouse, MouseEventKind::Down, cell);
        effects.retain(|effect| !matches!(effect, Effect::Files(FileRequest::KeepLine(..))));
        assert_eq!(outcome(&by_mouse, &effects), wanted, "{} by the mouse", spec.name);
        count = at + 1;
    }
    // Those with a value open the line that takes it.
    for (at, command) in command::all().enumerate() {
        let (mut state, cell) = scrolled_to(Panel::Map, count + at);
        mouse(&mut state, MouseEventKind::Down, cell);
        let line = state.command_line.field.value().trim_end();
        assert!(state.popups.is_empty() || line == command.name, "{}: {line}", command.name);
    }
}

#[test]
fn the_palette_finds_by_a_few_letters_and_says_why_not() {
    let mut state = ready();
    ctrl(&mut state, 'p');
    type_text(&mut state, "home");
    assert!(enabled(&state.shared, Action::ReturnHome).is_err());
    let shown = screen(&state);
    assert!(shown.contains("✗ flight.home") && shown.contains("✗ Nothing to bring home"), "{shown}");
    assert!(key(&mut state, KeyCode::Enter).is_empty());
    assert!(state.popups.is_empty() && notice(&state).contains("Nothing to bring home"));

    ctrl(&mut state, 'p');
    type_text(&mut state, "cutrc");
    assert!(matches!(
        key(&mut state, KeyCode::Enter)[..],
        [Effect::Send(Command::Vehicle(VehicleCommand::CutRc(true)))]
    ));

    ctrl(&mut state, 'p');
    type_text(&mut state, "turbulence");
    key(&mut state, KeyCode::Enter);
    assert_eq!(state.popups, [Popup::CommandLine], "it needs an argument");
    type_text(&mut state, "light");
    let effects = key(&mut state, KeyCode::Enter);
    assert!(matches!(&effects[..], [Effect::World(line)] if line == "turbulence=light"), "{effects:?}");
}

#[test]
fn the_palette_moves_and_closes() {
    let mut state = ready();
    ctrl(&mut state, 'p');
    for _ in 0..200 {
        key(&mut state, KeyCode::Down);
    }
    let [Popup::Palette(palette)] = &state.popups[..] else { panic!("it is open") };
    assert!(palette.selected >= ACTIONS.len());
    key(&mut state, KeyCode::PageUp);
    type_text(&mut state, "zzzz");
    assert!(screen(&state).contains("Nothing found"));
    assert!(key(&mut state, KeyCode::Enter).is_empty());
    key(&mut state, KeyCode::Esc);
    assert!(state.popups.is_empty());
    // In the firmware's command line letters are text, but the palette still opens there.
    key(&mut state, KeyCode::Char('5'));
    ctrl(&mut state, 'p');
    assert!(matches!(state.popups[..], [Popup::Palette(_)]));
}

#[test]
fn the_line_completes_remembers_and_leaves() {
    let mut state = ready();
    key(&mut state, KeyCode::Char(':'));
    type_text(&mut state, "turb");
    let shown = screen(&state);
    assert!(shown.contains("turbulence") && shown.contains(":turb"), "{shown}");
    key(&mut state, KeyCode::Tab);
    assert_eq!(state.command_line.field.value(), "turbulence ");
    type_text(&mut state, "se");
    key(&mut state, KeyCode::Tab);
    assert_eq!(state.command_line.field.value(), "turbulence severe");
    let effects = key(&mut state, KeyCode::Enter);
    assert!(matches!(&effects[..], [Effect::World(line)] if line == "turbulence=severe"));

    key(&mut state, KeyCode::Char(':'));
    key(&mut state, KeyCode::Up);
    assert_eq!(state.command_line.field.value(), "turbulence severe");
    key(&mut state, KeyCode::Down);
    assert_eq!(state.command_line.field.value(), "");
    type_text(&mut state, "set ap_pos");
    key(&mut state, KeyCode::Tab);
    assert_eq!(state.command_line.field.value(), "set ap_position_");
    key(&mut state, KeyCode::Esc);
    assert!(state.popups.is_empty());
    assert!(matches!(key(&mut state, KeyCode::Char(' '))[..], [Effect::Send(Command::Pause(true))]));
}

#[test]
fn lines_of_earlier_runs_are_recalled_and_new_ones_kept_for_the_next() {
    let entered = EnteredLines {
        commands: vec!["speed 4".to_owned(), "wind 5@270".to_owned()],
        cli: vec!["status".to_owned()],
        palette: Vec::new(),
    };
    let mut state = fixture::state_after((80, 24), fixture::colour(), fixture::square(), entered);
    key(&mut state, KeyCode::Char(':'));
    key(&mut state, KeyCode::Up);
    assert_eq!(state.command_line.field.value(), "wind 5@270");
    key(&mut state, KeyCode::Up);
    let kept = |state: &mut AppState| -> Vec<(LineField, String)> {
        let effects = update(state, Msg::Key(KeyEvent::new(KeyCode::Enter, KeyModifiers::NONE)));
        let kept = effects.into_iter().filter_map(|effect| match effect {
            Effect::Files(FileRequest::KeepLine(field, line)) => Some((field, line)),
            _ => None,
        });
        kept.collect()
    };
    assert_eq!(kept(&mut state), [(LineField::Command, "speed 4".to_owned())]);
    key(&mut state, KeyCode::Char('5'));
    key(&mut state, KeyCode::Up);
    assert_eq!(state.panels.cli.console.input.value(), "status");
    assert_eq!(kept(&mut state), [], "the same line again is one line");
    type_text(&mut state, "version");
    assert_eq!(kept(&mut state), [(LineField::Cli, "version".to_owned())]);
}

#[test]
fn a_wrong_word_says_what_was_meant_and_pasted_text_is_typed() {
    let mut state = ready();
    assert!(enter(&mut state, "flight.amr").is_empty());
    assert!(notice(&state).contains("did you mean flight.arm?"), "{}", notice(&state));
    key(&mut state, KeyCode::Char(':'));
    update(&mut state, Msg::Paste("speed 4\nspeed 8\n".to_owned()));
    let effects = key(&mut state, KeyCode::Enter);
    assert!(matches!(effects[..], [Effect::Send(Command::Speed(4.0))]), "the first line: {effects:?}");
}

#[test]
fn a_setting_goes_through_the_command_line_of_the_craft_and_its_answer_is_a_notice() {
    use betadeck::session::command::CliOutput;
    let mut state = ready();
    let effects = enter(&mut state, "set ap_max_angle=99");
    assert!(matches!(&effects[..], [Effect::Cli(line)] if line == "set ap_max_angle = 99"), "{effects:?}");
    let text = "###ERROR IN set: INVALID VALUE###\r\n".to_owned();
    update(&mut state, Msg::CliReply(Some(CliOutput { text, ..CliOutput::default() })));
    assert!(notice(&state).contains("INVALID VALUE"));
    // The reply to a line from the panel itself is shown only there.
    state.shared.notice = None;
    let effects = enter(&mut state, "cli status");
    assert!(
        matches!(&effects[..], [Effect::Cli(line)] if line == "status") && state.shared.focus == Panel::Cli
    );
    update(&mut state, Msg::CliReply(Some(CliOutput { text: "fine".to_owned(), ..CliOutput::default() })));
    assert_eq!(notice(&state), "");
}

#[test]
fn a_change_of_the_world_is_confirmed_or_refused_in_a_sentence() {
    let mut state = ready();
    enter(&mut state, "wind 5");
    let refused = Msg::WorldReply { line: "wind=5".to_owned(), result: Err("wind \"5\": no.".to_owned()) };
    update(&mut state, refused);
    assert!(notice(&state).contains("no."));
    update(&mut state, Msg::WorldReply { line: "wind=5@270".to_owned(), result: Ok(()) });
    assert!(notice(&state).contains("wind=5@270"));
}

#[test]
fn themes_change_at_once_but_not_against_no_color() {
    use betadeck::ui::theme::{Charset, Palette};
    let mut state = ready();
    enter(&mut state, "theme light");
    assert_eq!(state.shared.theme.palette, Palette::Light);
    enter(&mut state, "charset ascii");
    assert_eq!(state.shared.theme.charset, Charset::Ascii);
    state.shared.theme.no_colour = true;
    state.shared.theme.palette = Palette::Mono;
    enter(&mut state, "theme dark");
    assert_eq!(state.shared.theme.palette, Palette::Mono);
    assert!(notice(&state).contains("NO_COLOR"));
}

#[test]
fn the_line_and_the_palette_look_right_at_80x24() {
    let mut state = fixture::state((80, 24), fixture::colour());
    fixture::approach(&mut state);
    key(&mut state, KeyCode::Char(':'));
    type_text(&mut state, "turbulence ");
    insta::assert_snapshot!("command_line_80x24", screen(&state));
    key(&mut state, KeyCode::Esc);
    ctrl(&mut state, 'p');
    type_text(&mut state, "return home");
    insta::assert_snapshot!("palette_80x24", screen(&state));
}

#[test]
fn imperial_units_are_shown_and_nothing_else_changes() {
    let mut state = fixture::state((200, 60), fixture::colour());
    fixture::approach(&mut state);
    let metric = screen(&state);
    assert!(
        metric.contains("62.3 m ") && metric.contains("5.0 m/s") && metric.contains("┤ 20 m "),
        "{metric}"
    );
    assert!(enter(&mut state, "units imperial").is_empty());
    let shown = screen(&state);
    // 62.3 m, 5 m/s, 50.2 m; the guards and the scale of the map.
    for part in ["204.", " ft", "11.2 mph", "164.7 ft", "wind ↘  7.1 mph", "17.9 ft"] {
        assert!(shown.contains(part), "{part}\n{shown}");
    }
    assert!(!shown.contains("5.0 m/s") && !shown.contains(" m   N"), "{shown}");
    enter(&mut state, "units metric");
    assert_eq!(screen(&state), metric);
}

#[test]
fn the_log_of_the_flight_has_a_key_and_a_command_with_a_file() {
    let mut state = ready();
    let effects = key(&mut state, KeyCode::Char('X'));
    assert!(
        matches!(&effects[..], [Effect::WriteFlight { form: FlightForm::Log, file: None, .. }]),
        "{effects:?}"
    );
    let effects = enter(&mut state, "log mine.bbl");
    let [Effect::WriteFlight { form: FlightForm::Log, file: Some(file), .. }] = &effects[..] else {
        panic!("{effects:?}")
    };
    assert!(file.is_absolute() && file.ends_with("mine.bbl"), "{}", file.display());
    let result = Err("the craft was not armed in this flight.".to_owned());
    update(&mut state, Msg::FlightWritten { what: "log", result });
    assert_eq!(notice(&state), "No log was written: the craft was not armed in this flight.");
}
