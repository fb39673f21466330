//! The plan editor by keys, mouse and paste: messages in, screen and effects out.

use betadeck::plan::{Altitude, FlightPlan, Seconds, WaypointType};
use betadeck::ui::files::{Entry, FileReply, FileRequest, Listing};
use betadeck::ui::{Effect, Msg, update};
use crossterm::event::MouseEventKind;

use crate::ui::fixture;
use crate::ui::hands::{
    journal_lines, keys, mouse, mouse_button, place_in_profile, place_of, press, screen,
    state_with_fix as state,
};

/// Returns the request to write a plan, from the effects.
pub(crate) fn save_of(effects: Vec<Effect>) -> FileRequest {
    let requests = effects.into_iter().filter_map(|effect| match effect {
        Effect::Files(request @ FileRequest::Save { .. }) => Some(request),
        _ => None,
    });
    requests.last().expect("a plan to write")
}

pub(crate) fn altitudes(plan: &FlightPlan) -> Vec<i32> {
    plan.records().iter().map(|wp| wp.alt_cm).collect()
}

#[test]
fn a_value_is_typed_undone_and_redone() {
    let mut state = state((80, 24));
    let effects = keys(&mut state, "2 down right right right enter backspace backspace '62.5 enter");
    assert_eq!(altitudes(state.shared.plan()), [5000, 6250, 5000, 5000]);
    assert_eq!(journal_lines(&effects), 1, "one edit, one line");
    assert!(screen(&state).contains("[62.5]") && screen(&state).contains("unsaved"));
    keys(&mut state, "u");
    assert_eq!(altitudes(state.shared.plan()), [5000; 4]);
    assert!(!screen(&state).contains("unsaved"), "back at what the file holds");
    keys(&mut state, "ctrl-r");
    assert_eq!(altitudes(state.shared.plan()), [5000, 6250, 5000, 5000]);
}

#[test]
fn a_wrong_value_stays_in_its_field_with_what_is_allowed() {
    let mut state = state((80, 24));
    keys(&mut state, "2 right right right enter backspace backspace 'x enter");
    let seen = screen(&state);
    assert!(seen.contains("x is no altitude: metres above home"), "{seen}");
    assert_eq!(altitudes(state.shared.plan()), [5000; 4]);
    keys(&mut state, "esc");
    assert!(!screen(&state).contains("x is no"));
}

#[test]
fn many_waypoints_are_selected_and_turned_by_one_edit() {
    let mut state = state((120, 40));
    let before = state.shared.plan().clone();
    let effects = keys(&mut state, "2 ctrl-a m down down down down down '90 enter");
    assert_eq!(journal_lines(&effects), 1);
    assert_ne!(*state.shared.plan(), before);
    for _ in 0..3 {
        keys(&mut state, "ctrl-a m down down down down down '90 enter");
    }
    for (turned, place) in std::iter::zip(&state.shared.plan().waypoints, &before.waypoints) {
        let (distance_m, _) = betadeck::geo::distance_bearing(turned.position, place.position);
        assert!(distance_m < 0.1, "four quarter turns bring {distance_m} m");
    }
    keys(&mut state, "u u u u");
    assert_eq!(*state.shared.plan(), before);
}

#[test]
fn waypoints_are_inserted_repeated_moved_and_deleted() {
    let mut state = state((80, 24));
    keys(&mut state, "2 i");
    assert_eq!(state.shared.plan().waypoints.len(), 5);
    let inserted = state.shared.plan().waypoints[1];
    assert_eq!((inserted.kind, inserted.altitude), (WaypointType::Flyover, Altitude::above_home(50.0)));
    keys(&mut state, "alt-down alt-down");
    assert_eq!(state.shared.plan().waypoints[3], inserted);
    keys(&mut state, "c v up d");
    assert_eq!(state.shared.plan().waypoints.len(), 4);
    keys(&mut state, "u u u u u");
    assert_eq!(*state.shared.plan(), fixture::square());
    for _ in 0..40 {
        keys(&mut state, "c");
    }
    assert_eq!(state.shared.plan().waypoints.len(), 30);
    assert!(screen(&state).contains("A plan holds 30 waypoints"));
}

