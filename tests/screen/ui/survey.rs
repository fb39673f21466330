//! Keys in, screen out: where a fault may be fatal, and go or no-go.

use betadeck::campaign::{Forecast, InputValue, Record, Side, Standing};
use betadeck::flight::FlightResult;
use betadeck::flight::forecast::{self as flight_ahead, ForecastEnd, ForecastKind, WHAT_IFS};
use betadeck::flight::sweep::{Fate, SweepPoint};
use betadeck::lookahead::{ForecastJob, ForecastReply, SurveyJob, SurveyNews, SurveyReply, SurveyRequest};
use betadeck::scenario::{BuiltinFiles, read};
use betadeck::ui::{AppState, Effect, Msg, run_line, update};
use crossterm::event::KeyCode;

use crate::ui::fixture;
use crate::ui::hands::{key, keys, press, screen, state_with_fix};

const SIZES: [(u16, u16); 4] = [(60, 20), (80, 24), (120, 40), (200, 60)];

/// Returns the only survey that is asked for among the effects.
fn job(effects: &[Effect]) -> SurveyJob {
    let mut jobs = effects.iter().filter_map(|effect| match effect {
        Effect::Survey(job) => Some(job.clone()),
        _ => None,
    });
    let job = jobs.next().expect("a survey");
    assert!(jobs.next().is_none(), "{effects:?}");
    job
}

fn ends(effects: &[Effect]) -> bool {
    effects.iter().any(|effect| matches!(effect, Effect::EndSurvey(_)))
}

fn ask(state: &mut AppState, c: char) -> SurveyJob {
    job(&press(state, c))
}

fn reply(state: &mut AppState, revision: u64, news: SurveyNews) {
    update(state, Msg::Survey(SurveyReply { revision, news }));
}

/// Returns a second of a flight around a square of 60 m. It is fatal on the second leg, and the craft lands off on the third.
fn point(second: u32) -> SweepPoint {
    let along = f64::from(second);
    let (north, east) = match second {
        0..30 => (2.0 * along, 0.0),
        30..60 => (60.0, 2.0 * (along - 30.0)),
        60..90 => (60.0 - 2.0 * (along - 60.0), 60.0),
        _ => (0.0, 60.0 - 2.0 * (along - 90.0)),
    };
    let (fate, result) = match second {
        40..45 => (Fate::Lost, FlightResult::Crashed),
        65..80 => (Fate::Off, FlightResult::Landed),
        _ => (Fate::Home, FlightResult::Complete),
    };
    SweepPoint {
        second,
        place_enu: [east, north, 20.0],
        fate,
        result,
        reason: "the craft crashed".to_owned(),
        off_m: 10.0,
        after_s: 5.0,
    }
}

fn fly(state: &mut AppState, revision: u64, seconds: std::ops::Range<u32>) {
    for second in seconds {
        reply(state, revision, SurveyNews::Point(Box::new(point(second))));
    }
}

/// Returns a screen with a whole sweep.
fn swept(size: (u16, u16), theme: betadeck::ui::Theme) -> AppState {
    let mut state = state_with_fix(size);
    state.shared.theme = theme;
    let asked = ask(&mut state, 'M');
    fly(&mut state, asked.revision, 0..120);
    reply(&mut state, asked.revision, SurveyNews::SweepEnd);
    state
}

#[test]
fn a_fault_at_every_second_colours_map_and_timeline_at_four_sizes() {
    let seen = SIZES.map(|size| {
        let mut state = swept(size, fixture::colour());
        let noticed = state.shared.notice.as_ref().map(|notice| notice.text.clone()).unwrap_or_default();
        assert_eq!(
            noticed,
            "gps-loss,6 at every second: · 100 home, o 15 landed off, X 5 lost; lost between 0:40 and 0:44."
        );
        // The notice covers the last row of a small map.
        keys(&mut state, "esc");
        let later = state.shared.now + std::time::Duration::from_secs(60);
        let asked = ask(&mut state, 'M');
        fly(&mut state, asked.revision, 0..120);
        reply(&mut state, asked.revision, SurveyNews::SweepEnd);
        update(&mut state, Msg::Clock(later));
        screen(&state)
    });
    for seen in &seen {
        assert!(seen.contains("XX") && seen.contains("oo") && seen.contains("X 5"), "{seen}");
    }
    insta::assert_snapshot!(seen.join("\n"));
}

