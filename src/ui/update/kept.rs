//! Keeps the screen, and shows the one of the run before.

use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::session::SessionView;
use crate::signals::SimTime;
use crate::ui::app_state::AppState;
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::model::files::FileRequest;
use crate::ui::model::kept_screen::{
    KeptMap, KeptOf, KeptPanels, KeptPlace, KeptScreen, KeptSubject, KeptTexts, MAX_PLANS,
};
use crate::ui::model::layout::Slots;
use crate::ui::model::map_state::MapMode;
use crate::ui::model::panel_table::Panel;
use crate::ui::shared::Shared;

/// The shortest time between two looks for a change.
const INTERVAL: Duration = Duration::from_secs(1);

/// Returns the present screen; `None` while the recorded flight is not there yet.
fn present(state: &mut AppState) -> Option<KeptScreen> {
    let (shared, kept) = (&state.shared, &mut state.kept);
    if !kept.has_left && matches!(kept.of, KeptOf::Flown | KeptOf::Record) {
        kept.place = Some(place(&shared.view)?);
    }
    let map = &shared.map;
    let mode = map.mode.possible();
    let is_of_subject = kept.of.has_subject() && matches!(mode, MapMode::Free { .. } | MapMode::Near { .. });
    let panels = KeptPanels {
        focus: shared.focus.name().to_owned(),
        zoomed: shared.zoomed,
        places: shared.slots.panels().map(|panel| panel.name().to_owned()).to_vec(),
        arrangement: shared.arrangement.clone(),
        map: KeptMap {
            mode: if is_of_subject { MapMode::default() } else { mode },
            grid: map.grid,
            course_up: map.course_up,
            hides_past: map.hides_past,
        },
        graphs: shared.graphs.chosen(),
    };
    let file = |path: &Path| path.to_str().map(PathBuf::from);
    let plans = shared.editor.plans().iter().filter_map(|plan| plan.file().and_then(file));
    let plan = shared.editor.plan();
    let subject = KeptSubject {
        plans: plans.take(MAX_PLANS).collect(),
        shown: plan.file().and_then(file),
        row: shared.editor.row(),
        shown_name: plan.file().is_none().then(|| plan.document().name.clone()),
        place: kept.place,
        window: is_of_subject.then_some(mode),
    };
    Some(KeptScreen { panels: Some(panels), subject })
}

/// Returns the shown place in the flights of a file; `None` while the file is read.
fn place(view: &SessionView) -> Option<KeptPlace> {
    let replay = view.replay.as_deref();
    if replay.is_some_and(|replay| replay.reading.is_some()) {
        return None;
    }
    let timeline = view.timeline.as_ref()?;
    let at = view.vehicle.time;
    let is_within = timeline.rewound && at > timeline.first;
    Some(KeptPlace { flight: replay.map_or(0, |replay| replay.number), at_us: is_within.then_some(at.0) })
}

fn panel_of(name: &str) -> Option<Panel> {
    Panel::ALL.into_iter().find(|panel| panel.name() == name)
}

/// Shows the screen of the run before. Speed and air are those of this run.
pub(in crate::ui) fn restore(state: &mut AppState) {
    let Some(KeptScreen { panels, subject }) = state.kept.before.take() else { return };
    let shared = &mut state.shared;
    if let Some(panels) = panels {
        arrange(shared, panels);
    }
    if let Some(window) = subject.window {
        shared.map.mode = window.possible();
    }
    if let Some(at_us) = subject.place.and_then(|place| place.at_us) {
        let at_s = SimTime(at_us).as_secs_f64();
        let text = format!("As you left it: at {at_s:.1} s since boot. `--fresh-screen` starts clean.");
        shared.notify(Severity::Info, text);
    }
}

/// Shows the panels as they were.
fn arrange(shared: &mut Shared, panels: KeptPanels) {
    if let Some(focus) = panel_of(&panels.focus) {
        shared.focus = focus;
    }
    shared.zoomed = panels.zoomed;
    let places: Vec<Panel> = panels.places.iter().filter_map(|name| panel_of(name)).collect();
    if let Some(slots) = <[Panel; 3]>::try_from(places).ok().and_then(Slots::of) {
        shared.slots = slots;
    }
    shared.arrangement = panels.arrangement;
    let KeptMap { mode, grid, course_up, hides_past } = panels.map;
    (shared.map.mode, shared.map.grid) = (mode.possible(), grid);
    (shared.map.course_up, shared.map.hides_past) = (course_up, hides_past);
    shared.graphs.choose(&panels.graphs);
}