#[test]
fn a_waypoint_outside_the_fence_says_why_and_one_key_takes_the_fix() {
    let mut state = state((120, 40));
    keys(
        &mut state,
        "2 z right enter backspace backspace backspace backspace backspace backspace backspace '9 enter",
    );
    let seen = screen(&state);
    assert!(seen.contains("✗ refused: waypoint 0 is") && seen.contains("f: move WP0 inside the"), "{seen}");
    keys(&mut state, "f");
    assert!(!screen(&state).contains("refused: waypoint 0"));
}

#[test]
fn a_leg_that_is_too_steep_says_by_how_much_and_one_key_slows_it() {
    let mut state = state((120, 40));
    keys(&mut state, "2 z ctrl-a d");
    let lines = "waypoint insert 0 40.4642000 -79.5182000 1500 0 FLYOVER 0 NONE\n\
                 waypoint insert 1 40.4645000 -79.5182000 9000 0 FLYOVER 0 NONE\n\
                 waypoint insert 2 40.4642000 -79.5182000 2000 0 LAND 0 NONE";
    update(&mut state, Msg::Paste(lines.to_owned()));
    let seen = screen(&state);
    assert!(seen.contains("waypoint 1 is passed about") && seen.contains("f: fly WP1 at"), "{seen}");
    keys(&mut state, "f");
    assert!(state.shared.plan().waypoints[1].speed.mps() > 0.0, "{:?}", state.shared.plan());
    assert!(!screen(&state).contains("waypoint 1 is passed about"));
}

#[test]
fn waypoints_go_out_as_cli_lines_and_come_back_by_paste() {
    let mut state = state((80, 24));
    let effects = keys(&mut state, "2 down v down y");
    let copied = effects.into_iter().find_map(|effect| match effect {
        Effect::Copy(text) => Some(text),
        _ => None,
    });
    let text = copied.expect("copied text");
    assert_eq!(text.lines().count(), 2);
    assert!(text.starts_with("waypoint insert 0 40.4630000 -79.5175000 5000 0 FLYBY"), "{text}");
    update(&mut state, Msg::Paste(text));
    assert_eq!(state.shared.plan().waypoints.len(), 6);
    assert_eq!(state.shared.plan().waypoints[3], state.shared.plan().waypoints[1]);
    keys(&mut state, "u p");
    assert_eq!(state.shared.plan().waypoints.len(), 6, "the copy is kept");
    update(&mut state, Msg::Paste("no plan at all".to_owned()));
    assert_eq!(state.shared.plan().waypoints.len(), 6);
}

#[test]
fn a_pasted_block_with_waypoint_clear_replaces_the_plan_in_one_step() {
    let block = include_str!("../../../plans/guide-square.txt");
    let mut state = state((120, 40));
    keys(&mut state, "2 i i +");
    let before = state.shared.plan().clone();
    // Also while a value is typed: a block of lines is none.
    for open_field in ["", "right right right enter"] {
        keys(&mut state, open_field);
        assert_eq!(state.shared.editor.takes_text(), !open_field.is_empty());
        update(&mut state, Msg::Paste(format!("{block}set ap_max_angle = 30\n")));
        let pasted = state.shared.plan();
        assert_eq!(pasted.waypoints.len(), 4, "{pasted:?}");
        assert_eq!(pasted.waypoints[3].position, betadeck::geo::LatLon::new(404_640_000, -795_190_000));
        let seen = screen(&state).split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(seen.contains("Replaced the 6 waypoints of the plan by 4 pasted ones"), "{seen}");
        let log = state.shared.log.newest_first().next().expect("a line").text.clone();
        for part in ["Skipped 1 `save` line", "Skipped 1 `set` line"] {
            assert!(log.contains(part), "{log}");
        }
        keys(&mut state, "u");
        assert_eq!(*state.shared.plan(), before, "one step brings it back");
    }
}

