//! The effects of keys, mouse and paste: messages in, effects out, no terminal.

use std::time::Duration;

use betadeck::fc::UploadReport;
use betadeck::session::Command;
use betadeck::session::command::CliOutput;
use betadeck::ui::files::FileRequest;
use betadeck::ui::keymap::KeyPress;
use betadeck::ui::{AppState, Effect, MapMode, Msg, Panel, Popup, screen_layout, update};
use betadeck::vehicle::VehicleCommand;
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers, MouseButton, MouseEvent, MouseEventKind};

use crate::ui::fixture;
use crate::ui::fixture::SimpleFlight;
use crate::ui::hands::screen;

fn key(state: &mut AppState, code: KeyCode) -> Vec<Effect> {
    let mut effects = update(state, Msg::Key(KeyEvent::new(code, KeyModifiers::NONE)));
    // Lines stored for the next start have their own test.
    effects.retain(|effect| !matches!(effect, Effect::Files(FileRequest::KeepLine(..))));
    effects
}

fn press(state: &mut AppState, c: char) -> Vec<Effect> {
    key(state, KeyCode::Char(c))
}

fn ctrl_c(state: &mut AppState) -> Vec<Effect> {
    update(state, Msg::Key(KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL)))
}

fn ready() -> AppState {
    let mut state = fixture::state((120, 40), fixture::colour());
    update(
        &mut state,
        Msg::View(fixture::view(&SimpleFlight { time_s: 8.0, fix: true, ..SimpleFlight::default() })),
    );
    state
}

/// Returns the channels of the sticks that the effects send, if there are any.
fn sticks(effects: &[Effect]) -> Option<[u16; 16]> {
    effects.iter().find_map(|effect| match effect {
        Effect::Send(Command::Vehicle(VehicleCommand::Sticks(frame))) => Some(frame.channels),
        _ => None,
    })
}

#[test]
fn arm_throttle_and_autopilot_move_the_channels_of_the_mode_conditions() {
    let mut state = ready();
    assert_eq!(sticks(&press(&mut state, 'a')).map(|c| c[4]), Some(1900));
    let after_throttle = sticks(&press(&mut state, 't')).expect("sticks");
    assert_eq!((after_throttle[2], after_throttle[4]), (1500, 1900), "the arm switch stays on");
    assert_eq!(after_throttle[6], 1900, "the throttle brings the hold modes");
    assert_eq!(sticks(&press(&mut state, 'g')).map(|c| (c[5], c[6])), Some((1900, 1900)));
    assert_eq!(sticks(&press(&mut state, 'g')).map(|c| (c[5], c[6])), Some((1000, 1900)));
    assert_eq!(sticks(&press(&mut state, 't')).map(|c| (c[2], c[6])), Some((1000, 1000)), "on the ground");
}

#[test]
fn arming_too_early_moves_nothing_and_says_why() {
    let mut state = fixture::state((120, 40), fixture::colour());
    assert!(press(&mut state, 'a').is_empty());
    let notice = state.shared.notice.as_ref().map(|notice| notice.text.clone()).unwrap_or_default();
    assert!(notice.contains("BOOTGRACE") && notice.contains("wait"), "{notice}");
}

#[test]
fn f_uploads_first_when_the_craft_has_no_plan_and_stops_the_pilot_when_it_flies() {
    let mut state = ready();
    assert!(matches!(press(&mut state, 'F')[..], [Effect::Send(Command::StartPilot)]));

    let mut view = state.shared.view.clone();
    std::sync::Arc::make_mut(&mut view.vehicle).stored_plan.as_mut().unwrap().waypoints.clear();
    update(&mut state, Msg::View(view.clone()));
    let [Effect::Upload { id, plan, .. }] = &press(&mut state, 'F')[..] else { panic!("an upload first") };
    assert_eq!(plan.waypoints.len(), 4);
    let effects =
        update(&mut state, Msg::UploadReply { id: *id, count: 4, result: Ok(UploadReport::default()) });
    assert!(matches!(effects[..], [Effect::Send(Command::StartPilot)]));

    view.pilot = Some("climbing");
    update(&mut state, Msg::View(view));
    assert!(matches!(
        press(&mut state, 'F')[..],
        [Effect::Send(Command::Vehicle(VehicleCommand::StopPilot))]
    ));
}

