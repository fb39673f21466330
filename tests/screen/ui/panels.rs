//! The panels World, Log, Graphs and RC: their keys, and their looks at several sizes.

use crate::ui::fixture;
use crate::ui::hands::{key, press, screen};
use betadeck::session::SessionView;
use betadeck::telemetry::snapshot::{FaultView, WindView};
use betadeck::telemetry::{FaultKind, FaultValue, Turbulence};
use betadeck::ui::{AppState, Effect, Msg, Panel, Severity, draw, update};
use betadeck::vehicle::VehicleCommand;
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use ratatui::Terminal;
use ratatui::backend::TestBackend;

/// The sizes that the layouts are designed for.
const SIZES: [(u16, u16); 4] = [(60, 20), (80, 24), (120, 40), (200, 60)];

fn type_text(state: &mut AppState, text: &str) {
    for c in text.chars() {
        assert!(press(state, c).is_empty(), "{c} of {text} is text");
    }
}

/// Returns the requests to the world among the effects.
fn asked(effects: &[Effect]) -> Vec<&str> {
    // The plan is flown ahead again in the requested air.
    let others = effects.iter().filter(|effect| !matches!(effect, Effect::World(_) | Effect::Forecast(_)));
    assert_eq!(others.count(), 0, "{effects:?}");
    effects
        .iter()
        .filter_map(|effect| if let Effect::World(line) = effect { Some(line.as_str()) } else { None })
        .collect()
}

fn windy(size: (u16, u16)) -> AppState {
    let mut state = fixture::state(size, fixture::colour());
    fixture::approach(&mut state);
    let mut view: SessionView = state.shared.view.clone();
    let world = &mut std::sync::Arc::make_mut(&mut view.vehicle).world;
    world.airframe = "iris".to_owned();
    world.wind = Some(WindView { speed_mps: 3.0, from_deg: 270.0 });
    world.turbulence = Turbulence::Light;
    world.noise = true;
    world.faults = vec![FaultView { kind: FaultKind::GpsLoss, value: FaultValue::None, left_s: Some(4.2) }];
    update(&mut state, Msg::View(view));
    press(&mut state, '7');
    state
}

#[test]
fn arrows_turn_the_knobs_of_the_air_and_count_from_what_was_asked_for() {
    let mut state = windy((120, 40));
    assert_eq!(state.shared.focus, Panel::World);
    assert_eq!(asked(&key(&mut state, KeyCode::Right)), ["wind=3.5@270"]);
    assert_eq!(asked(&key(&mut state, KeyCode::Right)), ["wind=4@270"]);
    press(&mut state, 'j');
    assert_eq!(asked(&key(&mut state, KeyCode::Left)), ["wind=4@255"]);
    press(&mut state, 'j');
    assert_eq!(asked(&key(&mut state, KeyCode::Left)), ["gust=0"], "not below nothing");
    press(&mut state, 'j');
    assert_eq!(asked(&key(&mut state, KeyCode::Enter)), ["turbulence=moderate"]);
    press(&mut state, 'j');
    assert_eq!(asked(&key(&mut state, KeyCode::Enter)), ["noise=none"]);
    assert_eq!(asked(&key(&mut state, KeyCode::Delete)), ["noise=real"]);
    assert!(key(&mut state, KeyCode::Delete).is_empty(), "it is at its default");
}

#[test]
fn numbers_are_typed_in_the_units_that_are_shown() {
    let mut state = windy((120, 40));
    assert!(key(&mut state, KeyCode::Enter).is_empty());
    type_text(&mut state, "7.5");
    assert!(screen(&state).contains("wind speed     7.5"), "{}", screen(&state));
    assert_eq!(asked(&key(&mut state, KeyCode::Enter)), ["wind=7.5@270"]);
    state.shared.units = betadeck::ui::Units::Imperial;
    key(&mut state, KeyCode::Enter);
    type_text(&mut state, "10");
    assert_eq!(asked(&key(&mut state, KeyCode::Enter)), ["wind=4.47@270"]);
    // A text that is not a number is passed on, because the world reports the reason for a refusal.
    key(&mut state, KeyCode::Enter);
    type_text(&mut state, "calm");
    assert_eq!(asked(&key(&mut state, KeyCode::Enter)), ["wind=calm"]);
    key(&mut state, KeyCode::Enter);
    type_text(&mut state, "q");
    key(&mut state, KeyCode::Esc);
    assert!(state.panels.world.knobs.field.is_none() && state.shared.focus == Panel::World);
}

/// Moves the selection to the fault of this name.
fn select(state: &mut AppState, name: &str) {
    for _ in 0..40 {
        if screen(state).contains(&format!("▸  {name}")) || screen(state).contains(&format!("▸▲ {name}"))
        {
            return;
        }
        key(state, KeyCode::Down);
    }
    panic!("no {name}\n{}", screen(state));
}