#[test]
fn a_waypoint_is_dragged_on_the_map_by_the_mouse_as_one_edit() {
    let mut state = state((120, 40));
    keys(&mut state, "z");
    let seen = screen(&state);
    let (row, line) = seen.lines().enumerate().find(|(_, line)| line.contains("1 FLYBY")).unwrap();
    let column = line.chars().position(|c| c == '◇').expect("the mark") as u16 - 1;
    let before = state.shared.plan().waypoints[1].position;
    let row = row as u16;
    mouse(&mut state, MouseEventKind::Down, (column, row));
    mouse(&mut state, MouseEventKind::Up, (column, row));
    assert_eq!(state.shared.plan().waypoints[1].position, before, "a click moves nothing");
    mouse(&mut state, MouseEventKind::Down, (column, row));
    for step in 1..6 {
        let effects = mouse(&mut state, MouseEventKind::Drag, (column - step, row));
        assert!(effects.is_empty());
    }
    assert!(screen(&state).contains("from WP0"), "metres and bearing while it moves");
    let effects = mouse(&mut state, MouseEventKind::Up, (column - 5, row));
    assert_eq!(journal_lines(&effects), 1);
    let after = state.shared.plan().waypoints[1].position;
    assert!(after.lon_e7 < before.lon_e7, "{after} is not west of {before}");
    keys(&mut state, "u");
    assert_eq!(state.shared.plan().waypoints[1].position, before);
}

#[test]
fn waypoints_are_added_picked_and_deleted_with_the_cursor_on_the_map() {
    let mut state = state((80, 24));
    keys(&mut state, "p left left i");
    assert_eq!(state.shared.plan().waypoints.len(), 5);
    let added = state.shared.editor.row();
    keys(&mut state, "enter right right right enter");
    let place = state.shared.plan().waypoints[added].position;
    assert!(screen(&state).contains("edit ·"));
    keys(&mut state, "u");
    assert!(state.shared.plan().waypoints[added].position.lon_e7 < place.lon_e7, "it was moved east");
    keys(&mut state, "left left left d");
    assert_eq!(state.shared.plan().waypoints.len(), 4);
    keys(&mut state, "u");
    assert_eq!(state.shared.plan().waypoints.len(), 5);
    keys(&mut state, "esc");
    assert!(!screen(&state).contains("edit ·"));
}

#[test]
fn a_survey_beyond_thirty_waypoints_is_reported_before_it_is_made() {
    let mut state = state((120, 40));
    keys(&mut state, "2 P right right right down down backspace backspace '300 down backspace backspace '5");
    let seen = screen(&state);
    assert!(seen.contains("122 waypoints, there is room for 30"), "{seen}");
    keys(&mut state, "enter");
    assert!(state.shared.plan().waypoints.len() <= 30 && state.shared.plan().waypoints.len() > 20);
    keys(&mut state, "u");
    assert_eq!(*state.shared.plan(), fixture::square());
}

#[test]
fn a_new_plan_is_saved_under_a_name_and_nothing_is_replaced_unasked() {
    let mut state = state((80, 24));
    let effects = keys(&mut state, "2 n i S");
    assert!(effects.iter().any(|effect| matches!(effect, Effect::Files(FileRequest::List(_)))));
    let entries = vec![Entry { name: "old.toml".to_owned(), is_directory: false }];
    let listing = Listing { directory: "/plans".into(), entries };
    update(&mut state, Msg::Files(FileReply::Listed(listing)));
    assert!(screen(&state).contains("old.toml"));
    let effects = keys(&mut state, "down enter");
    let FileRequest::Save { id, path, replace: false, revision, .. } = save_of(effects) else {
        unreachable!()
    };
    update(&mut state, Msg::Files(FileReply::Occupied { id, path: path.clone(), changed: false }));
    assert!(screen(&state).contains("/plans/old.toml exists."));
    let effects = keys(&mut state, "y");
    assert!(matches!(save_of(effects), FileRequest::Save { replace: true, .. }));
    update(&mut state, Msg::Files(FileReply::Saved { id, path, revision, lost: Vec::new() }));
    assert!(!state.shared.editor.plan().is_unsaved());
    assert!(screen(&state).contains("Saved old.toml."));
}

#[test]
fn quitting_asks_for_every_unsaved_plan() {
    let mut state = state((80, 24));
    keys(&mut state, "2 + n i");
    assert!(!keys(&mut state, "q").iter().any(|effect| matches!(effect, Effect::Quit)));
    assert!(screen(&state).contains("square.toml has edits that no file holds"));
    assert!(keys(&mut state, "esc").is_empty(), "Esc stays");
    let effects = keys(&mut state, "q s");
    let FileRequest::Save { id, path, revision, .. } = save_of(effects) else { unreachable!() };
    let saved = FileReply::Saved { id, path, revision, lost: Vec::new() };
    update(&mut state, Msg::Files(saved));
    assert!(screen(&state).contains("new has edits that no file holds"), "{}", screen(&state));
    let effects = keys(&mut state, "d");
    assert!(effects.iter().any(|effect| matches!(effect, Effect::Quit)));
    assert!(
        effects
            .iter()
            .any(|effect| matches!(effect, Effect::Files(FileRequest::Close { discard: true, .. })))
    );
}

