//! The screen of a remote flight controller with a real craft: the actions that it offers, and its questions before a
//! change.

use crate::ui::fixture;
use crate::ui::hands::{key, mouse, press};
use betadeck::fc::{Access, NOTHING_MOVES, NOTHING_SIMULATED, RemoteState, RemoteView};
use betadeck::session::Command;
use betadeck::session::command::CliOutput;
use betadeck::telemetry::snapshot::ModeRange;
use betadeck::telemetry::{ArmingFlag, Mode};
use betadeck::ui::action::{Action, PanelAction};
use betadeck::ui::{AppState, Effect, Msg, Panel, draw, enabled, update};
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers, MouseEventKind};
use ratatui::Terminal;
use ratatui::backend::TestBackend;

fn remote() -> RemoteView {
    RemoteView {
        name: "serial:/dev/ttyACM0".to_owned(),
        state: RemoteState::Ready,
        access: Access::Reading,
        has_plans: true,
        knows_settings: true,
        opens_cli: false,
        in_cli: false,
        connection: 1,
        is_in_steps: false,
    }
}

/// Returns the screen of a disarmed craft. `change` sets up its remote flight controller.
fn connected(change: impl FnOnce(&mut RemoteView)) -> AppState {
    let mut state = fixture::state((80, 24), fixture::colour());
    show(&mut state, change);
    state
}

/// Shows the next picture, after `change` to its remote flight controller.
fn show(state: &mut AppState, change: impl FnOnce(&mut RemoteView)) {
    let mut view = state.shared.view.clone();
    let mut outside = view.remote.take().unwrap_or_else(remote);
    change(&mut outside);
    view.remote = Some(outside);
    view.timeline = None;
    let vehicle = std::sync::Arc::make_mut(&mut view.vehicle);
    vehicle.truth = None;
    vehicle.craft.armed = Some(false);
    vehicle.craft.gps_fix = Some(true);
    vehicle.craft.arming_blocked_by = Some(std::iter::once(ArmingFlag::RxLoss).collect());
    vehicle.craft.rc_source = None;
    update(state, Msg::View(view));
}

/// Enters a line in the CLI panel and returns the effects, except for requests to files.
fn enter(state: &mut AppState, line: &str) -> Vec<Effect> {
    state.shared.focus = Panel::Cli;
    state.shared.slots.visit(Panel::Cli);
    for c in line.chars() {
        press(state, c);
    }
    let mut effects = key(state, KeyCode::Enter);
    effects.retain(|effect| !matches!(effect, Effect::Files(_)));
    effects
}

fn answer(state: &mut AppState) -> Vec<Effect> {
    update(state, Msg::CliReply(Some(CliOutput::default())))
}

fn text(state: &AppState) -> String {
    let mut terminal =
        Terminal::new(TestBackend::new(state.shared.size.0, state.shared.size.1)).expect("a test terminal");
    terminal.draw(|frame| draw(state, frame)).expect("drawing in memory");
    terminal.backend().to_string()
}

fn is_asked(state: &AppState) -> bool {
    text(state).contains("Change the craft?")
}

#[test]
fn reading_is_free_and_a_change_is_asked_about_once() {
    let mut state = connected(|_| {});
    assert!(matches!(&enter(&mut state, "get ap_")[..], [Effect::Cli(line)] if line == "get ap_"));
    answer(&mut state);
    assert!(!is_asked(&state));

    assert!(enter(&mut state, "set ap_max_angle = 30").is_empty());
    insta::assert_snapshot!(text(&state));
    let effects = press(&mut state, 'y');
    assert!(
        matches!(
            &effects[..],
            [Effect::Send(Command::PermitChanges(1)), Effect::Cli(line)] if line == "set ap_max_angle = 30"
        ),
        "{effects:?}"
    );
    answer(&mut state);
    assert!(matches!(&enter(&mut state, "save")[..], [Effect::Cli(_)]), "before the session confirms");
    answer(&mut state);
    show(&mut state, |remote| remote.access = Access::Changing);
    assert!(matches!(&enter(&mut state, "save")[..], [Effect::Cli(_)]), "and after it");
    answer(&mut state);

    show(&mut state, |remote| (remote.access, remote.connection) = (Access::Reading, 2));
    assert!(enter(&mut state, "save").is_empty() && is_asked(&state), "a new connection asks again");
}

