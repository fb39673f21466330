//! Keys in, screen out: flown estimates, look-ahead, what-if, and commands in flight.

use std::sync::Arc;
use std::time::Duration;

use betadeck::fc::UploadReport;
use betadeck::flight::forecast::{
    FlightResult, Forecast, ForecastEnd, ForecastKind, PathPoint, WHAT_IFS, WorstXte,
};
use betadeck::lookahead::{ForecastJob, ForecastReply, ForecastRequest};
use betadeck::session::Command;
use betadeck::telemetry::{InFlightCommand, Snapshot};
use betadeck::ui::{AppState, Effect, Msg, update};
use betadeck::vehicle::VehicleCommand;
use crossterm::event::KeyCode;

use crate::ui::fixture;
use crate::ui::fixture::SimpleFlight;
use crate::ui::hands::{key, press, screen};

/// Returns the only forecast request among the effects, if there is one.
fn job(effects: &[Effect]) -> Option<&ForecastJob> {
    let mut jobs = effects.iter().filter_map(|effect| match effect {
        Effect::Forecast(job) => Some(job),
        _ => None,
    });
    let job = jobs.next();
    assert!(jobs.next().is_none(), "{effects:?}");
    job
}

/// Shows a picture changed by `change`, at another instant.
fn picture(state: &mut AppState, change: impl FnOnce(&mut Snapshot)) -> Vec<Effect> {
    let mut view = state.shared.view.clone();
    let vehicle = Arc::make_mut(&mut view.vehicle);
    vehicle.time.0 += 20_000;
    change(vehicle);
    update(state, Msg::View(view))
}

/// Returns a craft on the ground with a fix, and the job of the first estimate.
fn ready(size: (u16, u16)) -> (AppState, ForecastJob) {
    let mut state = fixture::state(size, fixture::colour());
    let standing = SimpleFlight { time_s: 8.0, fix: true, ..SimpleFlight::default() };
    let effects = update(&mut state, Msg::View(fixture::view(&standing)));
    let first = job(&effects).expect("an estimate").clone();
    (state, first)
}

/// Returns a craft in flight on the leg to WP1.
fn flying(size: (u16, u16)) -> AppState {
    let mut state = fixture::state(size, fixture::colour());
    fixture::approach(&mut state);
    state
}

/// Returns a forecast of a flight around the square that cuts the corners.
fn square(kind: ForecastKind) -> Forecast {
    let corners = [(0.0, 0.0), (50.0, 58.0), (-52.0, 62.0), (-56.0, -66.0), (54.0, -68.0)];
    let path = corners.windows(2).flat_map(|pair| {
        (0..40).map(move |step| {
            let t = f64::from(step) / 40.0;
            let (n, e) = (pair[0].0 + t * (pair[1].0 - pair[0].0), pair[0].1 + t * (pair[1].1 - pair[0].1));
            PathPoint { n, e, alt: 50.0, along_m: 0.0, time_s: 0.0 }
        })
    });
    let mut path: Vec<_> = path.collect();
    path.push(PathPoint { n: 54.0, e: -68.0, alt: 0.0, along_m: 430.6, time_s: 221.0 });
    Forecast {
        kind,
        end: ForecastEnd::Flight(FlightResult::Complete),
        reason: "mission complete, landed and disarmed".to_owned(),
        time_s: 221.2,
        battery_used_pct: 38.4,
        worst_xte: Some(WorstXte { xte_m: 0.93, wp: 1 }),
        fence_margin_m: Some(57.6),
        legs: Vec::new(),
        moved_m: 86.0,
        path,
        unchanged: None,
    }
}

fn answer(state: &mut AppState, revision: u64, forecast: Forecast) {
    let kind = forecast.kind;
    let reply = ForecastReply { revision, kind, forecast: Ok(Box::new(forecast)) };
    assert!(update(state, Msg::Forecast(reply)).is_empty());
}

#[test]
fn the_open_plan_is_estimated_at_once_and_again_when_it_or_the_air_changes() {
    let (mut state, first) = ready((80, 24));
    let ForecastRequest::PlanEstimate { plan, .. } = &first.request else { panic!("{first:?}") };
    assert_eq!(**plan, *state.shared.plan());
    assert!(picture(&mut state, |_| {}).is_empty(), "nothing has changed");
    press(&mut state, '2');
    let effects = press(&mut state, 'd');
    let second = job(&effects).expect("another plan, at once").clone();
    assert_eq!(state.shared.plan().waypoints.len(), 3);
    assert!(second.revision > first.revision);
    let effects = picture(&mut state, |vehicle| vehicle.world.gust_mps = 3.0);
    assert!(job(&effects).is_some_and(|job| job.revision > second.revision), "other air");
}

#[test]
fn the_numbers_of_the_newest_estimate_stand_under_the_plan() {
    let (mut state, first) = ready((80, 24));
    press(&mut state, '2');
    assert!(screen(&state).contains("flown estimate …"));
    answer(&mut state, first.revision + 7, square(ForecastKind::PlanEstimate));
    assert!(screen(&state).contains("flown estimate …"), "an answer to something else");
    answer(&mut state, first.revision, square(ForecastKind::PlanEstimate));
    insta::assert_snapshot!(screen(&state));
}