#[test]
fn the_plan_of_the_craft_is_compared_downloaded_and_watched() {
    let mut state = state((120, 40));
    keys(&mut state, "2 right right right + + left left +");
    let seen = screen(&state);
    assert!(seen.contains("● On the craft WP0 is: 1.0 m 180° from here, altitude"), "{seen}");
    let effects = keys(&mut state, "D");
    assert!(effects.iter().any(|effect| matches!(effect, Effect::Download(_))));
    let id = state.shared.editor.plan().id();
    update(&mut state, Msg::DownloadReply { id, result: Ok(Box::new(fixture::square())) });
    assert_eq!(*state.shared.plan(), fixture::square());

    // The App changes a waypoint.
    let mut view = state.shared.view.clone();
    let stored = &mut std::sync::Arc::make_mut(&mut view.vehicle).stored_plan;
    stored.as_mut().unwrap().waypoints[2].altitude = Altitude::above_home(70.0);
    update(&mut state, Msg::View(view.clone()));
    assert!(screen(&state).contains("The plan in the craft was changed: WP2."), "{}", screen(&state));
    // An upload from this screen is not reported as a change.
    keys(&mut state, "+ U");
    std::sync::Arc::make_mut(&mut view.vehicle).stored_plan = Some(state.shared.plan().clone());
    update(&mut state, Msg::View(view));
    assert!(state.shared.notice.as_ref().is_none_or(|notice| !notice.text.contains("was changed")));
}

#[test]
fn a_plan_that_somebody_else_changed_says_so() {
    let mut state = state((80, 24));
    let id = state.shared.editor.plan().id();
    keys(&mut state, "2");
    update(&mut state, Msg::Files(FileReply::Changed(id)));
    assert!(screen(&state).contains("changed on disk"));
}

#[test]
fn name_home_and_settings_are_edited_in_a_form() {
    let mut state = state((80, 24));
    keys(&mut state, "2 E 'x down down '40.5,-79.5 down 'ap_max_angle=20 enter");
    let document = state.shared.editor.document();
    assert_eq!(
        (document.name.as_str(), document.settings.as_slice()),
        ("x", &["ap_max_angle = 20".to_owned()][..])
    );
    assert!(document.home.is_some());
    keys(&mut state, "u");
    assert_eq!(state.shared.editor.document().name, "square");
}

#[test]
fn a_setting_with_which_the_file_could_not_be_read_again_is_refused() {
    for (typed, why) in [("foo=1", "foo is not a setting"), ("ap_max_angle=900", "ap_max_angle")] {
        let mut state = state((80, 24));
        keys(&mut state, &format!("2 E down down down '{typed} enter"));
        assert!(screen(&state).contains(why), "{typed}: {}", screen(&state));
        assert!(state.shared.editor.document().settings.is_empty());
    }
}

#[test]
fn the_editor_and_its_popups_draw_at_every_size() {
    for open in ["2", "2 P", "2 m", "2 E", "2 o", "2 right enter", "p"] {
        let mut state = state((120, 40));
        keys(&mut state, open);
        for size in [(1, 1), (20, 5), (60, 20), (61, 21), (80, 24), (119, 33), (120, 40), (250, 80)] {
            update(&mut state, Msg::Resize(size.0, size.1));
            screen(&state);
        }
    }
}