/// Returns the request to keep the screen, if it has changed. It looks only now and then.
pub(in crate::ui) fn follow(state: &mut AppState) -> Option<Effect> {
    if state.shared.now.saturating_sub(state.kept.looked) < INTERVAL {
        return None;
    }
    keep(state)
}

/// Returns the request to keep the screen, if it has changed.
pub(in crate::ui) fn keep(state: &mut AppState) -> Option<Effect> {
    // The one before must come back first.
    if !state.kept.is_kept || state.kept.before.is_some() {
        return None;
    }
    state.kept.looked = state.shared.now;
    let screen = present(state)?;
    let kept = &mut state.kept;
    let texts = screen.texts(kept.of, kept.last.as_ref());
    kept.last = Some(screen);
    (texts != KeptTexts::default()).then_some(Effect::Files(FileRequest::KeepScreen(texts)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::events::{Event, SessionEvent};
    use crate::session::ReplayView;
    use crate::timeline::TimelineView;
    use crate::ui::model::kept_screen::{KeptScreens, Unread};
    use std::sync::Arc;

    fn state() -> AppState {
        state_of(KeptOf::Flight, None)
    }

    fn state_of(of: KeptOf, before: Option<KeptScreen>) -> AppState {
        let mut state =
            AppState::bare((120, 40), SessionView { speed_wanted: 1.0, ..SessionView::default() });
        state.kept = KeptScreens::after(of, before);
        state
    }

    fn kept(state: &mut AppState) -> Option<KeptTexts> {
        match keep(state)? {
            Effect::Files(FileRequest::KeepScreen(texts)) => Some(texts),
            other => panic!("{other:?}"),
        }
    }

    fn read(text: Option<String>) -> Option<KeptScreen> {
        text.map(|text| KeptScreen::parse(&text).expect("a screen"))
    }

    /// Shows an instant of a flight of 40 s.
    fn show(state: &mut AppState, at_s: f64) {
        let view = &mut state.shared.view;
        Arc::make_mut(&mut view.vehicle).time = SimTime::from_secs_f64(at_s);
        let head = SimTime::from_secs_f64(40.0);
        view.timeline = Some(TimelineView { head, rewound: at_s < 40.0, ..TimelineView::default() });
    }

    fn shown_place(state: &mut AppState) -> Option<u64> {
        present(state).and_then(|screen| screen.subject.place).and_then(|place| place.at_us)
    }

    #[test]
    fn a_screen_comes_back_as_it_was_left() {
        let mut before = state();
        before.shared.focus = Panel::Graphs;
        before.shared.slots.visit(Panel::Graphs);
        before.shared.zoomed = true;
        before.shared.map.mode = MapMode::Free { n: 3.5, e: -7.0, scale: 0.5 };
        before.shared.map.course_up = true;
        before.shared.graphs.toggle(6);
        let texts = kept(&mut before).expect("a changed screen is kept");
        assert_eq!(texts.subject, None, "a flight has one file");
        assert_eq!(kept(&mut before), None, "once");
        let mut after = state_of(KeptOf::Flight, read(texts.screen));
        restore(&mut after);
        assert_eq!(present(&mut after), present(&mut before));
        assert_eq!(after.shared.focus, Panel::Graphs);
    }

    #[test]
    fn the_place_and_the_window_of_the_map_are_those_of_one_recorded_flight() {
        let mut before = state_of(KeptOf::Record, None);
        let reading = ReplayView { reading: Some(0.5), ..ReplayView::default() };
        before.shared.view.replay = Some(Arc::new(reading));
        assert_eq!(kept(&mut before), None, "nothing is shown yet");
        before.shared.view.replay =
            Some(Arc::new(ReplayView { number: 2, count: 3, ..ReplayView::default() }));
        before.shared.map.mode = MapMode::Free { n: 3.5, e: -7.0, scale: 0.5 };
        before.shared.zoomed = true;
        show(&mut before, 12.5);
        let KeptTexts { screen, subject } = kept(&mut before).expect("a changed screen is kept");
        show(&mut before, 13.0);
        let later = kept(&mut before).expect("another place");
        assert!(later.screen.is_none() && later.subject.is_some(), "the panels stay as they are");

        let both = KeptScreen::joined(read(screen.clone()), read(subject.clone()));
        let mut after = state_of(KeptOf::Record, both);
        let place = KeptPlace { flight: 2, at_us: Some(12_500_000) };
        assert_eq!(after.kept.before().and_then(KeptScreen::place), Some(place));
        restore(&mut after);
        assert_eq!(after.shared.map.mode, before.shared.map.mode);
        let said = after.shared.notice.as_ref().map(|notice| notice.text.as_str());
        assert_eq!(said, Some("As you left it: at 12.5 s since boot. `--fresh-screen` starts clean."));

        let mut other = state_of(KeptOf::Record, KeptScreen::joined(read(screen), None));
        restore(&mut other);
        assert!(other.shared.zoomed);
        assert_eq!(other.shared.map.mode, MapMode::Fit);
    }

    #[test]
    fn two_programs_of_one_kind_keep_their_own_panels() {
        let kept_with = |focus: Panel| {
            let mut state = state_of(KeptOf::Craft, None);
            state.shared.focus = focus;
            kept(&mut state).expect("a screen")
        };
        let (first, second) = (kept_with(Panel::Graphs), kept_with(Panel::Log));
        let focus = |kind: &KeptTexts, own: Option<&KeptTexts>| {
            let own = own.and_then(|own| read(own.subject.clone()));
            let mut state = state_of(KeptOf::Craft, KeptScreen::joined(read(kind.screen.clone()), own));
            restore(&mut state);
            state.shared.focus
        };
        assert_eq!(focus(&second, Some(&first)), Panel::Graphs);
        assert_eq!(focus(&second, None), Panel::Log, "a craft that is new has the panels of the last one");
    }

    #[test]
    fn the_beginning_and_the_end_of_a_flight_are_no_places_to_return_to() {
        let mut state = state_of(KeptOf::Flown, None);
        for (at_s, place) in [(0.0, None), (7.0, Some(7_000_000)), (40.0, None)] {
            show(&mut state, at_s);
            assert_eq!(shown_place(&mut state), place, "{at_s}");
        }
    }

    #[test]
    fn a_flight_that_is_flown_on_keeps_the_place_that_was_left() {
        let mut state = state_of(KeptOf::Flown, None);
        show(&mut state, 7.0);
        assert_eq!(shown_place(&mut state), Some(7_000_000));
        state.take_event(&Event { time: SimTime(7_000_000), kind: SessionEvent::Restarted });
        show(&mut state, 9.0);
        assert_eq!(shown_place(&mut state), Some(7_000_000), "9 s is an instant of another flight");
    }

    #[test]
    fn a_screen_with_unknown_names_and_impossible_numbers_is_taken_as_far_as_it_is_known() {
        let text = r#"{"version": 1, "focus": "Radar", "places": ["Map"], "graphs": {"plots": ["none"]},
            "map": {"mode": {"Free": {"n": 1e300, "e": 0.0, "scale": 1.0}}}, "row": 4000000,
            "speed": 4.0, "air": ["wind=3@90"]}"#;
        let mut state = state_of(KeptOf::Flight, KeptScreen::parse(text).ok());
        restore(&mut state);
        assert_eq!((state.shared.focus, state.shared.map.mode), (Panel::Map, MapMode::Fit));
    }

    #[test]
    fn a_damaged_screen_and_one_of_a_later_version_are_told_apart() {
        for text in ["", "{", r#"{"focus": 3}"#, r#"{"version": 1, "map": {"mode": "Upside"}}"#] {
            assert_eq!(KeptScreen::parse(text), Err(Unread::Damaged), "{text}");
        }
        assert_eq!(KeptScreen::parse(r#"{"version": 2, "focus": {"panel": "Map"}}"#), Err(Unread::Later));
    }
}
