//! Settings of the craft that change while a plan is open: estimates and findings use the settings of the flight.

#![allow(clippy::unwrap_used, reason = "tests may panic")]

use std::sync::Arc;

use betadeck::fc::UploadReport;
use betadeck::flight::forecast::{FlightResult, Forecast, ForecastEnd, ForecastKind};
use betadeck::lookahead::{ForecastReply, ForecastRequest};
use betadeck::plan::edit::{History, PlanDocument};
use betadeck::plan::estimate::Assumptions;
use betadeck::telemetry::snapshot::SettingsView;
use betadeck::ui::PlanId;
use betadeck::ui::files::{FileReply, Opened};
use betadeck::ui::{AppState, Effect, Msg, update};

use crate::ui::fixture;
use crate::ui::hands::{keys, screen, state_with_fix};

/// Returns the text of the Plan panel, with its lines joined.
fn said(state: &AppState) -> String {
    let screen = screen(state);
    let lines: Vec<Vec<char>> = screen.lines().map(|line| line.chars().collect()).collect();
    let title: Vec<char> = "▸2 Plan".chars().collect();
    let is_title = |line: &Vec<char>| line.windows(title.len()).position(|at| at == title);
    let (top, left) = lines.iter().enumerate().find_map(|(row, line)| Some((row, is_title(line)?))).unwrap();
    let inside = lines[top + 1..].iter().take_while(|line| line[left - 1] == '│');
    let words = inside.flat_map(|line| {
        let text: String = line[left..].iter().take_while(|c| **c != '│').collect();
        text.split_whitespace().map(str::to_owned).collect::<Vec<_>>()
    });
    words.collect::<Vec<_>>().join(" ")
}

/// Opens a square that asks for a fence of 500 m, on a craft that has another plan.
fn open(size: (u16, u16)) -> AppState {
    let mut state = state_with_fix(size);
    let document = PlanDocument {
        name: "square".to_owned(),
        plan: fixture::square(),
        settings: vec!["ap_max_distance_from_home = 500".to_owned(), "ap_max_angle = 25".to_owned()],
        ..PlanDocument::default()
    };
    let opened = Opened {
        id: PlanId(7),
        file: Some("square.toml".into()),
        history: History::new(document, true),
        notes: Vec::new(),
        recovered: false,
    };
    update(&mut state, Msg::Files(FileReply::Opened(Box::new(opened))));
    keys(&mut state, "2");
    state
}

/// Sets the craft's fence. Returns the settings lines of the next estimate request, if there is one.
fn set_fence(state: &mut AppState, fence_m: f64) -> Option<Vec<String>> {
    estimate_of(&change(state, |settings| settings.fence_m = Some(fence_m)))
}

fn change(state: &mut AppState, change: impl FnOnce(&mut SettingsView)) -> Vec<Effect> {
    let mut view = state.shared.view.clone();
    let vehicle = Arc::make_mut(&mut view.vehicle);
    vehicle.time.0 += 20_000;
    change(vehicle.settings.as_mut().unwrap());
    update(state, Msg::View(view))
}

fn estimate_of(effects: &[Effect]) -> Option<Vec<String>> {
    effects.iter().find_map(|effect| match effect {
        Effect::Forecast(job) => match &job.request {
            ForecastRequest::PlanEstimate { settings, .. } => Some(settings.clone()),
            other => panic!("{other:?}"),
        },
        _ => None,
    })
}

fn upload(state: &mut AppState) {
    let effects = keys(state, "U");
    let sent = effects.iter().find_map(|effect| match effect {
        Effect::Upload { id, plan, .. } => Some((*id, (**plan).clone())),
        _ => None,
    });
    let (id, plan) = sent.unwrap();
    let count = plan.waypoints.len();
    let mut view = state.shared.view.clone();
    Arc::make_mut(&mut view.vehicle).stored_plan = Some(plan);
    update(state, Msg::View(view));
    update(state, Msg::UploadReply { id, count, result: Ok(UploadReport::default()) });
}

#[test]
fn a_fence_set_on_the_craft_after_the_upload_counts_and_is_reported() {
    let mut state = open((120, 40));
    upload(&mut state);
    assert!(!said(&state).contains("refused"), "{}", said(&state));
    assert_eq!(set_fence(&mut state, 82.0), Some(Vec::new()), "flown with what the craft has");
    let seen = said(&state);
    assert!(
        seen.contains("refused: waypoint 2 is 88 m from home")
            && seen.contains("the craft's ap_max_distance_from_home is 82 m"),
        "{seen}"
    );
    assert_eq!(set_fence(&mut state, 90.0), Some(Vec::new()));
    let seen = said(&state);
    assert!(
        seen.contains("the plan sets ap_max_distance_from_home = 500, the craft has another value"),
        "{seen}"
    );
    // The next upload sets the fence of the plan again.
    let mut view = state.shared.view.clone();
    Arc::make_mut(&mut view.vehicle).stored_plan = None;
    update(&mut state, Msg::View(view));
    let seen = said(&state);
    assert!(!seen.contains("another value") && !seen.contains("refused"), "{seen}");
}