#[test]
fn the_tutorial_waits_for_what_the_user_does() {
    let mut state = state((80, 24));
    keys(&mut state, ":");
    keys(&mut state, "'app.tutorial enter");
    assert!(screen(&state).contains("1/5 Press F"), "{}", screen(&state));
    let flight =
        fixture::SimpleFlight { time_s: 40.0, fix: true, armed: true, ..fixture::SimpleFlight::default() };
    let mut view = fixture::view(&flight);
    std::sync::Arc::make_mut(&mut view.vehicle).nav.as_mut().unwrap().engaged = true;
    update(&mut state, Msg::View(view.clone()));
    assert!(screen(&state).contains("2/5") && screen(&state).contains("Press ] repeatedly"));
    view.speed_wanted = 4.0;
    update(&mut state, Msg::View(view.clone()));
    keys(&mut state, "2 +");
    assert!(screen(&state).contains("4/5"), "{}", screen(&state));
    std::sync::Arc::make_mut(&mut view.vehicle).stored_plan = Some(state.shared.plan().clone());
    update(&mut state, Msg::View(view));
    keys(&mut state, "1");
    assert!(screen(&state).contains("5/5 Press , to go back in time"), "{}", screen(&state));
    keys(&mut state, ":");
    keys(&mut state, "'app.tutorial enter");
    assert!(!screen(&state).contains("5/5"));
}

#[test]
fn plans_are_opened_and_saved_by_name() {
    let mut state = state((80, 24));
    let requests = |effects: Vec<Effect>| {
        let files = effects.into_iter().filter_map(|effect| match effect {
            Effect::Files(request) if !matches!(request, FileRequest::KeepLine(..)) => Some(request),
            _ => None,
        });
        files.collect::<Vec<_>>()
    };
    let mut line = |text: &str| {
        keys(&mut state, ":");
        for c in text.chars() {
            press(&mut state, c);
        }
        requests(keys(&mut state, "enter"))
    };
    let opened = line("open plans/orbit.toml");
    assert!(
        matches!(&opened[..], [FileRequest::Open { path, home: Some(home), accepted: false }]
            if path.ends_with("plans/orbit.toml") && home.amsl_m.is_some()),
        "{opened:?}"
    );
    assert!(
        matches!(&line("save /tmp/a.txt")[..], [FileRequest::Save { path, .. }] if path.ends_with("a.txt"))
    );
    assert!(matches!(line("open")[..], [FileRequest::List(_)]));
}

#[test]
fn the_mouse_chooses_values_and_drags_altitudes_in_the_profile() {
    let mut state = state((120, 40));
    keys(&mut state, "2 z");
    let speed = place_of(&state, "30.0 ORBIT");
    mouse(&mut state, MouseEventKind::Down, speed);
    mouse(&mut state, MouseEventKind::Up, speed);
    keys(&mut state, "+");
    assert_eq!(state.shared.plan().waypoints[2].duration, Seconds::new(31.0));
    let number = place_in_profile(&state, '3');
    mouse(&mut state, MouseEventKind::Down, number);
    assert!(mouse(&mut state, MouseEventKind::Drag, (number.0, number.1 + 2)).is_empty());
    let effects = mouse(&mut state, MouseEventKind::Up, (number.0, number.1 + 2));
    assert_eq!(journal_lines(&effects), 1);
    assert!(
        (4000..5000).contains(&state.shared.plan().records()[3].alt_cm),
        "{:?}",
        altitudes(state.shared.plan())
    );
}

#[test]
fn a_waypoint_dropped_beside_the_map_is_put_down() {
    let mut state = state((120, 40));
    let mark = place_of(&state, "◇");
    mouse(&mut state, MouseEventKind::Down, mark);
    mouse(&mut state, MouseEventKind::Drag, (mark.0 - 4, mark.1));
    // There is no panel at the hint bar.
    let effects = mouse(&mut state, MouseEventKind::Up, (mark.0 - 4, 39));
    assert_eq!(journal_lines(&effects), 1);
    assert!(mouse(&mut state, MouseEventKind::Up, mark).is_empty());
}

#[test]
fn a_picked_waypoint_is_put_down_in_no_other_plan_and_in_no_other_place_of_the_list() {
    for change in ["u", "2 ) 1", "2 ( 1", "2 d 1"] {
        let mut state = state((80, 24));
        keys(&mut state, "2 n i i i ( 1 p left left i enter right right");
        assert!(screen(&state).contains("from WP"), "{}", screen(&state));
        keys(&mut state, change);
        let plans = |state: &betadeck::ui::AppState| -> Vec<FlightPlan> {
            state.shared.editor.plans().iter().map(|plan| plan.document().plan.clone()).collect()
        };
        let before = plans(&state);
        keys(&mut state, "enter");
        assert_eq!(plans(&state), before, "{change}");
        assert!(screen(&state).contains("nothing was moved"), "{change}: {}", screen(&state));
    }
}