#[test]
fn without_colours_and_special_characters_the_fates_are_letters() {
    let seen = screen(&swept((80, 24), fixture::plain()));
    assert!(seen.contains("oo") && seen.contains("X 5 ") && seen.contains("X 5 lost"), "{seen}");
    assert!(seen.is_ascii(), "{seen}");
}

#[test]
fn a_sweep_shows_what_it_has_so_far() {
    let mut state = state_with_fix((120, 40));
    let asked = ask(&mut state, 'M');
    assert_eq!(asked.request, SurveyRequest::Sweep("gps-loss@0,6".parse().expect("a fault")));
    assert_eq!(asked.plan.plan, *state.shared.plan());
    fly(&mut state, asked.revision, 0..42);
    let seen = screen(&state);
    assert!(seen.contains("· 40 home, o 0 landed off, X 2 lost so far…"), "{seen}");
    // Replies to another request do not count.
    reply(&mut state, asked.revision + 7, SurveyNews::Point(Box::new(point(70))));
    assert!(screen(&state).contains("o 0 landed off"));
}

#[test]
fn the_flights_end_by_esc_by_the_key_by_ctrl_c_and_by_an_edit() {
    for ending in ["esc", "M", "ctrl-c"] {
        let mut state = state_with_fix((120, 40));
        let asked = ask(&mut state, 'M');
        fly(&mut state, asked.revision, 0..10);
        let effects = keys(&mut state, ending);
        assert!(ends(&effects), "{ending}: {effects:?}");
        assert!(!screen(&state).contains("at every second"), "{ending}");
        // A reply that was on its way changes nothing.
        fly(&mut state, asked.revision, 10..20);
        assert!(!screen(&state).contains("at every second"), "{ending}");
    }
    let mut state = state_with_fix((120, 40));
    ask(&mut state, 'M');
    let effects = keys(&mut state, "2 d");
    assert!(ends(&effects), "{effects:?}");
    assert!(state.shared.notice.as_ref().is_some_and(|notice| notice.text.contains("has changed")));
}

#[test]
fn any_fault_is_asked_for_by_its_name_and_the_key_repeats_it() {
    let mut state = state_with_fix((120, 40));
    let asked = job(&run_line(&mut state, "where motor,,1:0.5").expect("a sweep"));
    let fault = SurveyRequest::Sweep("motor@0,,1:0.5".parse().expect("a fault"));
    assert_eq!(asked.request, fault);
    keys(&mut state, "M");
    assert_eq!(ask(&mut state, 'M').request, fault);
    for (line, part) in
        [("where gps-loss@3", "leave the time out"), ("where gps-los", "did you mean gps-loss")]
    {
        let problem = run_line(&mut state, line).expect_err("a refusal");
        assert!(problem.contains(part), "{line}: {problem}");
    }
}

fn record(number: u64, wind_mps: f64) -> Record {
    let passed = wind_mps < 8.0;
    Record {
        number,
        side: Side::A,
        seed: number,
        inputs: vec![("wind_mps".to_owned(), InputValue::Number(wind_mps))],
        standing: if passed { Standing::Passed } else { Standing::Failed },
        problem: None,
        result: if passed { "complete" } else { "crashed" }.to_owned(),
        reason: "the craft crashed".to_owned(),
        failures: Vec::new(),
        margin: None,
        worst_at: None,
        metrics: vec![("battery_left".to_owned(), 0.9), ("fence_margin".to_owned(), 12.5)],
        flown_s: 60.0,
        hash: number,
    }
}