#[test]
fn the_estimate_says_whose_fence_it_keeps_to() {
    let mut state = open((120, 40));
    let answer = |state: &mut AppState, effects: &[Effect]| {
        let job = effects.iter().find_map(|effect| match effect {
            Effect::Forecast(job) => Some(job.clone()),
            _ => None,
        });
        let forecast = Forecast {
            kind: ForecastKind::PlanEstimate,
            end: ForecastEnd::Flight(FlightResult::Complete),
            reason: String::new(),
            time_s: 221.2,
            battery_used_pct: 38.4,
            worst_xte: None,
            fence_margin_m: Some(7.0),
            legs: Vec::new(),
            moved_m: 86.0,
            path: Vec::new(),
            unchanged: None,
        };
        let forecast = Ok(Box::new(forecast));
        let revision = job.unwrap().revision;
        update(state, Msg::Forecast(ForecastReply { revision, kind: ForecastKind::PlanEstimate, forecast }));
    };
    let mut view = state.shared.view.clone();
    Arc::make_mut(&mut view.vehicle).stored_plan = None;
    update(&mut state, Msg::View(view));
    let effects = change(&mut state, |settings| settings.fence_m = Some(82.0));
    answer(&mut state, &effects);
    assert!(said(&state).contains("fence 7 m left (plan)"), "{}", said(&state));
    upload(&mut state);
    let effects = change(&mut state, |settings| settings.fence_m = Some(95.0));
    answer(&mut state, &effects);
    assert!(said(&state).contains("fence 7 m left (craft)"), "{}", said(&state));
    let effects = change(&mut state, |settings| settings.fence_m = Some(500.0));
    answer(&mut state, &effects);
    assert!(said(&state).contains("fence 7 m left"), "{}", said(&state));
    assert!(!said(&state).contains("fence 7 m left ("), "there is only one: {}", said(&state));
}

#[test]
fn a_plan_that_is_to_be_uploaded_sets_its_fence() {
    let mut state = open((120, 40));
    keys(&mut state, "+");
    let settings = set_fence(&mut state, 82.0).unwrap();
    assert_eq!(settings, state.shared.editor.document().settings);
    assert!(!said(&state).contains("refused"), "{}", said(&state));
    // A plan without a fence of its own keeps the craft's fence.
    keys(&mut state, "n");
    let lines = "waypoint insert 0 40.4645000 -79.5182000 2000 0 LAND 0 NONE";
    update(&mut state, Msg::Paste(lines.to_owned()));
    let seen = said(&state);
    assert!(seen.contains("the craft's ap_max_distance_from_home is 82 m"), "{seen}");
}

#[test]
fn an_edit_of_the_fence_counts_before_the_upload() {
    let mut state = open((120, 40));
    upload(&mut state);
    set_fence(&mut state, 90.0);
    let mut lines = state.shared.editor.document().settings.clone();
    lines[0] = "ap_max_distance_from_home = 70".to_owned();
    let document = PlanDocument { settings: lines.clone(), ..state.shared.editor.document().clone() };
    let opened = Opened {
        id: PlanId(7),
        file: None,
        history: History::new(document, true),
        notes: Vec::new(),
        recovered: false,
    };
    let effects = update(&mut state, Msg::Files(FileReply::Opened(Box::new(opened))));
    assert_eq!(estimate_of(&effects), Some(vec![lines[0].clone()]));
    let seen = said(&state);
    assert!(seen.contains("the plan's ap_max_distance_from_home, set at the upload, is 70 m"), "{seen}");
}

#[test]
fn the_picture_of_the_craft_has_all_that_estimates_need() {
    let mut firmware = betadeck::firmware::Firmware::new(
        betadeck::firmware::config::Configuration::default(),
        betadeck::firmware::FirmwareOptions::default(),
    );
    for name in Assumptions::SETTINGS {
        let mut console = betadeck::firmware::cli::Interpreter::default();
        let before = firmware.settings_view().assumptions();
        let field = betadeck::autopilot::params::Params::field(name).unwrap();
        let other = if field.default == field.max { field.min } else { field.max };
        let reply = firmware.run_cli(&mut console, &format!("set {name} = {other}"));
        assert!(!reply.failed, "{name}: {reply:?}");
        let now = firmware.settings_view().assumptions();
        assert_ne!(now, before, "{name}");
        assert_eq!(now, before.with_settings(&[format!("{name} = {other}")]), "{name}");
    }
}
