//! Slow uploads and downloads, and notices that must be read: messages in, screen out.

use std::time::Duration;

use betadeck::fc::UploadReport;
use betadeck::fc::UploadView;
use betadeck::session::Command;
use betadeck::ui::PlanId;
use betadeck::ui::files::FileReply;
use betadeck::ui::{AppState, Effect, Msg, Severity, update};

use crate::ui::hands::{keys, screen, state_with_fix as state};
use crate::ui::{fixture, hands};

/// Shows the progress of an upload.
fn progress(state: &mut AppState, upload: Option<(usize, usize)>) {
    let mut view = state.shared.view.clone();
    view.upload = upload.map(|(sent, total)| UploadView { sent, total });
    update(state, Msg::View(view));
}

/// Presses the upload key and returns the ID of the uploaded plan.
fn upload(state: &mut AppState) -> PlanId {
    let effects = keys(state, "U");
    let mut ids = effects.iter().filter_map(|effect| match effect {
        Effect::Upload { id, .. } => Some(*id),
        _ => None,
    });
    ids.next_back().unwrap_or_else(|| panic!("{effects:?}"))
}

#[test]
fn the_plan_panel_shows_how_far_the_upload_is_until_the_craft_was_read_back() {
    for size in [(80, 24), (120, 40)] {
        let mut state = state(size);
        keys(&mut state, "2 +");
        let id = upload(&mut state);
        progress(&mut state, Some((3, 12)));
        assert!(screen(&state).contains("↑ uploading 3/12"), "{}", screen(&state));
        assert!(keys(&mut state, "U").is_empty(), "one after the other");
        assert!(screen(&state).contains("line 3 of 12: wait for its end"), "{}", screen(&state));
        assert!(keys(&mut state, "F").is_empty(), "no second upload before the flight");
        // The other plan is not being uploaded.
        keys(&mut state, "n i");
        assert!(!screen(&state).contains("uploading"), "{}", screen(&state));
        keys(&mut state, "(");
        assert!(screen(&state).contains("uploading 3/12"), "{}", screen(&state));
        progress(&mut state, None);
        update(&mut state, Msg::UploadReply { id, count: 4, result: Ok(UploadReport::default()) });
        let seen = screen(&state);
        assert!(
            seen.contains("✓ Uploaded square.toml: 4 waypoints.") && !seen.contains("uploading"),
            "{seen}"
        );
    }
}

#[test]
fn a_conversion_of_altitudes_is_said() {
    let mut state = state((120, 40));
    let id = upload(&mut state);
    update(
        &mut state,
        Msg::UploadReply {
            id,
            count: 4,
            result: Ok(UploadReport { added_m: 300.5, ..UploadReport::default() }),
        },
    );
    let seen = screen(&state);
    assert!(
        seen.contains("✓ Uploaded square.toml: 4 waypoints. Its firmware counts altitudes from sea level"),
        "{seen}"
    );
    assert!(seen.contains("300.5 m were added"), "{seen}");
}

#[test]
fn what_reading_back_finds_is_said() {
    let mut state = state((80, 24));
    let id = upload(&mut state);
    let result = Err("waypoint 1 on the craft differs from the one sent: upload again".to_owned());
    update(&mut state, Msg::UploadReply { id, count: 4, result });
    let seen = screen(&state);
    assert!(seen.contains("✗ Uploading square.toml failed: waypoint 1 on the craft differs"), "{seen}");
    assert!(seen.contains("upload again"), "{seen}");
}

#[test]
fn an_answer_goes_to_the_plan_that_asked_wherever_it_is_by_then() {
    let mut state = state((120, 40));
    keys(&mut state, "2 +");
    let edited = state.shared.plan().clone();
    let [Effect::Download(id)] = keys(&mut state, "D")[..] else { panic!("a download") };
    keys(&mut state, "n");
    let effects = update(&mut state, Msg::DownloadReply { id, result: Ok(Box::new(fixture::square())) });
    assert_eq!(hands::journal_lines(&effects), 1);
    assert!(state.shared.plan().waypoints.is_empty(), "the new plan did not ask");
    assert!(screen(&state).contains("Downloaded 4 waypoints into square.toml."), "{}", screen(&state));
    keys(&mut state, "(");
    assert_eq!(*state.shared.plan(), fixture::square());
    keys(&mut state, "u");
    assert_eq!(*state.shared.plan(), edited);

    let id = upload(&mut state);
    keys(&mut state, ")");
    update(&mut state, Msg::UploadReply { id, count: 4, result: Ok(UploadReport::default()) });
    assert!(screen(&state).contains("Uploaded square.toml: 4 waypoints."), "{}", screen(&state));
}