#[test]
fn faults_begin_and_end_with_their_values() {
    let mut state = windy((120, 40));
    select(&mut state, "gps-loss");
    assert!(screen(&state).contains("on for 4.2 s"), "{}", screen(&state));
    assert_eq!(asked(&key(&mut state, KeyCode::Enter)), ["end=gps-loss"]);
    select(&mut state, "motor");
    assert_eq!(asked(&key(&mut state, KeyCode::Right)), ["fault=motor"]);
    press(&mut state, '=');
    type_text(&mut state, "5,2:0.7");
    assert_eq!(asked(&key(&mut state, KeyCode::Enter)), ["fault=motor,5,2:0.7"]);
    select(&mut state, "payload");
    assert!(key(&mut state, KeyCode::Enter).is_empty(), "it needs a value");
    type_text(&mut state, "0.3");
    assert_eq!(asked(&key(&mut state, KeyCode::Enter)), ["fault=payload,,0.3"]);
}

#[test]
fn ctrl_c_takes_back_what_is_typed() {
    let mut state = windy((120, 40));
    key(&mut state, KeyCode::Enter);
    type_text(&mut state, "99");
    update(&mut state, Msg::Key(KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL)));
    assert!(state.panels.world.knobs.field.is_none());
    assert!(state.shared.notice.is_some_and(|notice| notice.text.starts_with("Cancelled.")));
}

#[test]
fn the_log_is_searched_and_filtered_by_keys() {
    let mut state = fixture::state((120, 40), fixture::colour());
    fixture::approach(&mut state);
    state.shared.notify(Severity::Warn, "the wind grows");
    state.shared.notify(Severity::Info, "nothing of note");
    press(&mut state, '8');
    press(&mut state, '/');
    type_text(&mut state, "wind");
    key(&mut state, KeyCode::Enter);
    assert!(screen(&state).contains("8 Log — /wind"), "{}", screen(&state));
    press(&mut state, 'n');
    assert!(state.shared.notice.as_ref().is_some_and(|notice| notice.text.contains("No older line")));
    press(&mut state, 'f');
    let shown = screen(&state);
    assert!(shown.contains("warnings and faults") && !shown.contains("nothing of note"), "{shown}");
    key(&mut state, KeyCode::Esc);
    assert!(!screen(&state).contains("/wind"));
    assert_eq!(state.shared.focus, Panel::Log);
}

#[test]
fn world_at_four_sizes() {
    for size in SIZES {
        let mut state = windy(size);
        for _ in 0..7 {
            key(&mut state, KeyCode::Down);
        }
        insta::assert_snapshot!(format!("world_{}x{}", size.0, size.1), screen(&state));
    }
}

#[test]
fn a_searched_log_at_four_sizes() {
    for size in SIZES {
        let mut state = fixture::state(size, fixture::colour());
        fixture::complete(&mut state);
        press(&mut state, '8');
        press(&mut state, '/');
        type_text(&mut state, "wp1");
        insta::assert_snapshot!(format!("log_search_{}x{}", size.0, size.1), screen(&state));
    }
}

#[test]
fn the_cursor_of_the_graphs_is_on_the_map_too_and_time_is_scaled() {
    let mut state = fixture::state((200, 60), fixture::colour());
    fixture::approach(&mut state);
    press(&mut state, '6');
    let live = screen(&state);
    assert!(
        live.contains("6 Graphs — 60 s") && live.contains("altitude m") && live.contains("50.2"),
        "{live}"
    );
    for _ in 0..20 {
        key(&mut state, KeyCode::Left);
    }
    let back = screen(&state);
    assert!(back.contains("6 Graphs — 60 s — at 00:4"), "{back}");
    assert!(back.contains('╋'), "the craft's place at the cursor is on the map\n{back}");
    press(&mut state, '-');
    press(&mut state, '-');
    assert!(screen(&state).contains("6 Graphs — 5 min"));
    key(&mut state, KeyCode::Esc);
    assert!(!screen(&state).contains('╋'));

    key(&mut state, KeyCode::Enter);
    for _ in 0..5 {
        key(&mut state, KeyCode::Down);
    }
    key(&mut state, KeyCode::Enter);
    key(&mut state, KeyCode::Esc);
    press(&mut state, 'z');
    assert!(screen(&state).contains("throttle µs"), "{}", screen(&state));
}