#[test]
fn an_estimate_that_does_not_complete_says_why_first() {
    let (mut state, first) = ready((120, 40));
    let missed = Forecast {
        end: ForecastEnd::Flight(FlightResult::Refused),
        reason: "autopilot refused: Waypoint 3 is 142 m from home, the fence is 100 m.".to_owned(),
        ..square(ForecastKind::PlanEstimate)
    };
    answer(&mut state, first.revision, missed);
    assert!(screen(&state).contains("✗ flown: "), "{}", screen(&state));
    press(&mut state, '2');
    let effects = press(&mut state, 'd');
    let revision = job(&effects).expect("another plan").revision;
    let forecast = Err("The craft refuses `set ap_max_velocity = fast`".to_owned());
    update(&mut state, Msg::Forecast(ForecastReply { revision, kind: ForecastKind::PlanEstimate, forecast }));
    assert!(screen(&state).contains("No flown estimate: The craft refuses"), "{}", screen(&state));
}

#[test]
fn the_predicted_path_lies_dotted_on_the_map_120x40() {
    let (mut state, first) = ready((120, 40));
    answer(&mut state, first.revision, square(ForecastKind::PlanEstimate));
    insta::assert_snapshot!(screen(&state));
}

#[test]
fn the_look_ahead_is_asked_for_every_second_until_it_is_turned_off() {
    let mut state = flying((80, 24));
    let effects = press(&mut state, 'L');
    let first = job(&effects).expect("a look-ahead").clone();
    assert_eq!(first.request, ForecastRequest::LookAhead);
    assert!(screen(&state).contains("look-ahead: …"));
    answer(&mut state, first.revision, Forecast { time_s: 112.0, ..square(ForecastKind::LookAhead) });
    insta::assert_snapshot!("look_ahead_80x24", screen(&state));
    assert!(picture(&mut state, |_| {}).is_empty(), "not yet");
    let later = state.shared.now + Duration::from_millis(1100);
    update(&mut state, Msg::Clock(later));
    let effects = picture(&mut state, |_| {});
    assert!(job(&effects).is_some_and(|job| job.request == ForecastRequest::LookAhead));
    assert!(screen(&state).contains("COMPLETE in 1:52, 62 % left"), "the older one until the newer comes");
    assert!(press(&mut state, 'L').is_empty());
    assert!(!screen(&state).contains("look-ahead"));
}

#[test]
fn a_look_ahead_ends_with_the_flight() {
    let mut state = flying((80, 24));
    let effects = press(&mut state, 'L');
    let revision = job(&effects).expect("a look-ahead").revision;
    let forecast = Err("The craft stands disarmed.".to_owned());
    update(&mut state, Msg::Forecast(ForecastReply { revision, kind: ForecastKind::LookAhead, forecast }));
    assert!(!state.shared.forecast.looks_ahead());
    assert!(state.shared.notice.as_ref().is_some_and(|notice| notice.text.contains("disarmed")));
}

#[test]
fn on_the_ground_there_is_nothing_to_look_ahead_to_and_a_what_if_flies_from_home() {
    let (mut state, _) = ready((80, 24));
    let refused = |state: &AppState| {
        state.shared.notice.as_ref().is_some_and(|notice| notice.text.contains("`F` flies the plan"))
    };
    assert!(press(&mut state, 'L').is_empty());
    assert!(refused(&state) && state.popups.is_empty());
    press(&mut state, 'w');
    assert!(!refused(&state));
    assert!(screen(&state).contains("What if, flown from home:"), "{}", screen(&state));
    let effects = key(&mut state, KeyCode::Enter);
    let asked = job(&effects).expect("a what-if");
    assert!(matches!(&asked.request, ForecastRequest::WhatIf { what_if, .. } if *what_if == WHAT_IFS[0]));
    assert!(state.popups.is_empty());
    assert!(screen(&state).contains("GPS lost here, flown from home: …"), "{}", screen(&state));
}

#[test]
fn a_what_if_is_chosen_flown_shown_and_dismissed() {
    let mut state = flying((80, 24));
    press(&mut state, 'w');
    key(&mut state, KeyCode::Down);
    insta::assert_snapshot!("what_if_list_80x24", screen(&state));
    key(&mut state, KeyCode::Up);
    let effects = key(&mut state, KeyCode::Enter);
    let chosen = job(&effects).expect("a what-if").clone();
    assert!(matches!(&chosen.request, ForecastRequest::WhatIf { what_if, .. } if *what_if == WHAT_IFS[0]));
    assert!(state.popups.is_empty() && screen(&state).contains("GPS lost here: …"));
    let drifts = Forecast {
        end: ForecastEnd::Flight(FlightResult::Aborted),
        reason: "mission given up: The GPS fix was lost: the mission resumes 2 s after it is back."
            .to_owned(),
        time_s: 30.0,
        moved_m: 31.0,
        path: (0..60)
            .map(|step| PathPoint {
                n: 6.8,
                e: 59.4 + 0.5 * f64::from(step),
                alt: 50.0,
                along_m: 0.0,
                time_s: 0.0,
            })
            .collect(),
        ..square(ForecastKind::WhatIf)
    };
    answer(&mut state, chosen.revision, drifts);
    assert!(state.shared.notice.as_ref().is_some_and(|notice| notice.text.contains("drifts 31 m in 0:30")));
    insta::assert_snapshot!("what_if_120x40", {
        state.shared.size = (120, 40);
        screen(&state)
    });
    key(&mut state, KeyCode::Esc);
    assert!(!screen(&state).contains("··· GPS lost here"), "the ghost is gone");
}

