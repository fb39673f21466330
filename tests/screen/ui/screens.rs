//! Whole screens of the user interface, and a check that no size and no picture breaks it.

use crate::ui::fixture;
use crate::ui::hands::{drawn, press, screen};
use betadeck::link::endpoint::EndpointKind;
use betadeck::plan::FlightPlan;
use betadeck::session::command::CliOutput;
use betadeck::telemetry::{ArmingFlag, CannotHold, HoldLimit, NavState};
use betadeck::ui::{Msg, Panel, Severity, Theme, update};
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use strum::IntoEnumIterator as _;

#[path = "../../../examples/picture/svg/mod.rs"]
pub(crate) mod svg;

#[test]
fn at_start_80x24() {
    let state = fixture::state((80, 24), fixture::colour());
    insta::assert_snapshot!(screen(&state));
}

#[test]
fn approaching_80x24() {
    let mut state = fixture::state((80, 24), fixture::colour());
    fixture::approach(&mut state);
    insta::assert_snapshot!(screen(&state));
}

#[test]
fn approaching_120x40() {
    let mut state = fixture::state((120, 40), fixture::colour());
    fixture::approach(&mut state);
    insta::assert_snapshot!(screen(&state));
}

#[test]
fn orbiting_200x60() {
    let mut state = fixture::state((200, 60), fixture::colour());
    fixture::orbit(&mut state);
    insta::assert_snapshot!(screen(&state));
}

#[test]
fn rewound_80x24() {
    let mut state = fixture::state((80, 24), fixture::colour());
    fixture::rewind(&mut state);
    insta::assert_snapshot!(screen(&state));
}

#[test]
fn rewound_80x24_in_ascii() {
    let mut state = fixture::state((80, 24), fixture::plain());
    fixture::rewind(&mut state);
    insta::assert_snapshot!(screen(&state));
}

#[test]
fn rewound_120x40() {
    let mut state = fixture::state((120, 40), fixture::colour());
    fixture::rewind(&mut state);
    insta::assert_snapshot!(screen(&state));
}

#[test]
fn a_branch_keeps_the_old_track_faint_and_the_old_log_dimmed_120x40() {
    use betadeck::ui::theme::Role;

    let mut state = fixture::state((120, 40), fixture::colour());
    fixture::branch(&mut state);
    let backend = drawn(&state);
    insta::assert_snapshot!(backend);
    let buffer = backend.buffer();
    let braille = |colour| {
        let is_of = |cell: &&ratatui::buffer::Cell| {
            cell.fg == colour && cell.symbol().starts_with(|c| ('\u{2801}'..='\u{28ff}').contains(&c))
        };
        buffer.content().iter().filter(is_of).count()
    };
    let new_track = braille(state.shared.theme.colour(Role::Track));
    assert!(new_track > 5, "{new_track}");
    let dim = state.shared.theme.colour(Role::Dim);
    let row = |text: &str| {
        let rows = buffer.area.height;
        let line = |y| (0..buffer.area.width).map(|x| buffer[(x, y)].symbol().to_owned()).collect::<String>();
        (0..rows).find(|&y| line(y).contains(text)).map(|y| (y, line(y)))
    };
    let (y, line) = row("HOLDING → ORBITING").expect("the abandoned line");
    let x = line.find("WP2").map(|at| line[..at].chars().count()).expect("its text") as u16;
    assert_eq!(buffer[(x, y)].fg, dim);
}

#[test]
fn complete_60x20_shows_the_focused_panel_alone() {
    let mut state = fixture::state((60, 20), fixture::colour());
    fixture::complete(&mut state);
    press(&mut state, '3');
    insta::assert_snapshot!(screen(&state));
}

#[test]
fn rc_80x24() {
    let mut state = fixture::state((80, 24), fixture::colour());
    fixture::approach(&mut state);
    press(&mut state, '4');
    insta::assert_snapshot!(screen(&state));
}

#[test]
fn help_80x24() {
    let mut state = fixture::state((80, 24), fixture::colour());
    press(&mut state, '?');
    insta::assert_snapshot!(screen(&state));
}

#[test]
fn in_ascii_every_cell_is_ascii_and_the_words_are_all_there() {
    for fly in [fixture::approach, fixture::orbit, fixture::complete, fixture::branch] {
        let mut rich = fixture::state((200, 60), fixture::colour());
        let mut plain = fixture::state((200, 60), fixture::plain());
        fly(&mut rich);
        fly(&mut plain);
        let plain = screen(&plain);
        assert!(plain.is_ascii(), "{plain}");
        assert!(
            !plain.contains('?') || screen(&rich).contains('?'),
            "a character has no replacement\n{plain}"
        );
        for word in ["ARRIVED", "COMPLETE", "WP", "2 Plan", "5 CLI", "square.toml"] {
            assert!(plain.contains(word), "{word} missing in\n{plain}");
        }
    }
}