#[test]
fn a_stick_recording_forgets_what_came_after_the_instant_that_is_flown_on_from() {
    use betadeck::signals::SimTime;
    use betadeck::timeline::TimelineView;
    let at = |state: &mut AppState, time_s: f64, branch: u32| {
        let mut view = fixture::view(&fixture::SimpleFlight { time_s, fix: true, ..Default::default() });
        let branched_at = SimTime::from_secs_f64(11.0);
        view.timeline = Some(TimelineView { branch, branched_at, ..TimelineView::default() });
        update(state, Msg::View(view));
    };
    for (begins_s, shown) in [(10.0, "● REC 2.0 s"), (20.0, "4 RC")] {
        let mut state = fixture::state((80, 24), fixture::colour());
        at(&mut state, begins_s, 0);
        press(&mut state, '4');
        press(&mut state, 'r');
        at(&mut state, 30.0, 0);
        at(&mut state, 12.0, 1);
        let seen = screen(&state);
        assert!(seen.contains(shown) && !seen.contains("REC -"), "{seen}");
    }
}

#[test]
fn a_craft_that_points_just_west_of_north_points_north() {
    let mut state = fixture::state((120, 40), fixture::colour());
    let flight = fixture::SimpleFlight { time_s: 8.0, fix: true, ..Default::default() };
    let mut view = fixture::view(&flight);
    std::sync::Arc::make_mut(&mut view.vehicle).estimate.heading_deg = Some(359.7);
    update(&mut state, Msg::View(view));
    let seen = screen(&state);
    assert!(seen.contains("heading      0°"), "{seen}");
}

#[test]
fn a_long_notice_leaves_no_letter_of_the_log_in_front_of_it() {
    use betadeck::ui::Severity;
    let mut state = fixture::state((80, 24), fixture::colour());
    for _ in 0..9 {
        state.shared.notify(Severity::Info, "a line of the log");
    }
    state.shared.notify(Severity::Warn, "x ".repeat(60));
    let seen = screen(&state);
    let above = seen.lines().rfind(|line| line.contains("▲ x x")).expect("the notice");
    assert!(above.starts_with("\"│  ▲ x"), "{seen}");
}

#[test]
fn recorded_sticks_are_played_again_in_their_time() {
    use betadeck::session::Command;
    let at = |state: &mut AppState, time_s: f64, throttle_us: u16| -> Vec<u16> {
        let mut view = fixture::view(&fixture::SimpleFlight { time_s, fix: true, ..Default::default() });
        view.sticks.channels[2] = throttle_us;
        let effects = update(state, Msg::View(view));
        let sticks = effects.iter().filter_map(|effect| match effect {
            Effect::Send(Command::Vehicle(VehicleCommand::Sticks(frame))) => Some(frame.channels[2]),
            _ => None,
        });
        sticks.collect()
    };
    let mut state = fixture::state((80, 24), fixture::colour());
    at(&mut state, 10.0, 1000);
    press(&mut state, '4');
    press(&mut state, 'p');
    assert!(
        state.shared.notice.as_ref().is_some_and(|notice| notice.text.contains("`r`")),
        "nothing to play yet"
    );
    press(&mut state, 'r');
    at(&mut state, 11.0, 1000);
    at(&mut state, 12.0, 1400);
    assert!(screen(&state).contains("● REC 2.0 s"), "{}", screen(&state));
    at(&mut state, 14.0, 1100);
    at(&mut state, 15.0, 1100);
    press(&mut state, 'r');

    at(&mut state, 100.0, 1100);
    let first = press(&mut state, 'p');
    assert!(
        first.iter().any(
            |effect| matches!(effect, Effect::Send(Command::Vehicle(VehicleCommand::Sticks(frame))) if frame.channels[2] == 1000)
        )
    );
    assert_eq!(at(&mut state, 101.9, 1000), Vec::<u16>::new());
    assert_eq!(at(&mut state, 102.0, 1000), [1400]);
    assert!(screen(&state).contains("► PLAY 2.0 of 5.0 s"), "{}", screen(&state));
    assert_eq!(at(&mut state, 104.1, 1400), [1100]);
    assert_eq!(at(&mut state, 105.1, 1100), Vec::<u16>::new());
    assert!(!screen(&state).contains("PLAY"));

    // A stick moved by hand ends the playback.
    press(&mut state, 'p');
    key(&mut state, KeyCode::Right);
    assert_eq!(at(&mut state, 108.0, 1010), Vec::<u16>::new());
}

#[test]
fn any_signal_of_a_flight_is_found_by_name_or_meaning_and_drawn() {
    let mut state = fixture::state((120, 40), fixture::colour());
    fixture::approach(&mut state);
    press(&mut state, '6');
    press(&mut state, '/');
    type_text(&mut state, "specific force");
    let seen = screen(&state);
    assert!(seen.contains("Signals —") && seen.contains("force"), "{seen}");
    for _ in 0.."specific force".len() {
        key(&mut state, KeyCode::Backspace);
    }
    type_text(&mut state, "bearing");
    key(&mut state, KeyCode::Enter);
    let seen = screen(&state);
    assert!(seen.contains("✓ bearing"), "{seen}");
    assert!(seen.contains("bearing to the current waypoint"), "its meaning is shown\n{seen}");
    key(&mut state, KeyCode::Esc);
    let seen = screen(&state);
    assert!(seen.contains("bearing deg"), "{seen}");
    press(&mut state, '/');
    type_text(&mut state, "bearing");
    key(&mut state, KeyCode::Enter);
    key(&mut state, KeyCode::Esc);
    assert!(!screen(&state).contains("bearing deg"));
}

