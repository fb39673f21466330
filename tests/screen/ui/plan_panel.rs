//! The Plan panel: units, and the altitude profile with the flown altitudes.

use std::sync::Arc;

use betadeck::events::{Event, SessionEvent};
use betadeck::plan::Altitude;
use betadeck::session::SessionView;
use betadeck::signals::SimTime;
use betadeck::ui::PlanId;
use betadeck::ui::{AppState, Msg, Panel, Severity, Units, update};
use crossterm::event::MouseEventKind;

use crate::ui::fixture;
use crate::ui::hands::{keys, mouse, place_in_profile, place_of, screen, state_with_fix};

fn imperial(size: (u16, u16)) -> AppState {
    let mut state = state_with_fix(size);
    state.shared.units = Units::Imperial;
    state
}

#[test]
fn with_imperial_units_the_table_shows_takes_and_nudges_feet_and_miles_an_hour() {
    let mut state = imperial((120, 40));
    keys(&mut state, "2 z");
    let seen = screen(&state);
    assert!(seen.contains("alt ft") && seen.contains("mph") && seen.contains("164.0"), "{seen}");
    assert!(seen.contains("altitude and distance in ft") && seen.contains(" 150 ┤"), "{seen}");
    keys(&mut state, "right right right enter");
    assert!(screen(&state).contains("feet above home"), "{}", screen(&state));
    keys(&mut state, "backspace backspace backspace backspace backspace backspace '200 enter");
    assert_eq!(
        state.shared.plan().waypoints[0].altitude,
        Altitude::above_home(60.96),
        "what is kept and sent is metric"
    );
    keys(&mut state, "+ + -");
    assert_eq!(state.shared.plan().waypoints[0].altitude, Altitude::above_home(61.26), "201 ft");
    keys(&mut state, "right enter backspace '10 enter");
    assert_eq!(state.shared.plan().records()[0].speed, 447);
    // The craft still has the unchanged plan.
    let seen = screen(&state);
    assert!(seen.contains("On the craft WP0 is: altitude 164.0, speed —."), "{seen}");
}

#[test]
fn with_imperial_units_forms_and_the_map_are_in_feet() {
    let mut state = imperial((120, 40));
    keys(&mut state, "2 ctrl-a m");
    assert!(screen(&state).contains("ft above home") && screen(&state).contains("mph, 0 = default"));
    keys(&mut state, "'100 down down '10 enter");
    assert!(state.shared.plan().records().iter().all(|wp| (wp.alt_cm, wp.speed) == (3048, 447)));
    keys(&mut state, "P");
    let seen = screen(&state);
    assert!(seen.contains("262 ") && seen.contains("ft above home"), "80 m\n{seen}");
    keys(&mut state, "esc 1 p");
    let seen = screen(&state);
    assert!(seen.contains(" ft 0") || seen.contains(" ft 1") || seen.contains(" ft 2"), "{seen}");
    assert!(!seen.contains(" m 0") && seen.contains("from home"), "{seen}");
}

#[test]
fn an_altitude_dragged_far_up_follows_the_mouse_however_often_that_tells() {
    let mut dragged = [1, 30].map(|events| {
        let mut state = fixture::state((120, 40), fixture::colour());
        keys(&mut state, "2 z");
        let number = place_in_profile(&state, '3');
        mouse(&mut state, MouseEventKind::Down, number);
        for _ in 0..events {
            mouse(&mut state, MouseEventKind::Drag, (number.0, number.1 - 15));
        }
        mouse(&mut state, MouseEventKind::Up, (number.0, number.1 - 15));
        state.shared.plan().records()[3].alt_cm
    });
    dragged.sort_unstable();
    assert!(dragged[0] > 5000 && dragged[0] == dragged[1], "{dragged:?}");
}

#[test]
fn altitudes_are_dragged_by_whole_feet() {
    let mut state = imperial((120, 40));
    keys(&mut state, "2 z");
    let number = place_in_profile(&state, '3');
    mouse(&mut state, MouseEventKind::Down, number);
    mouse(&mut state, MouseEventKind::Drag, (number.0, number.1 + 2));
    mouse(&mut state, MouseEventKind::Up, (number.0, number.1 + 2));
    let feet = f64::from(state.shared.plan().records()[3].alt_cm) / 30.48;
    assert!((feet - feet.round()).abs() < 0.02 && feet < 150.0, "{feet} ft");
}

