//! The first half hour of a new user, by keys: the screen is true, stays readable and says how to go on.

use betadeck::events::{Event, SessionEvent};
use betadeck::flight::forecast::ForecastKind;
use betadeck::lookahead::{ForecastJob, ForecastReply};
use betadeck::plan::{Seconds, WaypointType};
use betadeck::session::SessionView;
use betadeck::signals::SimTime;
use betadeck::telemetry::{AbortReason, Guard, GuardName, GuardOp, NavState, Refusal};
use betadeck::timeline::TimelineView;
use betadeck::ui::files::FileReply;
use betadeck::ui::theme::{Palette, Theme};
use betadeck::ui::{AppState, Effect, Msg, draw, update};
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::style::Color;

use crate::ui::fixture;
use crate::ui::fixture::SimpleFlight;
use crate::ui::hands::{keys, screen, state_with_fix as state};

/// Returns a craft on its way to the first waypoint.
fn flight() -> SimpleFlight {
    SimpleFlight {
        time_s: 40.0,
        alt: 50.0,
        speed: 5.0,
        armed: true,
        fix: true,
        state: NavState::Approaching,
        ..SimpleFlight::default()
    }
}

fn begin_tutorial(state: &mut AppState) {
    keys(state, ":");
    keys(state, "'app.tutorial enter");
}

#[test]
fn a_notice_leaves_the_line_of_the_tutorial_readable() {
    let mut state = state((80, 24));
    begin_tutorial(&mut state);
    keys(&mut state, "ctrl-c");
    let seen = screen(&state);
    assert!(seen.contains("Ctrl-C again within 2 s quits.") && seen.contains("1/5 Press F"), "{seen}");
}

#[test]
fn the_tutorial_is_read_to_its_end_on_80_columns() {
    let mut state = state((80, 24));
    begin_tutorial(&mut state);
    assert!(screen(&state).contains(" the plan of the map."), "{}", screen(&state));
}

#[test]
fn the_fix_of_an_endless_hold_keeps_the_rest_of_the_plan() {
    let mut state = state((120, 40));
    keys(&mut state, "2 z ctrl-a d");
    let lines = "waypoint insert 0 40.4642000 -79.5182000 2000 0 HOLD 0 NONE\n\
                 waypoint insert 1 40.4645000 -79.5182000 2000 0 LAND 0 NONE";
    update(&mut state, Msg::Paste(lines.to_owned()));
    let seen = screen(&state);
    assert!(seen.contains("f: hold WP0 for 10 s"), "{seen}");
    keys(&mut state, "f");
    let waypoints = &state.shared.plan().waypoints;
    assert_eq!(
        (waypoints.len(), waypoints[0].kind, waypoints[0].duration),
        (2, WaypointType::Hold, Seconds::new(10.0))
    );
}

#[test]
fn the_loss_of_gps_gives_one_advice() {
    let mut state = state((120, 40));
    let mut view = fixture::view(&SimpleFlight { state: NavState::Idle, ..flight() });
    let vehicle = std::sync::Arc::make_mut(&mut view.vehicle);
    vehicle.nav.as_mut().unwrap().refusal = Some(Refusal::Aborted(AbortReason::GpsLost));
    vehicle.craft.channels.as_mut().unwrap()[5] = 1900;
    view.sticks.channels = vehicle.craft.channels.unwrap();
    update(&mut state, Msg::View(view));
    let seen = screen(&state);
    assert!(seen.contains("The GPS fix was lost"), "{seen}");
    assert!(!seen.contains("off and on again resumes"), "{seen}");
}

#[test]
fn less_or_equal_has_two_characters_in_ascii() {
    for size in [(80, 24), (120, 40)] {
        let mut state = fixture::state(size, fixture::plain());
        let guard = Guard { name: GuardName::TurnRadius, value: 62.4, limit: 5.5, op: GuardOp::AtMost };
        let plane = Guard { name: GuardName::Plane, value: -62.4, limit: 0.0, op: GuardOp::AtLeast };
        let flight = SimpleFlight { guards: vec![guard, plane], ..flight() };
        update(&mut state, Msg::View(fixture::view(&flight)));
        let seen = screen(&state);
        assert!(seen.contains("<=") && seen.contains(">="), "{seen}");
        assert!(seen.contains("5.5"), "{seen}");
    }
}

