use super::*;
use crate::geo::LatLon;
use crate::lookahead::ForecastRequest;
use crate::plan::{Waypoint, WaypointType};
use crate::session::{Command, SessionView};
use crate::telemetry::InFlightCommand;
use crate::ui::model::action::{Action, EditAction};
use crate::ui::model::editor::{Browser, Purpose};
use crate::ui::model::files::{FileReply, FileRequest};
use crate::ui::model::plan_id::PlanId;
use crate::ui::update::perform;
use crate::vehicle::VehicleCommand;

fn state() -> AppState {
    let mut state = AppState::bare((80, 24), SessionView::default());
    let vehicle = std::sync::Arc::make_mut(&mut state.shared.view.vehicle);
    vehicle.craft.home = Some(LatLon::new(404_635_000, -795_182_000));
    let mut plan = crate::plan::FlightPlan::default();
    for kind in [WaypointType::Flyover, WaypointType::AltChange, WaypointType::Land] {
        plan.waypoints.push(Waypoint { kind, ..Waypoint::default() });
    }
    vehicle.stored_plan = Some(plan);
    state
}

fn asked(state: &mut AppState) -> Vec<String> {
    question(state).expect("a question")
}

#[test]
fn a_waypoint_to_go_to_is_chosen_by_its_number() {
    let mut state = state();
    perform(&mut state, Action::GoTo);
    assert_eq!(asked(&mut state), ["Go now to which waypoint?", "0 FLYOVER", "2 LAND", NONE]);
    assert!(answer(&mut state, "1").unwrap_err().contains("the craft has 0, 2."));
    assert!(question(&mut state).is_some(), "it is still asked");
    let answered = answer(&mut state, " 2 ").unwrap();
    assert!(matches!(
        answered.effects[..],
        [Effect::Send(Command::Vehicle(VehicleCommand::InFlight(InFlightCommand::GoTo(2))))]
    ));
    assert_eq!(question(&mut state), None);
    perform(&mut state, Action::GoTo);
    assert!(answer(&mut state, "").unwrap().effects.is_empty() && question(&mut state).is_none());
}

#[test]
fn which_plan_is_flown_is_answered_by_a_letter() {
    let mut state = state();
    let waypoint = Waypoint { kind: WaypointType::Flyover, ..Waypoint::default() };
    state.shared.editor.insert("insert", &[waypoint]).expect("room for a waypoint");
    assert!(perform(&mut state, Action::Fly).is_empty());
    let lines = asked(&mut state);
    let choices = "Answer y upload, fly, c fly the craft's, n do not fly.";
    assert!(lines[0].contains("The plan in the craft is not") && lines[0].ends_with(choices), "{lines:?}");
    answer(&mut state, "n").unwrap();
    assert_eq!(question(&mut state), None);
}

#[test]
fn what_may_go_wrong_is_chosen_by_number_or_name() {
    for line in ["1", "gps-loss"] {
        let mut state = state();
        perform(&mut state, Action::WhatIf);
        assert_eq!(asked(&mut state)[1], "1 GPS lost here");
        assert!(answer(&mut state, "gps-los").unwrap_err().contains("did you mean gps-loss?"));
        let effects = answer(&mut state, line).unwrap().effects;
        let [Effect::Forecast(job)] = &effects[..] else { panic!("{effects:?}") };
        assert!(matches!(&job.request, ForecastRequest::WhatIf { what_if, .. } if *what_if == WHAT_IFS[0]));
    }
}

#[test]
fn a_form_takes_its_values_line_by_line() {
    let mut state = state();
    perform(&mut state, Action::Edit(EditAction::Generate));
    let lines = asked(&mut state);
    assert_eq!(lines[0], "Generate a pattern.");
    assert_eq!(lines[1], "1 shape = square (square, circle, zig-zag, survey)");
    for (line, part) in [
        ("shape = hexagon", "choose square, circle, zig-zag, survey"),
        ("colour = red", "NAME = VALUE"),
        ("99 = 1", "NAME = VALUE"),
        ("length", "NAME = VALUE"),
    ] {
        let refusal = answer(&mut state, line).unwrap_err();
        assert!(refusal.contains(part), "{line}: {refusal}");
    }
    let reported = answer(&mut state, "shape = circle").unwrap().reported.unwrap();
    assert!(reported.starts_with("shape = circle: ") && reported.ends_with(" waypoints."), "{reported}");
    let reported = answer(&mut state, "2 = wide").unwrap().reported.unwrap();
    assert_eq!(reported, "length = wide: length: wide is not a number.");
    assert_eq!(answer(&mut state, "take").unwrap_err(), "length: wide is not a number.");
    answer(&mut state, "length = 80").unwrap();
    let effects = answer(&mut state, "take").unwrap().effects;
    assert!(!effects.is_empty() && question(&mut state).is_none());
    assert!(state.shared.plan().waypoints.len() > 3, "{:?}", state.shared.plan());
}