#[test]
fn a_refused_upload_does_not_fly() {
    let mut state = ready();
    std::sync::Arc::make_mut(&mut state.shared.view.vehicle).stored_plan.as_mut().unwrap().waypoints.clear();
    press(&mut state, 'F');
    let id = state.shared.editor.plan().id();
    let refused = Msg::UploadReply { id, count: 4, result: Err("WP1 is invalid.".to_owned()) };
    assert!(update(&mut state, refused).is_empty());
    assert!(state.shared.notice.is_some_and(|notice| notice.text.contains("WP1 is invalid.")));
}

#[test]
fn the_hand_takes_over_from_the_pilot() {
    let mut state = ready();
    state.shared.view.pilot = Some("climbing");
    let effects = press(&mut state, 't');
    assert!(matches!(effects[0], Effect::Send(Command::Vehicle(VehicleCommand::StopPilot))));
    assert!(sticks(&effects).is_some());
}

#[test]
fn a_second_press_of_a_speed_key_counts_from_the_first_whatever_is_on_its_way() {
    let mut state = fixture::state((120, 40), fixture::colour());
    let before = state.shared.view.clone();
    let asked = |effects: &[Effect]| {
        effects.iter().find_map(|effect| match effect {
            Effect::Send(Command::Speed(factor)) => Some(*factor),
            _ => None,
        })
    };
    assert_eq!(asked(&press(&mut state, ']')), Some(2.0));
    // A picture of before the request.
    update(&mut state, Msg::View(before.clone()));
    assert_eq!(asked(&press(&mut state, ']')), Some(4.0));
    // A session that does not follow has the last word.
    update(&mut state, Msg::Clock(Duration::from_secs(5)));
    update(&mut state, Msg::View(before));
    assert_eq!(asked(&press(&mut state, ']')), Some(2.0));
}

#[test]
fn time_keys_pause_step_and_change_speed() {
    let mut state = ready();
    assert!(matches!(press(&mut state, ' ')[..], [Effect::Send(Command::Pause(true))]));
    assert!(matches!(
        press(&mut state, '.')[..],
        [Effect::Send(Command::Pause(true)), Effect::Send(Command::Step(10))]
    ));
    let speed = |effects: &[Effect]| match effects {
        [Effect::Send(Command::Speed(speed))] => *speed,
        other => panic!("a speed expected, got {other:?}"),
    };
    for wanted in [2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0, f64::INFINITY] {
        assert_eq!(speed(&press(&mut state, ']')), wanted);
    }
    assert!(press(&mut state, ']').is_empty(), "nothing is faster than as fast as possible");
    assert_eq!(speed(&press(&mut state, '[')), 128.0);
    assert_eq!(speed(&press(&mut state, '\\')), 1.0);
}

#[test]
fn one_key_commands() {
    let mut state = ready();
    assert!(matches!(
        press(&mut state, 'x')[..],
        [Effect::Send(Command::Vehicle(VehicleCommand::CutRc(true)))]
    ));
    assert!(matches!(
        press(&mut state, 'R')[..],
        [Effect::Send(Command::Vehicle(VehicleCommand::ResetCraft))]
    ));
    assert!(matches!(press(&mut state, 'U')[..], [Effect::Upload { .. }]));
    assert!(press(&mut state, 'H').is_empty(), "nothing to bring home while disarmed");
    fixture::approach(&mut state);
    assert!(matches!(
        press(&mut state, 'H').last(),
        Some(Effect::Send(Command::Vehicle(VehicleCommand::ReturnHome)))
    ));
    std::sync::Arc::make_mut(&mut state.shared.view.vehicle).craft.commanded = Some(true);
    assert!(matches!(
        press(&mut state, 'H')[..],
        [Effect::Send(Command::Vehicle(VehicleCommand::CancelReturn))]
    ));
}

#[test]
fn the_throttle_key_is_refused_while_the_autopilot_flies() {
    let mut state = ready();
    fixture::approach(&mut state);
    assert!(press(&mut state, 't').is_empty(), "later the stick would take the craft by surprise");
    assert!(
        state.shared.notice.as_ref().is_some_and(|notice| notice.text.contains("`g`")),
        "{:?}",
        state.shared.notice
    );
}