#[test]
fn the_last_what_if_flies_a_hundred_flights_and_answers_in_a_line() {
    let text = "format = 1\n[plan]\nbuiltin = \"square\"\n";
    let scenario = read("square.toml", text, None, &mut BuiltinFiles).expect("a scenario");
    let mut answer = Forecast::new(&scenario, Forecast::FLIGHTS, Forecast::RESERVE);
    (1..=100).for_each(|number| answer.add(record(number, number as f64 / 10.0)));
    let seen = SIZES.map(|size| {
        let mut state = state_with_fix(size);
        keys(&mut state, "w");
        for _ in WHAT_IFS {
            key(&mut state, KeyCode::Down);
        }
        let asked = job(&key(&mut state, KeyCode::Enter));
        assert_eq!(asked.request, SurveyRequest::GoNoGo);
        for flown in 1..=37 {
            reply(&mut state, asked.revision, SurveyNews::Flown(flown));
        }
        assert!(screen(&state).contains("go or no-go: 37 of 100 flights"), "{}", screen(&state));
        reply(&mut state, asked.revision, SurveyNews::GoNoGo(Box::new(answer.answer())));
        let noticed = state.shared.notice.as_ref().map(|notice| notice.text.clone()).unwrap_or_default();
        assert!(
            noticed.starts_with("NO-GO 79.0 %: 79 of 100 complete with more than 20 % left; "),
            "{noticed}"
        );
        assert!(
            noticed.contains("; to change: wait for a wind of at most ")
                && noticed.contains("at least 12.5 m from the fence")
        );
        let shown = screen(&state);
        assert!(shown.contains("wait for a wind"), "{shown}");
        shown
    });
    insta::assert_snapshot!(seen.join("\n"));
}

#[test]
fn without_a_plan_nothing_is_flown() {
    let mut state = fixture::state((80, 24), fixture::colour());
    let empty = fixture::state_after(
        (80, 24),
        fixture::colour(),
        betadeck::plan::FlightPlan::default(),
        betadeck::ui::EnteredLines::default(),
    );
    state.shared.editor = empty.shared.editor;
    for key in ["M", "ctrl-g"] {
        assert!(keys(&mut state, key).iter().all(|effect| !matches!(effect, Effect::Survey(_))));
        assert!(state.shared.notice.as_ref().is_some_and(|notice| notice.text.contains("nothing to fly")));
    }
}

#[test]
fn a_plan_that_fails_anyway_is_not_blamed_on_the_fault() {
    let mut state = state_with_fix((120, 40));
    let effects = keys(&mut state, "2 right right right +");
    let revision = effects.iter().rev().find_map(|effect| match effect {
        Effect::Forecast(ForecastJob { revision, .. }) => Some(*revision),
        _ => None,
    });
    let forecast = flight_ahead::Forecast {
        kind: ForecastKind::PlanEstimate,
        end: ForecastEnd::Flight(FlightResult::Aborted),
        reason: "the mission was given up".to_owned(),
        time_s: 40.0,
        battery_used_pct: 5.0,
        worst_xte: None,
        fence_margin_m: None,
        legs: Vec::new(),
        moved_m: 10.0,
        path: Vec::new(),
        unchanged: None,
    };
    let revision = revision.expect("an estimate is asked for");
    let forecast = Ok(Box::new(forecast));
    update(&mut state, Msg::Forecast(ForecastReply { revision, kind: ForecastKind::PlanEstimate, forecast }));
    let asked = ask(&mut state, 'M');
    fly(&mut state, asked.revision, 40..45);
    reply(&mut state, asked.revision, SurveyNews::SweepEnd);
    let noticed = state.shared.notice.as_ref().map(|notice| notice.text.clone()).unwrap_or_default();
    assert!(noticed.ends_with("The plan fails without the fault, too."), "{noticed}");
}