#[test]
fn files_are_chosen_by_number_or_name_once_the_directory_was_read() {
    let listing = || crate::ui::model::files::Listing {
        directory: "/plans".into(),
        entries: [("deep", true), ("orbit.toml", false), ("square.toml", false)]
            .map(|(name, is_directory)| crate::ui::model::files::Entry {
                name: name.to_owned(),
                is_directory,
            })
            .to_vec(),
    };
    for (line, wanted) in [("3", "/plans/square.toml"), ("orbit", "/plans/orbit.toml")] {
        let mut state = state();
        perform(&mut state, Action::Edit(EditAction::Open));
        assert_eq!(question(&mut state), None);
        update(&mut state, Msg::Files(FileReply::Listed(listing())));
        assert_eq!(asked(&mut state)[..3], ["Open which plan of /plans?", "1 deep/", "2 orbit.toml"]);
        let effects = answer(&mut state, line).unwrap().effects;
        let [Effect::Files(FileRequest::Open { path, .. })] = &effects[..] else { panic!("{effects:?}") };
        assert_eq!(path.to_str(), Some(wanted));
        assert_eq!(question(&mut state), None);
    }
    let mut state = state();
    let browser =
        Browser { listing: listing(), ..Browser::new(Purpose::Save(PlanId::default()), "new.toml") };
    state.shared.editor.popup = Some(EditorPopup::Browser(browser));
    assert_eq!(asked(&mut state)[0], "Save as which file in /plans?");
    let effects = answer(&mut state, "1").unwrap().effects;
    assert!(matches!(&effects[..], [Effect::Files(FileRequest::List(Some(_)))]), "{effects:?}");
    let effects = answer(&mut state, "mine").unwrap().effects;
    let [Effect::Files(FileRequest::Save { path, .. })] = &effects[..] else { panic!("{effects:?}") };
    assert_eq!(path.to_str(), Some("/plans/mine.toml"));
}

#[test]
fn unsaved_plans_are_asked_for_and_quitting_twice_keeps_them() {
    let mut state = state();
    state.shared.editor.edit("a name", |document| document.name = "mine".to_owned());
    let ask = |state: &mut AppState| {
        assert!(perform(state, Action::Quit).is_empty());
        let lines = asked(state);
        assert!(lines[0].starts_with("mine has edits that no file holds. Answer s save, d discard, y quit, keep the edits for later, n stay;"));
    };
    ask(&mut state);
    assert_eq!(
        answer(&mut state, "what").unwrap_err(),
        "Answer s save, d discard, y quit, keep the edits for later, n stay."
    );
    assert!(answer(&mut state, "stay").unwrap().effects.is_empty() && question(&mut state).is_none());
    ask(&mut state);
    assert!(matches!(answer(&mut state, "quit").unwrap().effects[..], [Effect::Quit]));
    ask(&mut state);
    let effects = answer(&mut state, "d").unwrap().effects;
    assert!(matches!(effects[..], [.., Effect::Quit]), "{effects:?}");
}

#[test]
fn edits_that_cannot_be_kept_are_not_offered_for_later() {
    let mut state = state();
    update(&mut state, Msg::Files(FileReply::NotKept("No space is left.".to_owned())));
    state.shared.editor.edit("a name", |document| document.name = "mine".to_owned());
    assert!(perform(&mut state, Action::Quit).is_empty());
    assert_eq!(
        asked(&mut state),
        [
            "mine has edits that no file holds, and they cannot be kept for later. Answer s save, d discard, n stay."
        ]
    );
    for line in ["quit", "y"] {
        assert_eq!(answer(&mut state, line).unwrap_err(), "Answer s save, d discard, n stay.");
        assert!(question(&mut state).is_some(), "{line}");
    }
    update(&mut state, Msg::Files(FileReply::KeptAgain));
    assert!(matches!(answer(&mut state, "y").unwrap().effects[..], [Effect::Quit]));
}

#[test]
fn an_armed_craft_is_asked_about() {
    let mut state = state();
    std::sync::Arc::make_mut(&mut state.shared.view.vehicle).craft.armed = Some(true);
    perform(&mut state, Action::Quit);
    assert!(asked(&mut state)[0].contains("armed"));
    assert!(answer(&mut state, "perhaps").is_err());
    assert!(answer(&mut state, "n").unwrap().effects.is_empty() && question(&mut state).is_none());
    perform(&mut state, Action::Quit);
    assert!(matches!(answer(&mut state, "y").unwrap().effects[..], [Effect::Quit]));
}