#[test]
fn escape_leaves_a_picked_waypoint_where_it_was_and_the_map_can_be_dragged() {
    for way_out in ["esc esc", "ctrl-c ctrl-l ctrl-c", "esc p"] {
        let mut state = state((80, 24));
        keys(&mut state, "p left left i enter right right");
        let before = state.shared.plan().clone();
        keys(&mut state, way_out);
        let mode = state.shared.map.mode;
        mouse(&mut state, MouseEventKind::Down, (4, 10));
        mouse(&mut state, MouseEventKind::Drag, (9, 11));
        mouse(&mut state, MouseEventKind::Up, (9, 11));
        assert_ne!(state.shared.map.mode, mode, "{way_out}");
        assert!(!screen(&state).contains("from WP"), "{way_out}: {}", screen(&state));
        assert_eq!(*state.shared.plan(), before);
    }
}

#[test]
fn what_is_typed_goes_into_the_value_where_it_was_begun() {
    let mut state = state((120, 40));
    keys(&mut state, "2 z right right right enter backspace backspace '77");
    let place = place_of(&state, "FLYBY");
    mouse_button(&mut state, MouseEventKind::ScrollDown, place);
    keys(&mut state, "enter");
    assert_eq!(altitudes(state.shared.plan()), [7700, 5000, 5000, 5000]);
}

#[test]
fn a_value_that_is_typed_is_given_up_when_a_waypoint_is_chosen_on_the_map() {
    let mut state = state((120, 40));
    keys(&mut state, "2 right right right enter backspace backspace '77");
    let mark = place_of(&state, "◇");
    mouse(&mut state, MouseEventKind::Down, mark);
    mouse(&mut state, MouseEventKind::Up, mark);
    keys(&mut state, "2 enter");
    assert_eq!(altitudes(state.shared.plan()), [5000; 4]);
}

#[test]
fn every_plan_of_a_generated_survey_is_asked_for_at_the_end_and_survives_a_kill() {
    let mut state = state((120, 40));
    let effects = keys(
        &mut state,
        "2 P right right right down down backspace backspace '300 down backspace backspace '5 \
         down down down down down down right enter",
    );
    let made = state.shared.editor.plans().len();
    assert!(made > 2, "{}", screen(&state));
    assert_eq!(journal_lines(&effects), made, "a line for each");
    assert!(state.shared.editor.plans().iter().all(betadeck::ui::OpenPlan::is_unsaved));
    keys(&mut state, ") u");
    assert!(state.shared.plan().waypoints.is_empty(), "undo reaches before the generator");
}

#[test]
fn text_is_pasted_into_the_fields_of_forms_and_of_the_file_browser() {
    let mut state = state((80, 24));
    keys(&mut state, "2 o");
    update(&mut state, Msg::Paste("/plans/mine.toml\n".to_owned()));
    let effects = keys(&mut state, "enter");
    let asked = |effect: &Effect| matches!(effect, Effect::Files(FileRequest::Open { path, .. }) if path.ends_with("mine.toml"));
    assert!(effects.iter().any(asked), "{effects:?}");
    keys(&mut state, "E");
    update(&mut state, Msg::Paste(" of mine\nand more".to_owned()));
    keys(&mut state, "enter");
    assert_eq!(state.shared.editor.document().name, "of mine");
}

#[test]
fn a_huge_paste_into_a_field_is_cut() {
    let mut state = state((80, 24));
    keys(&mut state, "ctrl-p");
    update(&mut state, Msg::Paste("x".repeat(1 << 20)));
    keys(&mut state, "esc :");
    update(&mut state, Msg::Paste("x".repeat(1 << 20)));
    assert!(state.command_line.field.value().len() <= 4096);
}

#[test]
fn a_waypoint_inserted_after_the_end_of_a_closed_square_goes_on_in_its_direction() {
    let mut state = state((120, 40));
    keys(&mut state, "2 n P enter down down down down i");
    let [.., before, last, next] = state.shared.plan().waypoints.as_slice() else { panic!("six") };
    let (_, leg) = betadeck::geo::distance_bearing(before.position, last.position);
    let (_, onward) = betadeck::geo::distance_bearing(last.position, next.position);
    assert!((leg - onward).abs() < 0.01, "{leg} {onward}");
}