#[test]
fn help_and_quit_are_always_offered() {
    for size in [(60, 20), (80, 24), (200, 60)] {
        let mut state = fixture::state(size, fixture::colour());
        fixture::approach(&mut state);
        for panel in Panel::ALL {
            state.shared.focus = panel;
            let shown = screen(&state);
            let words: &[&str] = if panel == Panel::Cli { &["Esc leave"] } else { &["? help", "q quit"] };
            for word in words {
                assert!(shown.contains(word), "{word} missing at {size:?} in {panel:?}\n{shown}");
            }
        }
    }
}

#[test]
fn what_does_not_fit_the_status_line_ends_in_an_ellipsis() {
    let mut state = fixture::state((60, 20), fixture::colour());
    fixture::approach(&mut state);
    let shown = screen(&state);
    let first = shown.lines().next().expect("a status line");
    assert!(first.contains("● ARMED AUTOPILOT …  ⊕ 3D 12 sats"), "{first}");
    let second = shown.lines().nth(1).expect("a status line");
    assert!(second.contains("62.3 m") && second.contains("50.2 m"), "distance and height first: {second}");
}

#[test]
fn a_large_cross_track_error_keeps_its_distance_from_its_name() {
    let mut state = fixture::state((120, 40), fixture::colour());
    fixture::approach(&mut state);
    for (xte_m, shown) in [(0.31, "xte +0.3 m"), (-13.2, "xte -13.2 m"), (-1320.0, "xte -1320 m")] {
        let vehicle = std::sync::Arc::make_mut(&mut state.shared.view.vehicle);
        vehicle.nav.as_mut().expect("a mission").xte_m = Some(xte_m);
        assert!(screen(&state).contains(shown), "{}", screen(&state));
    }
}

#[test]
fn the_speed_is_the_wanted_one_until_it_is_measured() {
    let mut state = fixture::state((80, 24), fixture::colour());
    for (achieved, shown) in [(0.0, " 8× "), (7.9, " 8× "), (3.0, " 3× ")] {
        state.shared.view.speed_wanted = 8.0;
        state.shared.view.speed_achieved = achieved;
        let text = screen(&state);
        let second = text.lines().nth(1).expect("a status line");
        assert!(second.contains(shown), "{achieved}: {second}");
    }
}

#[test]
fn a_busy_door_is_marked_and_named_where_there_is_room() {
    for (width, shown) in [(80, "✗rc "), (120, "✗rc busy ")] {
        let mut state = fixture::state((width, 40), fixture::colour());
        let door = betadeck::link::endpoint::EndpointStatus {
            kind: EndpointKind::Rc,
            address: String::new(),
            state: betadeck::link::endpoint::EndpointState::Busy,
        };
        state.shared.view.endpoints = vec![door];
        let text = screen(&state);
        assert!(text.contains(shown), "{text}");
    }
}

#[test]
fn a_notice_leaves_the_hints_alone_and_loses_no_word() {
    let long = "Cannot arm, THROTTLE: lower the throttle with `t`, then wait until the craft has found out where it \
                is and press the key once more.";
    for size in [(60, 20), (80, 24), (200, 60)] {
        let mut state = fixture::state(size, fixture::colour());
        let hints = |screen: &str| screen.lines().last().map(str::to_owned);
        let before = hints(&screen(&state));
        state.shared.notify(Severity::Warn, long);
        // Zooms a panel, because the log would show the notice, too.
        state.shared.focus = Panel::Rc;
        state.shared.slots.visit(Panel::Rc);
        state.shared.zoomed = true;
        let shown = screen(&state);
        assert!(
            before.is_some_and(|line| line.contains("? help"))
                && hints(&shown).is_some_and(|line| line.contains("? help")),
            "{shown}"
        );
        for word in long.split_whitespace().filter(|_| size.0 >= 80) {
            assert!(shown.contains(word), "{word} missing at {size:?}\n{shown}");
        }
    }
}

#[test]
fn long_lines_of_the_cli_wrap_and_scroll_to_the_first() {
    let mut state = fixture::state((80, 24), fixture::colour());
    press(&mut state, '5');
    for line in 0..30 {
        let text = format!("waypoint insert {line} 40.4640000 -79.5175000 5000 0 FLYOVER {line} ORBIT\r\n");
        state.panels.cli.console.answer(Some(&CliOutput { text, ..CliOutput::default() }));
    }
    let shown = screen(&state);
    assert!(shown.contains("29 ORBIT") && !shown.contains('…'), "{shown}");
    for _ in 0..10 {
        update(&mut state, Msg::Key(KeyEvent::new(KeyCode::PageUp, KeyModifiers::NONE)));
    }
    let shown = screen(&state);
    let first = shown.lines().nth(3).expect("a row");
    assert!(first.contains("waypoint insert 0 "), "{shown}");
}

#[test]
fn a_long_plan_scrolls_to_its_last_waypoint_whatever_is_below() {
    for far_ones in [0, 1, 3] {
        let corner = fixture::square().waypoints[0];
        let mut plan = FlightPlan { waypoints: std::iter::repeat_n(corner, 30).collect() };
        let waypoints = &mut plan.waypoints;
        // These waypoints are outside the geofence: the findings are drawn below the list.
        waypoints.iter_mut().take(far_ones).for_each(|waypoint| waypoint.position.lat_e7 += 10_000_000);
        let mut state = fixture::state_with((80, 24), fixture::colour(), plan);
        press(&mut state, '2');
        press(&mut state, 'z');
        update(&mut state, Msg::Key(KeyEvent::new(KeyCode::End, KeyModifiers::NONE)));
        let shown = screen(&state);
        assert!(shown.contains("29 [FLYOVER]") && !shown.contains("  0  FLYOVER"), "{shown}");
        press(&mut state, 'k');
        assert!(screen(&state).contains("28 [FLYOVER]"));
    }
}