#[test]
fn scrolling_ends_where_the_oldest_line_is_visible_and_turns_at_once() {
    let mut state = ready();
    press(&mut state, '8');
    let long = "a sentence that is longer than the panel is wide, so that it takes several rows of it";
    for line in 0..40 {
        state.shared.notify(betadeck::ui::Severity::Info, format!("{line} {long}"));
    }
    key(&mut state, KeyCode::End);
    let end = state.panels.log.view.scroll;
    assert!(end > 30, "{end}");
    press(&mut state, 'j');
    assert_eq!(state.panels.log.view.scroll, end, "there is no more");
    press(&mut state, 'k');
    assert_eq!(state.panels.log.view.scroll, end - 1);
    key(&mut state, KeyCode::Home);
    assert_eq!(state.panels.log.view.scroll, 0);
}

#[test]
fn q_asks_while_armed_and_only_then() {
    let mut state = ready();
    assert!(matches!(press(&mut state, 'q')[..], [Effect::Quit]));
    fixture::approach(&mut state);
    assert!(press(&mut state, 'q').is_empty());
    assert_eq!(state.popups, [Popup::Quit]);
    assert!(press(&mut state, 'a').is_empty(), "the question hears keys first");
    press(&mut state, 'n');
    assert!(state.popups.is_empty());
    press(&mut state, 'q');
    assert!(matches!(press(&mut state, 'y')[..], [Effect::Quit]));
}

#[test]
fn ctrl_c_cancels_once_and_quits_twice_within_two_seconds() {
    let mut state = ready();
    fixture::approach(&mut state);
    press(&mut state, '5');
    for c in "set x".chars() {
        press(&mut state, c);
    }
    let at = |state: &mut AppState, ms| {
        update(state, Msg::Clock(Duration::from_millis(ms)));
    };
    at(&mut state, 100_000);
    assert!(ctrl_c(&mut state).is_empty());
    assert_eq!(state.panels.cli.console.input.value(), "");
    at(&mut state, 103_000);
    assert!(ctrl_c(&mut state).is_empty(), "too late for the second");
    at(&mut state, 104_000);
    assert!(matches!(ctrl_c(&mut state)[..], [Effect::Quit]), "even while armed");
}

#[test]
fn in_the_cli_letters_are_text_until_esc() {
    let mut state = ready();
    press(&mut state, '5');
    for c in "save".chars() {
        assert!(press(&mut state, c).is_empty());
    }
    let effects = key(&mut state, KeyCode::Enter);
    assert!(matches!(&effects[..], [Effect::Cli(line)] if line == "save"));
    let output = CliOutput { text: "Saving\r\n".to_owned(), advice: None, restarted: true };
    assert!(update(&mut state, Msg::CliReply(Some(output))).is_empty());
    key(&mut state, KeyCode::Esc);
    assert_eq!(state.shared.focus, Panel::Map);
    assert!(matches!(press(&mut state, ' ')[..], [Effect::Send(Command::Pause(true))]));
}

#[test]
fn tab_completes_in_the_cli_and_moves_on_when_there_is_nothing_to_complete() {
    let mut state = ready();
    press(&mut state, '5');
    for c in "set ap_po".chars() {
        press(&mut state, c);
    }
    key(&mut state, KeyCode::Tab);
    assert_eq!(state.panels.cli.console.input.value(), "set ap_position_");
    ctrl_c(&mut state);
    key(&mut state, KeyCode::Tab);
    assert_eq!(state.shared.focus, Panel::Graphs);
}

#[test]
fn pasted_lines_run_one_at_a_time() {
    let mut state = ready();
    press(&mut state, '5');
    let effects = update(&mut state, Msg::Paste("set a = 1\nset b = 2\n".to_owned()));
    assert!(matches!(&effects[..], [Effect::Cli(line)] if line == "set a = 1"));
    let effects = update(&mut state, Msg::CliReply(Some(CliOutput::default())));
    assert!(matches!(&effects[..], [Effect::Cli(line)] if line == "set b = 2"));
    assert!(update(&mut state, Msg::CliReply(Some(CliOutput::default()))).is_empty());
}