#[test]
fn the_flown_altitude_is_beside_the_plan_and_the_legend_names_it() {
    let mut state = fixture::state((120, 40), fixture::colour());
    keys(&mut state, "2 z");
    assert!(!screen(&state).contains("── flown"), "nothing was flown");
    fixture::approach(&mut state);
    let seen = screen(&state);
    assert!(seen.contains("altitude and distance in m ╌╌ plan ── flown "), "{seen}");
    // It follows the line of the plan at 50 m, as far as the middle of the leg to WP1.
    let line = seen.lines().find(|line| line.contains("50 ┤")).expect("50 m");
    let dots = |line: &str| line.chars().filter(|c| ('\u{2801}'..='\u{28ff}').contains(c)).count();
    assert!(dots(line) > 40, "{seen}");
    let (first, rest) = line.split_once('1').expect("WP1");
    assert!(
        dots(first) > dots(rest) / 2,
        "solid up to the middle of the leg to WP1, dashed after it: {line}"
    );
    // An edit of altitudes keeps the flown profile; an edit of positions makes it meaningless.
    keys(&mut state, "right right right shift-up");
    assert!(screen(&state).contains("── flown"), "{}", screen(&state));
    keys(&mut state, "left +");
    assert!(!screen(&state).contains("── flown"), "{}", screen(&state));
}

#[test]
fn a_climb_above_the_plan_is_seen_in_the_profile() {
    let mut state = fixture::state((120, 40), fixture::plain());
    keys(&mut state, "2 z");
    fixture::approach(&mut state);
    let mut view: SessionView = state.shared.view.clone();
    for step in 1..40 {
        let vehicle = Arc::make_mut(&mut view.vehicle);
        vehicle.time.0 += 500_000;
        vehicle.truth.as_mut().expect("truth").alt = 50.0 + f64::from(step);
        update(&mut state, Msg::View(view.clone()));
    }
    let seen = screen(&state);
    assert!(seen.contains("** flown") && seen.contains("  80 "), "{seen}");
}

#[test]
fn with_imperial_units_the_log_and_the_toasts_are_in_feet_and_miles_an_hour() {
    let mut state = imperial((120, 40));
    state.sentence = |_| "Geofence: 174.0 m from home, the fence is 150 m; sinks at 0.50 m/s.".to_owned();
    state.take_event(&Event { time: SimTime(0), kind: SessionEvent::Notice(String::new()) });
    state.shared.notify(Severity::Warn, "The fence is 100 m.");
    keys(&mut state, "8 z");
    let seen = screen(&state);
    assert!(seen.contains("570.9 ft from home, the fence is 492 ft; sinks at 1.12 mph."), "{seen}");
    assert!(seen.contains("The fence is 328 ft."), "{seen}");
}

#[test]
fn a_digit_on_a_value_that_was_chosen_edits_it_and_shows_a_panel_otherwise() {
    let mut state = state_with_fix((120, 40));
    keys(&mut state, "2 3");
    assert_eq!(state.shared.focus, Panel::State, "nothing was chosen");
    keys(&mut state, "2 right right right '60 enter");
    assert_eq!(state.shared.plan().waypoints[0].altitude, Altitude::above_home(60.0));
    keys(&mut state, "+ '75 enter");
    assert_eq!(state.shared.plan().waypoints[0].altitude, Altitude::above_home(75.0), "it is still chosen");
    keys(&mut state, "esc 3 2 1");
    assert_eq!(state.shared.focus, Panel::Map, "Esc ends it");
    keys(&mut state, "2");
    let (column, row) = place_of(&state, "75.0");
    mouse(&mut state, MouseEventKind::Down, (column, row));
    keys(&mut state, "'80 enter");
    assert_eq!(state.shared.plan().waypoints[0].altitude, Altitude::above_home(80.0), "by a click");
    mouse(&mut state, MouseEventKind::Down, (column, row));
    keys(&mut state, "i 3");
    assert_eq!(state.shared.focus, Panel::State, "an insertion is no value");
    // A word has no digits.
    keys(&mut state, "2 left left left down 3");
    assert_eq!(state.shared.focus, Panel::State);
    keys(&mut state, "7 down up '4");
    assert!(state.panels.world.knobs.field.is_some() && state.shared.focus == Panel::World);
}

#[test]
fn a_plan_that_would_be_refused_is_said_before_anything_is_ready() {
    let mut state = state_with_fix((120, 40));
    let mut document = state.shared.editor.document().clone();
    document.settings = vec!["ap_max_distance_from_home = 20".to_owned()];
    let history = betadeck::plan::edit::History::new(document, true);
    let open = betadeck::ui::editor::OpenPlan::new(PlanId(7), None, history);
    state.shared.editor = betadeck::ui::editor::Editor::new(open);
    keys(&mut state, "2 right right right +");
    let seen = screen(&state);
    assert!(seen.contains("The autopilot would refuse") && !seen.contains("Ready."), "{seen}");
}