#[test]
fn hold_here_and_go_on_are_sent_and_offered_when_they_make_sense() {
    let sent = |effects: &[Effect]| match effects {
        [Effect::Send(Command::Vehicle(VehicleCommand::InFlight(command)))] => Some(*command),
        _ => None,
    };
    let mut state = flying((120, 40));
    assert_eq!(sent(&press(&mut state, 'K')), Some(InFlightCommand::HoldHere));
    assert!(press(&mut state, 'C').is_empty(), "nothing is held yet");
    picture(&mut state, |vehicle| vehicle.nav.as_mut().expect("a navigator").held_by_command = true);
    let held = screen(&state);
    assert!(held.contains("Holds here by command.") && held.contains("C go on"), "{held}");
    assert_eq!(sent(&press(&mut state, 'C')), Some(InFlightCommand::Resume));

    let (mut state, _) = ready((120, 40));
    for c in ['K', 'C', 'G'] {
        assert!(press(&mut state, c).is_empty());
        assert!(state.shared.notice.as_ref().is_some_and(|notice| notice.text.contains("`g` engages it")));
    }
}

#[test]
fn go_to_asks_which_waypoint() {
    let mut state = flying((80, 24));
    press(&mut state, 'G');
    insta::assert_snapshot!("go_to_80x24", screen(&state));
    press(&mut state, '3');
    let effects = key(&mut state, KeyCode::Enter);
    assert!(
        matches!(
            effects[..],
            [Effect::Send(Command::Vehicle(VehicleCommand::InFlight(InFlightCommand::GoTo(3))))]
        ),
        "{effects:?}"
    );
    assert!(state.popups.is_empty());
}

#[test]
fn an_upload_in_flight_takes_effect_at_the_next_engagement_or_by_going_there() {
    let mut state = flying((120, 40));
    press(&mut state, '2');
    press(&mut state, 'd');
    press(&mut state, '1');
    press(&mut state, 'U');
    // The active waypoint is no longer in its place.
    assert!(screen(&state).contains("at the next engagement, or with `G`"), "{}", screen(&state));
    press(&mut state, 'y');
    assert!(state.popups.is_empty());
    let id = state.shared.editor.plan().id();
    update(&mut state, Msg::UploadReply { id, count: 4, result: Ok(UploadReport::default()) });
    let reported = state.shared.notice.as_ref().map(|notice| notice.text.clone()).unwrap_or_default();
    assert!(reported.contains("at the next engagement; `G` continues on it"), "{reported}");
    let open = state.shared.plan().clone();
    picture(&mut state, |vehicle| vehicle.stored_plan = Some(open));
    let shown = screen(&state);
    assert!(shown.contains("G fly the new plan") && shown.contains("new plan, for the next"), "{shown}");
    press(&mut state, 'G');
    assert!(screen(&state).contains("Continue on the new plan from"));
}

/// Types a line of the `:` line and presses Enter.
fn enter(state: &mut AppState, line: &str) -> Vec<Effect> {
    for c in line.chars() {
        press(state, c);
    }
    key(state, KeyCode::Enter)
}

#[test]
fn what_if_takes_values_and_works_on_the_ground() {
    let mut state = crate::ui::hands::state_with_fix((120, 40));
    for value in ["wind,,14@270", "motor,,3:0.5", "payload,,0.4"] {
        let effects = enter(&mut state, &format!(":what-if {value}"));
        let request = &job(&effects).unwrap_or_else(|| panic!("{value}: {effects:?}")).request;
        assert!(matches!(request, ForecastRequest::WhatIf { plan, .. } if **plan == *state.shared.plan()));
    }
    assert!(screen(&state).contains("payload,,0.4, flown from home: …"), "{}", screen(&state));
    for (line, said) in [
        (":what-if wind,5,14@270", "has no duration"),
        (":what-if wnd,,14@270", "There is no what-if wnd,,14@270"),
    ] {
        assert!(job(&enter(&mut state, line)).is_none(), "{line}");
        assert!(screen(&state).contains(said), "{}", screen(&state));
        key(&mut state, KeyCode::Esc);
        key(&mut state, KeyCode::Esc);
    }
    press(&mut state, 'w');
    assert!(screen(&state).contains("What if, flown from home:"), "{}", screen(&state));
    assert!(job(&key(&mut state, KeyCode::Enter)).is_some());
}