#[test]
fn graphs_at_four_sizes() {
    for size in SIZES {
        let mut state = fixture::state(size, fixture::colour());
        fixture::approach(&mut state);
        press(&mut state, '6');
        key(&mut state, KeyCode::Left);
        insta::assert_snapshot!(format!("graphs_{}x{}", size.0, size.1), screen(&state));
    }
}

#[test]
fn the_whole_screen_in_dark_mono_and_ascii() {
    use betadeck::ui::Theme;
    use betadeck::ui::theme::Palette;
    use ratatui::style::Color;
    let drawn = |theme: Theme| {
        let mut state = fixture::state((120, 40), theme);
        fixture::approach(&mut state);
        let mut terminal = Terminal::new(TestBackend::new(120, 40)).expect("a test terminal");
        terminal.draw(|frame| draw(&state, frame)).expect("drawing in memory");
        terminal.backend().clone()
    };
    let coloured = |backend: &TestBackend| {
        backend
            .buffer()
            .content()
            .iter()
            .filter(|cell| (cell.fg, cell.bg) != (Color::Reset, Color::Reset))
            .count()
    };
    let dark = drawn(fixture::colour());
    insta::assert_snapshot!("dark_120x40", dark);
    assert!(coloured(&dark) > 500, "{}", coloured(&dark));
    let mono = drawn(Theme { palette: Palette::Mono, ..Theme::default() });
    assert_eq!(coloured(&mono), 0);
    assert_eq!(mono.to_string(), dark.to_string(), "no word or mark is lost with the colours");
    let ascii = drawn(fixture::plain());
    assert!(ascii.to_string().is_ascii());
    insta::assert_snapshot!("ascii_120x40", ascii);
}

#[test]
fn every_popup_and_panel_is_drawn_at_every_size() {
    let mut state = windy((80, 24));
    let popups: Vec<Vec<betadeck::ui::Popup>> = [":", "ctrl-p", "6", "/"]
        .into_iter()
        .map(|keys| {
            match keys {
                "ctrl-p" => {
                    update(&mut state, Msg::Key(KeyEvent::new(KeyCode::Char('p'), KeyModifiers::CONTROL)));
                }
                ":" => {
                    press(&mut state, ':');
                    type_text(&mut state, "w");
                }
                "6" => {
                    press(&mut state, '6');
                    key(&mut state, KeyCode::Enter);
                }
                _ => {}
            }
            std::mem::take(&mut state.popups)
        })
        .collect();
    assert!(popups.iter().take(3).all(|popups| popups.len() == 1));
    for width in (1..=250).step_by(23) {
        for height in (1..=80).step_by(9) {
            update(&mut state, Msg::Resize(width, height));
            for (at, panel) in Panel::ALL.into_iter().enumerate() {
                state.shared.focus = panel;
                state.shared.slots.visit(panel);
                state.shared.zoomed = (width + height) % 2 == 0;
                state.popups.clone_from(&popups[(usize::from(width + height) + at) % popups.len()]);
                screen(&state);
            }
        }
    }
}

#[test]
fn the_world_alone_on_the_screen_shows_its_changes_in_this_flight() {
    let mut state = windy((80, 24));
    press(&mut state, 'z');
    let seen = screen(&state);
    assert!(seen.contains("Changes in this flight") && seen.contains("none"), "{seen}");
    let mut view = state.shared.view.clone();
    let vehicle = std::sync::Arc::make_mut(&mut view.vehicle);
    vehicle.time.0 += 5_000_000;
    vehicle.world.wind = Some(WindView { speed_mps: 5.0, from_deg: 270.0 });
    vehicle.world.faults.clear();
    let time = vehicle.time;
    update(&mut state, Msg::View(view));
    let seen = screen(&state);
    let clock = format!("{:02}:{:02}", time.0 / 60_000_000, time.0 / 1_000_000 % 60);
    assert!(seen.contains(&format!("{clock}.0 wind speed      5.0 m/s")), "{clock} {seen}");
    assert!(seen.contains(&format!("{clock}.0 gps-loss        —")), "{clock} {seen}");
    press(&mut state, 'z');
    assert!(!screen(&state).contains("Changes in this flight"), "beside others it has no room");
}