#[test]
fn landing_80x24_shows_the_whole_machine_and_every_guard() {
    let mut state = fixture::state((80, 24), fixture::colour());
    fixture::land(&mut state);
    let words = screen(&state);
    for name in NavState::iter() {
        assert!(words.contains(&name.to_string()), "{name} missing\n{words}");
    }
    for guard in ["altitude", "speed", "throttle", "sink", "below hover", "time"] {
        assert!(words.contains(guard), "{guard} missing\n{words}");
    }
    insta::assert_snapshot!(screen(&state));
}

#[test]
fn a_craft_that_cannot_hold_says_so_on_an_80x24_screen() {
    let mut state = fixture::state((80, 24), fixture::colour());
    fixture::orbit(&mut state);
    state.shared.focus = Panel::State;
    state.shared.slots.visit(Panel::State);
    let mut view = state.shared.view.clone();
    let vehicle = std::sync::Arc::make_mut(&mut view.vehicle);
    let nav = vehicle.nav.as_mut().unwrap();
    nav.cannot_hold = Some(CannotHold { distance_m: 23.4, vertical_m: -0.2, limit: HoldLimit::Tilt });
    update(&mut state, Msg::View(view));
    insta::assert_snapshot!(screen(&state));
}

#[test]
fn a_long_advice_leaves_the_machine_on_an_80x24_screen() {
    let mut state = fixture::state((80, 24), fixture::colour());
    let mut view = state.shared.view.clone();
    let vehicle = std::sync::Arc::make_mut(&mut view.vehicle);
    vehicle.craft.gps_fix = Some(true);
    vehicle.craft.arming_blocked_by = Some(std::iter::once(ArmingFlag::MotorProtocol).collect());
    update(&mut state, Msg::View(view));
    let shown = screen(&state);
    assert!(shown.contains("motor_pwm_protocol"), "{shown}");
    for name in NavState::iter() {
        assert!(shown.contains(&name.to_string()), "{name} missing\n{shown}");
    }
}

#[test]
fn a_small_screen_says_what_it_needs() {
    let mut state = fixture::state((52, 18), fixture::colour());
    fixture::approach(&mut state);
    assert!(screen(&state).contains("at least 60x20, now 52x18"), "{}", screen(&state));
}

#[test]
fn no_size_panics_with_any_focus_zoom_or_popup() {
    let themes: [Theme; 2] = [fixture::colour(), fixture::plain()];
    let mut state = fixture::state((80, 24), themes[0]);
    fixture::orbit(&mut state);
    press(&mut state, '?');
    let popup = std::mem::take(&mut state.popups);
    for width in (1..=250).step_by(7) {
        for height in (1..=85).step_by(3) {
            update(&mut state, Msg::Resize(width, height));
            state.shared.focus = Panel::ALL[usize::from(width + height) % Panel::ALL.len()];
            state.shared.slots.visit(state.shared.focus);
            state.shared.zoomed = (width / 7 + height) % 3 == 0;
            state.popups = if width % 5 == 0 { popup.clone() } else { Vec::new() };
            state.shared.theme = themes[usize::from(height % 2)];
            screen(&state);
        }
    }
}

#[test]
fn a_picture_with_nonsense_numbers_is_drawn() {
    let mut state = fixture::state((120, 40), fixture::colour());
    fixture::approach(&mut state);
    for nonsense in [f64::NAN, f64::INFINITY, -1e300] {
        let mut view = state.shared.view.clone();
        let vehicle = std::sync::Arc::make_mut(&mut view.vehicle);
        let truth = vehicle.truth.as_mut().expect("the fixture tells the truth");
        truth.n = nonsense;
        truth.lat_deg = nonsense;
        truth.heading_deg = nonsense;
        let nav = vehicle.nav.as_mut().unwrap();
        nav.distance_m = Some(nonsense);
        nav.aim_ne = Some(nalgebra::Vector2::new(nonsense, 0.0));
        let settings = vehicle.settings.as_mut().unwrap();
        settings.fence_m = Some(nonsense);
        settings.orbit_radius_m = nonsense;
        vehicle.craft.battery_v = Some(nonsense);
        update(&mut state, Msg::View(view));
        assert!(screen(&state).contains("APPROACHING"));
    }
}

#[test]
fn the_screen_becomes_a_picture() {
    let mut state = fixture::state((120, 40), fixture::colour());
    fixture::approach(&mut state);
    let picture = svg::svg(drawn(&state).buffer());
    assert!(picture.contains("APPROACHING") && picture.contains("1 Map"));
    assert_eq!(picture.matches("<text").count(), picture.matches("</text>").count());
}