#[test]
fn the_light_theme_paints_a_light_background_under_dark_text() {
    let theme = Theme { palette: Palette::Light, ..Theme::default() };
    let mut state = fixture::state((80, 24), theme);
    keys(&mut state, "q");
    let mut terminal = Terminal::new(TestBackend::new(80, 24)).unwrap();
    terminal.draw(|frame| draw(&state, frame)).unwrap();
    let bright = |colour: Color| match colour {
        Color::Rgb(r, g, b) => Some(u32::from(r) + u32::from(g) + u32::from(b)),
        _ => None,
    };
    for cell in terminal.backend().buffer().content() {
        let (text, ground) = (bright(cell.fg), bright(cell.bg));
        assert!(ground.is_some_and(|ground| ground > 600), "{cell:?}");
        assert!(text.is_some_and(|text| text < 450), "{cell:?}");
    }
}

#[test]
fn the_sign_of_the_satellites_is_in_common_fonts() {
    let seen = screen(&state((80, 24)));
    assert!(seen.contains("⊕ 3D 12 sats") && !seen.contains('⌖'), "{seen}");
}

#[test]
fn every_question_before_the_end_takes_the_same_keys() {
    let is_quit = |effects: &[Effect]| effects.iter().any(|effect| matches!(effect, Effect::Quit));
    let mut armed = state((80, 24));
    update(&mut armed, Msg::View(fixture::view(&flight())));
    let mut unsaved = state((80, 24));
    keys(&mut unsaved, "2 i");
    for state in [&mut armed, &mut unsaved] {
        keys(state, "q");
        let seen = screen(state);
        assert!(seen.contains(" y quit") && seen.contains(" n stay"), "{seen}");
        assert!(keys(state, "n").is_empty());
        assert!(!screen(state).contains(" n stay"));
        keys(state, "q");
        assert!(!is_quit(&keys(state, "enter")), "Enter ends no flight by mistake");
        assert!(is_quit(&keys(state, "y")));
    }
    // If edits are not stored anywhere, `y` asks again first.
    update(&mut unsaved, Msg::Files(FileReply::NotKept("No room for the journal.".to_owned())));
    keys(&mut unsaved, "q");
    assert!(!is_quit(&keys(&mut unsaved, "y")) && screen(&unsaved).contains(" d discard"));
}

#[test]
fn quitting_while_an_earlier_instant_is_shown_asks_about_the_craft_of_now() {
    for (head_is_armed, asks) in [(true, true), (false, false)] {
        let mut state = state((80, 24));
        let timeline = TimelineView { rewound: true, head_is_armed, ..TimelineView::default() };
        let view = SessionView { timeline: Some(timeline), ..fixture::view(&flight()) };
        update(&mut state, Msg::View(view));
        let effects = keys(&mut state, "q");
        assert_eq!(screen(&state).contains("The craft is armed"), asks);
        assert_eq!(effects.iter().any(|effect| matches!(effect, Effect::Quit)), !asks);
    }
}

#[test]
fn the_time_to_a_waypoint_is_that_of_the_leg() {
    let mut state = state((120, 40));
    let guard = Guard { name: GuardName::Plane, value: -62.4, limit: 0.0, op: GuardOp::AtLeast };
    let flight = SimpleFlight { speed: 0.5, guards: vec![guard], ..flight() };
    let view = fixture::view(&flight);
    let distance_m = view.vehicle.nav.as_ref().unwrap().distance_m.unwrap();
    update(&mut state, Msg::View(view));
    let seen = screen(&state);
    assert!(seen.contains(&format!("{:.0} s at 5 m/s", distance_m / 5.0)), "{distance_m} {seen}");
}

#[test]
fn a_branch_takes_the_sentence_of_the_old_what_if_away() {
    let mut state = state((120, 40));
    update(&mut state, Msg::View(fixture::view(&flight())));
    keys(&mut state, "w enter");
    assert!(screen(&state).contains("··· GPS lost here"), "{}", screen(&state));
    let left = SimTime::from_secs_f64(40.0);
    let kind = SessionEvent::Branch { number: 1, left };
    update(&mut state, Msg::Event(Event { time: SimTime::from_secs_f64(30.0), kind }));
    assert!(!screen(&state).contains("GPS lost here"), "{}", screen(&state));
}

#[test]
fn another_plan_does_not_show_the_result_of_the_one_before() {
    let mut state = state((120, 40));
    let effects = keys(&mut state, "2 n i");
    let revision = effects.iter().rev().find_map(|effect| match effect {
        Effect::Forecast(ForecastJob { revision, .. }) => Some(*revision),
        _ => None,
    });
    let revision = revision.expect("an estimate is asked for");
    let forecast = Err("The craft refuses the plan.".to_owned());
    update(&mut state, Msg::Forecast(ForecastReply { revision, kind: ForecastKind::PlanEstimate, forecast }));
    assert!(screen(&state).contains("No flown estimate: The craft refuses"), "{}", screen(&state));
    keys(&mut state, ")");
    let seen = screen(&state);
    assert!(seen.contains("flown estimate …") && !seen.contains("The craft refuses"), "{seen}");
}