#[test]
fn tab_goes_through_all_panels_and_back() {
    let mut state = ready();
    let mut seen = Vec::new();
    for _ in Panel::ALL {
        seen.push(state.shared.focus);
        assert!(
            screen_layout::screen(&state.shared)
                .is_some_and(|screen| screen.panel(state.shared.focus).is_some()),
            "visible"
        );
        key(&mut state, KeyCode::Tab);
    }
    assert_eq!(seen, Panel::ALL);
    key(&mut state, KeyCode::BackTab);
    assert_eq!(state.shared.focus, Panel::Settings);
}

#[test]
fn the_map_pans_zooms_follows_and_fits() {
    let mut state = ready();
    fixture::approach(&mut state);
    key(&mut state, KeyCode::Left);
    let MapMode::Free { e: first, .. } = state.shared.map.mode else { panic!("panned") };
    press(&mut state, 'h');
    let MapMode::Free { e: second, scale: before, .. } = state.shared.map.mode else { panic!("panned") };
    assert!(second < first, "left is west");
    press(&mut state, '+');
    let (MapMode::Near { scale, .. } | MapMode::Free { scale, .. }) = state.shared.map.mode else {
        panic!("zoomed")
    };
    assert!(scale < before);
    press(&mut state, 'f');
    assert!(matches!(state.shared.map.mode, MapMode::Follow(_)));
    press(&mut state, '0');
    assert_eq!(state.shared.map.mode, MapMode::Fit);
}

#[test]
fn the_mouse_sets_a_channel_and_drags_the_map() {
    let mut state = ready();
    press(&mut state, '4');
    let area =
        screen_layout::screen(&state.shared).and_then(|screen| screen.panel(Panel::Rc)).expect("visible");
    let at = |kind, column, row| Msg::Mouse(MouseEvent { kind, column, row, modifiers: KeyModifiers::NONE });
    let down = MouseEventKind::Down(MouseButton::Left);
    let effects = update(&mut state, at(down, area.x + 25, area.y + 2));
    let channels = sticks(&effects).expect("a click on a bar sets the channel");
    assert_ne!(channels[1], 1500);

    let area =
        screen_layout::screen(&state.shared).and_then(|screen| screen.panel(Panel::Map)).expect("visible");
    update(&mut state, at(down, area.x + 10, area.y + 10));
    update(&mut state, at(MouseEventKind::Drag(MouseButton::Left), area.x + 14, area.y + 10));
    assert!(matches!(state.shared.map.mode, MapMode::Free { .. }));
}

#[test]
fn a_drag_that_strays_from_the_map_over_the_sliders_moves_no_stick() {
    let mut state = ready();
    press(&mut state, '4');
    let place =
        |panel| screen_layout::screen(&state.shared).and_then(|screen| screen.panel(panel)).expect("visible");
    let (map, rc) = (place(Panel::Map), place(Panel::Rc));
    let at = |kind, column, row| Msg::Mouse(MouseEvent { kind, column, row, modifiers: KeyModifiers::NONE });
    let (down, drag) = (MouseEventKind::Down(MouseButton::Left), MouseEventKind::Drag(MouseButton::Left));
    update(&mut state, at(down, map.x + 10, map.y + 10));
    for row in rc.y + 1..rc.y + rc.height - 1 {
        assert!(update(&mut state, at(drag, rc.x + 25, row)).is_empty(), "row {row}");
    }
    update(&mut state, at(MouseEventKind::Up(MouseButton::Left), rc.x + 25, rc.y + 3));
    assert!(update(&mut state, at(drag, rc.x + 25, rc.y + 3)).is_empty(), "nothing is pressed");
}

#[test]
fn a_dragged_slider_stays_the_one_that_was_pressed() {
    let mut state = ready();
    press(&mut state, '4');
    let rc =
        screen_layout::screen(&state.shared).and_then(|screen| screen.panel(Panel::Rc)).expect("visible");
    let at = |kind, column, row| Msg::Mouse(MouseEvent { kind, column, row, modifiers: KeyModifiers::NONE });
    let (down, drag) = (MouseEventKind::Down(MouseButton::Left), MouseEventKind::Drag(MouseButton::Left));
    state.panels.rc.channel = 15;
    let row = rc.y + 2;
    let pressed = sticks(&update(&mut state, at(down, rc.x + 25, row))).expect("a slider");
    let channel = state.panels.rc.channel;
    let dragged = sticks(&update(&mut state, at(drag, rc.x + 27, row + 1))).expect("the slider");
    assert_eq!(state.panels.rc.channel, channel);
    let moved: Vec<usize> = (0..16).filter(|&at| dragged[at] != pressed[at]).collect();
    assert_eq!(moved, [channel]);
}