#[test]
fn a_plan_that_is_closed_takes_nothing_in_and_neither_does_the_next() {
    let mut state = state((120, 40));
    keys(&mut state, "2 n");
    let closed = state.shared.editor.plan().id();
    let [Effect::Download(id)] = keys(&mut state, "D")[..] else { panic!("a download") };
    assert_eq!(id, closed);
    keys(&mut state, "ctrl-w n");
    assert_ne!(state.shared.editor.plan().id(), closed, "no plan had this identifier before");
    let effects = update(&mut state, Msg::DownloadReply { id, result: Ok(Box::new(fixture::square())) });
    assert_eq!(hands::journal_lines(&effects), 0);
    assert!(state.shared.plan().waypoints.is_empty());
    assert!(screen(&state).contains("the plan that was to receive it is closed"), "{}", screen(&state));
}

#[test]
fn what_went_wrong_stays_while_keys_are_pressed_until_esc_or_its_time_is_over() {
    let mut state = state((80, 24));
    let reported = "Edits cannot be kept in /state: no space. Save often.";
    update(&mut state, Msg::Files(FileReply::NotKept(reported.to_owned())));
    keys(&mut state, "2 + + j");
    assert!(screen(&state).contains("Save often."), "{}", screen(&state));
    keys(&mut state, "esc");
    let seen = screen(&state);
    assert!(
        !seen.contains("Save often.") && seen.contains("✗ edits not kept"),
        "as long as it holds: {seen}"
    );
    update(&mut state, Msg::Files(FileReply::KeptAgain));
    assert!(!screen(&state).contains("edits not kept"), "{}", screen(&state));
    // Other notices end with the next key.
    state.shared.notify(Severity::Warn, "Only a word.");
    keys(&mut state, "j");
    assert!(!screen(&state).contains("Only a word."), "{}", screen(&state));
    state.shared.notify(Severity::Fault, "It failed.");
    let later = state.shared.now + Duration::from_secs(60);
    update(&mut state, Msg::Clock(later));
    keys(&mut state, "j");
    assert!(!screen(&state).contains("It failed."), "{}", screen(&state));
}

/// Returns `true` if the effects start the scripted pilot.
fn starts_pilot(effects: &[Effect]) -> bool {
    effects.iter().any(|effect| matches!(effect, Effect::Send(Command::StartPilot)))
}

#[test]
fn f_after_an_edit_asks_which_plan_it_flies() {
    for size in [(80, 24), (120, 40), (200, 60)] {
        let mut state = state(size);
        assert!(starts_pilot(&keys(&mut state, "F")), "the craft has the open plan");
        keys(&mut state, "2 +");
        assert!(screen(&state).contains("F asks: the craft does"), "{}", screen(&state));
        assert!(!starts_pilot(&keys(&mut state, "F")), "nothing flies before the answer");
        let seen = screen(&state);
        assert!(seen.contains("The plan in the craft is not square.toml."), "{seen}");
        assert!(seen.contains("y upload, fly") && seen.contains("c fly the craft's"), "{seen}");
        assert!(keys(&mut state, "esc").is_empty() && !screen(&state).contains("Fly which plan?"));
        keys(&mut state, "F");
        assert!(starts_pilot(&keys(&mut state, "c")));
        keys(&mut state, "F");
        let effects = keys(&mut state, "y");
        let [Effect::Upload { id, plan, .. }] = &effects[..] else { panic!("{effects:?}") };
        assert_eq!(**plan, *state.shared.plan());
        let result = Ok(UploadReport::default());
        assert!(starts_pilot(&update(&mut state, Msg::UploadReply { id: *id, count: 4, result })));
        keys(&mut state, "F");
        assert!(screen(&state).contains("edited since its upload"), "{}", screen(&state));
    }
}

/// Returns a screen whose open plan has these settings, on a craft that has another plan.
fn with_settings(lines: &[&str]) -> AppState {
    let mut state = state((120, 40));
    let mut document = state.shared.editor.document().clone();
    document.settings = lines.iter().map(|line| (*line).to_owned()).collect();
    let history = betadeck::plan::edit::History::new(document, true);
    let plan = betadeck::ui::editor::OpenPlan::new(PlanId(7), None, history);
    state.shared.editor = betadeck::ui::editor::Editor::new(plan);
    state
}

#[test]
fn f_with_an_edited_fence_names_the_fence_that_it_replaces() {
    let mut state = with_settings(&["ap_max_distance_from_home = 150", "ap_geofence_action = RTH"]);
    keys(&mut state, "2 + F");
    let seen = screen(&state);
    assert!(seen.contains("The plan sets the") && seen.contains("fence to 150 m (it was 500 m)."), "{seen}");
    assert!(seen.contains("fence to RTH."), "{seen}");
}

#[test]
fn a_first_upload_says_before_it_that_it_sets_a_fence_where_there_was_none() {
    let mut state = with_settings(&["ap_max_distance_from_home = 150"]);
    let vehicle = std::sync::Arc::make_mut(&mut state.shared.view.vehicle);
    vehicle.stored_plan.as_mut().expect("a plan").waypoints.clear();
    vehicle.settings.as_mut().expect("settings").fence_m = None;
    let seen: String =
        screen(&state).split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
    assert!(seen.contains("The craft has no plan.") && seen.contains("sets a fence of 150 m"), "{seen}");
}