#[test]
fn an_upload_and_a_save_in_flash_ask_and_a_download_does_not() {
    for (key, asks) in [('U', true), ('W', true), ('D', false)] {
        let mut state = connected(|_| {});
        let effects = press(&mut state, key);
        assert_eq!((effects.is_empty(), is_asked(&state)), (asks, asks), "{key}: {effects:?}");
    }
}

#[test]
fn a_refusal_drops_what_was_kept_back_and_the_lines_after_it() {
    for leave in [KeyCode::Char('n'), KeyCode::Esc] {
        let mut state = connected(|_| {});
        state.shared.focus = Panel::Cli;
        state.shared.slots.visit(Panel::Cli);
        assert!(update(&mut state, Msg::Paste("set a = 1\nset b = 2\nsave\n".to_owned())).is_empty());
        assert!(key(&mut state, leave).is_empty());
        assert!(
            !is_asked(&state) && !state.panels.cli.console.waiting && state.panels.cli.console.queued() == 0
        );
        assert!(text(&state).contains("not run: changes were not permitted"), "{}", text(&state));
        assert!(matches!(&enter(&mut state, "status")[..], [Effect::Cli(_)]), "the panel goes on");
    }
}

#[test]
fn a_question_that_is_closed_otherwise_changes_nothing() {
    let ctrl_c = |state: &mut AppState| {
        update(state, Msg::Key(KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL)))
    };
    let renew = |state: &mut AppState| {
        show(state, |remote| remote.connection = 2);
        Vec::new()
    };
    for close in [ctrl_c as fn(&mut AppState) -> Vec<Effect>, renew] {
        let mut state = connected(|_| {});
        press(&mut state, 'U');
        assert!(is_asked(&state));
        assert!(close(&mut state).is_empty());
        assert!(!is_asked(&state) && state.permission.held.is_empty());
        assert!(press(&mut state, 'y').is_empty());
    }
}

#[test]
fn changes_are_permitted_ahead_by_a_command() {
    let mut state = connected(|_| {});
    assert_eq!(betadeck::ui::run_line(&mut state, "allow-changes").map(|effects| effects.len()), Ok(0));
    assert!(is_asked(&state));
    let effects = press(&mut state, 'y');
    assert!(matches!(effects[..], [Effect::Send(Command::PermitChanges(1))]), "{effects:?}");
}

#[test]
fn a_command_line_without_framing_is_opened_with_permission_and_a_warning() {
    let mut state = connected(|remote| remote.opens_cli = true);
    assert!(enter(&mut state, "get ap_").is_empty());
    let shown = text(&state);
    for part in ["opens the command line", "does not arm then", "restarts it"] {
        assert!(shown.contains(part), "{part}: {shown}");
    }
    press(&mut state, 'n');
    state.shared.focus = Panel::Map;
    assert!(press(&mut state, 'D').is_empty() && is_asked(&state));
    press(&mut state, 'n');
    show(&mut state, |remote| (remote.opens_cli, remote.in_cli) = (false, true));
    assert!(text(&state).contains("open: telemetry stops."), "{}", text(&state));
}