#[test]
fn help_closes_by_the_key_it_explains() {
    let mut state = ready();
    press(&mut state, '?');
    assert!(matches!(state.popups[..], [Popup::Help(_)]));
    assert!(matches!(press(&mut state, ' ')[..], []), "blank scrolls");
    assert!(matches!(
        press(&mut state, 'x')[..],
        [Effect::Send(Command::Vehicle(VehicleCommand::CutRc(true)))]
    ));
    assert!(state.popups.is_empty());
}

#[test]
fn z_zooms_the_focused_panel_and_esc_ends_it() {
    let mut state = ready();
    press(&mut state, 'z');
    let screen = screen_layout::screen(&state.shared).expect("large enough");
    assert_eq!(screen.panels.len(), 1);
    key(&mut state, KeyCode::Esc);
    assert!(screen_layout::screen(&state.shared).is_some_and(|screen| screen.panels.len() > 1));
}

#[test]
fn a_key_draws_the_whole_screen_again_wherever_one_is() {
    for before in ["", "5", ":", "?", "G"] {
        let mut state = ready();
        for c in before.chars() {
            press(&mut state, c);
        }
        let effects = update(&mut state, Msg::Key(KeyEvent::new(KeyCode::Char('r'), KeyModifiers::ALT)));
        assert!(matches!(effects[..], [Effect::Redraw]), "{before}: {effects:?}");
    }
}

#[test]
fn the_cli_panel_zooms_by_the_key_of_its_hint_and_esc_returns_to_the_panel_before() {
    let mut state = ready();
    for panel in ['3', '8'] {
        press(&mut state, panel);
        let before = state.shared.focus;
        press(&mut state, '5');
        assert!(screen(&state).contains("Alt-z zoom"), "{}", screen(&state));
        let alt_z = KeyEvent::new(KeyCode::Char('z'), KeyModifiers::ALT);
        for zoomed in [true, false] {
            update(&mut state, Msg::Key(alt_z));
            assert_eq!((state.shared.zoomed, state.shared.focus), (zoomed, Panel::Cli));
        }
        press(&mut state, 'z');
        assert_eq!((state.panels.cli.console.input.value(), state.shared.zoomed), ("z", false), "text");
        key(&mut state, KeyCode::Backspace);
        key(&mut state, KeyCode::Esc);
        assert_eq!(state.shared.focus, before);
    }
}

#[test]
fn esc_in_the_zoomed_cli_leaves_the_text_first() {
    let mut state = ready();
    press(&mut state, 'z');
    press(&mut state, '5');
    key(&mut state, KeyCode::Esc);
    assert!(!state.shared.focus.takes_text());
    assert!(
        matches!(press(&mut state, ' ')[..], [Effect::Send(Command::Pause(true))]),
        "keys are keys again"
    );
    key(&mut state, KeyCode::Esc);
    assert!(!state.shared.zoomed);
}

#[test]
fn a_crashed_craft_is_not_flown_but_reset() {
    let mut state = ready();
    let vehicle = std::sync::Arc::make_mut(&mut state.shared.view.vehicle);
    vehicle.truth.as_mut().expect("the fixture tells the truth").crashed = true;
    assert!(press(&mut state, 'F').is_empty());
    assert!(
        state.shared.notice.as_ref().is_some_and(|notice| notice.text.contains("`R`")),
        "{:?}",
        state.shared.notice
    );
    assert!(matches!(
        press(&mut state, 'R')[..],
        [Effect::Send(Command::Vehicle(VehicleCommand::ResetCraft))]
    ));
}

#[test]
fn keys_that_mean_nothing_do_nothing() {
    let mut state = ready();
    for text in ["y", "ctrl-x", "f12", "alt-a"] {
        assert!(KeyPress::parse(text).is_some());
    }
    assert!(press(&mut state, 'y').is_empty());
    assert!(update(&mut state, Msg::Key(KeyEvent::new(KeyCode::F(12), KeyModifiers::NONE))).is_empty());
    assert!(update(&mut state, Msg::Key(KeyEvent::new(KeyCode::Char('a'), KeyModifiers::ALT))).is_empty());
}