#[test]
fn nothing_moves_a_real_craft() {
    let state = connected(|remote| remote.access = Access::Changing);
    for moving in [
        Action::Fly,
        Action::Arm,
        Action::Throttle,
        Action::Autopilot,
        Action::ReturnHome,
        Action::GoTo,
        Action::HoldHere,
        Action::Resume,
        Action::CutRc,
        Action::Panel(PanelAction::Raise),
        Action::Panel(PanelAction::LowerMuch),
        Action::Panel(PanelAction::Flip),
        Action::Panel(PanelAction::Play),
    ] {
        assert_eq!(enabled(&state.shared, moving), Err(NOTHING_MOVES.to_owned()), "{moving:?}");
    }
    for simulated in
        [Action::ResetCraft, Action::Panel(PanelAction::KnobMore), Action::Panel(PanelAction::KnobEdit)]
    {
        assert_eq!(enabled(&state.shared, simulated), Err(NOTHING_SIMULATED.to_owned()), "{simulated:?}");
    }
    for other in [
        Action::Pause,
        Action::Step,
        Action::Faster,
        Action::Earlier,
        Action::FlyOn,
        Action::LookAhead,
        Action::WhatIf,
        Action::AllowChanges,
    ] {
        assert!(enabled(&state.shared, other).is_err(), "{other:?}");
    }
    for free in [Action::Upload, Action::Show(Panel::Cli), Action::Zoom, Action::Quit] {
        assert_eq!(enabled(&state.shared, free), Ok(()), "{free:?}");
    }
}

#[test]
fn the_screen_says_how_the_connection_is() {
    for (now, parts) in [
        (RemoteState::Connecting, &["No connection to", "serial:/dev/ttyACM0 yet", "plug it in"][..]),
        (RemoteState::Identifying, &["is being identified"]),
        (RemoteState::Lost, &["is lost", "reconnecting"]),
        (RemoteState::Unusable("It says INAV.".to_owned()), &["It says INAV.", "--connect"]),
        (RemoteState::Ready, &["Arming is blocked", "RXLOSS"]),
    ] {
        let mut state = connected(|remote| remote.state = now.clone());
        update(&mut state, Msg::Resize(120, 40));
        let shown = text(&state).replace(['\n', '│', '"'], " ");
        let words: Vec<&str> = shown.split_whitespace().collect();
        let shown = words.join(" ");
        for part in parts {
            let found = part.split(' ').all(|word| shown.contains(word));
            assert!(found, "{now:?}, {part}: {shown}");
        }
        assert!(!shown.contains("F fly") && !shown.contains("a arm"), "{shown}");
    }
}

#[test]
fn a_firmware_without_plans_says_so() {
    let state = connected(|remote| remote.has_plans = false);
    let refusal = enabled(&state.shared, Action::Upload).unwrap_err();
    assert!(
        refusal.contains("has no waypoints") && refusal.contains("today's master has flight plans"),
        "{refusal}"
    );
}

#[test]
fn over_a_simulated_craft_with_a_remote_firmware_only_what_can_work_is_offered() {
    let flying = |change: fn(&mut RemoteView)| {
        connected(|remote| {
            remote.access = Access::Everything;
            change(remote);
        })
    };
    let state = flying(|_| {});
    for action in [Action::GoTo, Action::HoldHere, Action::Resume] {
        let why = enabled(&state.shared, action).unwrap_err();
        assert!(why.contains("takes no such order"), "{action:?}: {why}");
    }
    assert_eq!(enabled(&state.shared, Action::Fly), Ok(()));
    for (change, reason) in [
        ((|remote| remote.state = RemoteState::Identifying) as fn(&mut RemoteView), "wait until it answers"),
        (|remote| remote.has_plans = false, "has no waypoints"),
    ] {
        let why = enabled(&flying(change).shared, Action::Fly).unwrap_err();
        assert!(why.contains(reason), "{why}");
    }
}

#[test]
fn a_plan_that_the_remote_firmware_has_not_reported_is_not_flown_unseen() {
    let mut state = connected(|remote| remote.access = Access::Everything);
    let mut view = state.shared.view.clone();
    std::sync::Arc::make_mut(&mut view.vehicle).stored_plan = None;
    update(&mut state, Msg::View(view));
    let effects = press(&mut state, 'F');
    assert!(effects.iter().any(|effect| matches!(effect, Effect::Upload { .. })), "{effects:?}");
}

/// Returns the screen of a child that is simulated here, with the switches of these modes.
fn child(armed: bool, modes: &[Mode]) -> AppState {
    let mut state = connected(|remote| remote.access = Access::Everything);
    let mut view = state.shared.view.clone();
    let craft = &mut std::sync::Arc::make_mut(&mut view.vehicle).craft;
    let range = |(at, mode): (usize, &Mode)| ModeRange {
        mode_box: (*mode).into(),
        channel: 4 + at as u8,
        start_us: 1700,
        end_us: 2100,
    };
    craft.mode_ranges = Some(modes.iter().enumerate().map(range).collect());
    craft.armed = Some(armed);
    if armed {
        craft.home = Some(betadeck::geo::LatLon::default());
    }
    craft.arming_blocked_by = Some(std::iter::empty::<ArmingFlag>().collect());
    update(&mut state, Msg::View(view));
    state
}

#[test]
fn a_child_is_ready_only_with_a_switch_that_arms_it() {
    let shown = text(&child(false, &[Mode::Arm, Mode::Autopilot]));
    assert!(shown.contains("Ready."), "{shown}");
    let shown = text(&child(false, &[Mode::Autopilot]));
    assert!(shown.contains("No switch arms") && !shown.contains("Ready."), "{shown}");
}

#[test]
fn a_child_is_brought_home_only_with_a_switch_for_it() {
    let can_return = |modes: &[Mode]| enabled(&child(true, modes).shared, Action::ReturnHome);
    let why = can_return(&[Mode::Arm, Mode::Autopilot]).unwrap_err();
    assert!(why.contains("GPS RESCUE"), "{why}");
    assert_eq!(can_return(&[Mode::Arm, Mode::Autopilot, Mode::GpsRescue]), Ok(()));
}

#[test]
fn f_over_a_real_craft_asks_for_no_plan_and_sends_nothing() {
    let mut state = connected(|_| {});
    for key in ['2', '+'] {
        press(&mut state, key);
    }
    assert!(press(&mut state, 'F').is_empty());
    assert!(!text(&state).contains("Fly which plan?") && !is_asked(&state), "{}", text(&state));
    assert!(text(&state).contains("This craft is real"), "{}", text(&state));
}

#[test]
fn keys_after_the_settings_panel_wait_until_the_craft_has_told_its_settings() {
    let mut state = connected(|_| {});
    let asked = press(&mut state, '9');
    assert!(matches!(asked[..], [Effect::ReadSettings]), "{asked:?}");
    for key in ['/', 'f', 'e', 'n'] {
        assert!(press(&mut state, key).is_empty(), "{key} waits");
    }
    let read = betadeck::fc::CraftSettings::from_configuration(
        &betadeck::firmware::config::Configuration::default(),
        None,
    );
    update(&mut state, Msg::SettingsReply(Ok(Box::new(read.clone()))));
    let seen = text(&state);
    assert!(seen.contains("fen") && seen.contains("geofence"), "{seen}");
    // Esc is not kept waiting, and takes back what waits.
    let mut state = connected(|_| {});
    for key in ['9', '/', 'f'] {
        press(&mut state, key);
    }
    key(&mut state, KeyCode::Esc);
    update(&mut state, Msg::SettingsReply(Ok(Box::new(read))));
    assert!(!text(&state).contains("/f"), "{}", text(&state));
}

#[test]
fn keys_that_wait_for_the_settings_are_dropped_if_a_click_has_shown_another_panel() {
    let read = betadeck::fc::CraftSettings::from_configuration(
        &betadeck::firmware::config::Configuration::default(),
        None,
    );
    for (cell, focus) in [(None, Panel::Settings), (Some((10, 10)), Panel::Map)] {
        let mut state = connected(|_| {});
        update(&mut state, Msg::Resize(120, 40));
        for key in ['9', '/', 'f'] {
            press(&mut state, key);
        }
        if let Some(cell) = cell {
            mouse(&mut state, MouseEventKind::Down, cell);
        }
        assert_eq!(state.shared.focus, focus);
        let mode = format!("{:?}", state.shared.map.mode);
        update(&mut state, Msg::SettingsReply(Ok(Box::new(read.clone()))));
        assert_eq!(text(&state).contains("/f"), cell.is_none(), "{}", text(&state));
        assert_eq!(format!("{:?}", state.shared.map.mode), mode, "`f` was not typed for the map");
        assert!(state.shared.focus == focus && state.waiting_keys.is_empty());
    }
}
