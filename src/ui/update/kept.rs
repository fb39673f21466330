//! Keeps the screen, and shows the one of the run before.

use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::session::Command;
use crate::ui::app_state::AppState;
use crate::ui::editor::FileRequest;
use crate::ui::event_log::Severity;
use crate::ui::kept_screen::{KeptMap, KeptScreen, MOST_PLANS, VERSION};
use crate::ui::knobs;
use crate::ui::layout::Slots;
use crate::ui::message::Effect;
use crate::ui::panel::Panel;

/// The shortest time between two looks for a change.
const INTERVAL: Duration = Duration::from_secs(1);
/// The beginnings of the lines about the air that come back.
const AIR: [&str; 4] = ["wind=", "gust=", "turbulence=", "noise="];
/// The speeds that come back, times real time.
const SPEEDS: (f64, f64) = (0.01, 1000.0);

/// Returns the present screen.
fn present(state: &AppState) -> KeptScreen {
    let shared = &state.shared;
    let file = |path: &Path| path.to_str().map(PathBuf::from);
    let plans = shared.editor.plans().iter().filter_map(|plan| plan.file().and_then(file));
    let speed = Some(shared.view.speed_wanted).filter(|speed| is_another_speed(*speed));
    let map = &shared.map;
    KeptScreen {
        version: VERSION,
        focus: shared.focus.name().to_owned(),
        zoomed: shared.zoomed,
        places: shared.slots.panels().map(|panel| panel.name().to_owned()).to_vec(),
        arrangement: shared.arrangement.clone(),
        map: KeptMap {
            mode: map.mode.possible(),
            grid: map.grid,
            course_up: map.course_up,
            hides_past: map.hides_past,
        },
        graphs: shared.graphs.chosen(),
        plans: plans.take(MOST_PLANS).collect(),
        shown: shared.editor.plan().file().and_then(file),
        row: shared.editor.row(),
        speed: speed.filter(|_| is_simulated(state)),
        air: if is_simulated(state) { knobs::lines(&shared.view.vehicle.world) } else { Vec::new() },
    }
}

fn is_another_speed(speed: f64) -> bool {
    speed.is_finite() && (SPEEDS.0..=SPEEDS.1).contains(&speed) && (speed - 1.0).abs() > 1e-9
}

/// Returns `true` if the speed and the air are those of the embedded simulator.
fn is_simulated(state: &AppState) -> bool {
    state.shared.view.remote.is_none() && state.shared.view.simulator.is_none()
}

fn panel_of(name: &str) -> Option<Panel> {
    Panel::ALL.into_iter().find(|panel| panel.name() == name)
}

/// Shows the screen of the run before. Returns the requests for the speed and the air, if the options of this run left
/// them at their defaults.
pub(in crate::ui) fn restore(state: &mut AppState) -> Vec<Effect> {
    let Some(before) = state.kept.before.take() else { return Vec::new() };
    let shared = &mut state.shared;
    if let Some(focus) = panel_of(&before.focus) {
        shared.focus = focus;
    }
    shared.zoomed = before.zoomed;
    let places: Vec<Panel> = before.places.iter().filter_map(|name| panel_of(name)).collect();
    if let Some(slots) = <[Panel; 3]>::try_from(places).ok().and_then(Slots::of) {
        shared.slots = slots;
    }
    shared.arrangement = before.arrangement;
    let KeptMap { mode, grid, course_up, hides_past } = before.map;
    (shared.map.mode, shared.map.grid) = (mode.possible(), grid);
    (shared.map.course_up, shared.map.hides_past) = (course_up, hides_past);
    shared.graphs.choose(&before.graphs);
    let mut effects = Vec::new();
    let mut said = Vec::new();
    if is_simulated(state) {
        let shared = &state.shared;
        if let Some(speed) = before.speed.filter(|speed| is_another_speed(*speed))
            && !is_another_speed(shared.view.speed_wanted)
        {
            said.push(format!("speed {speed}×"));
            effects.push(Effect::Send(Command::Speed(speed)));
        }
        if knobs::lines(&shared.view.vehicle.world).is_empty() {
            // The file may have been written by anybody.
            let is_air = |line: &&String| AIR.iter().any(|name| line.starts_with(name));
            let air: Vec<String> = before.air.iter().filter(is_air).take(AIR.len()).cloned().collect();
            said.extend(air.iter().cloned());
            effects.extend(air.into_iter().map(Effect::World));
        }
    }
    if !said.is_empty() {
        let text = format!("As you left it: {}. `--fresh-screen` starts clean.", said.join(", "));
        state.shared.notify(Severity::Info, text);
    }
    effects
}

/// Returns the request to keep the screen, if it has changed. It looks only now and then.
pub(super) fn follow(state: &mut AppState) -> Option<Effect> {
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
    let screen = present(state);
    if state.kept.last.as_ref() == Some(&screen) {
        return None;
    }
    let text = screen.text()?;
    state.kept.last = Some(screen);
    Some(Effect::Files(FileRequest::KeepScreen(text)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::SessionView;
    use crate::ui::kept_screen::{KeptScreens, Unread};
    use crate::ui::map_state::MapMode;

    fn state() -> AppState {
        let mut state = AppState::bare((120, 40), SessionView::default());
        state.kept = KeptScreens::after(None);
        state
    }

    fn kept(state: &mut AppState) -> Option<String> {
        match keep(state)? {
            Effect::Files(FileRequest::KeepScreen(text)) => Some(text),
            other => panic!("{other:?}"),
        }
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
        let text = kept(&mut before).expect("a changed screen is kept");
        assert_eq!(kept(&mut before), None, "once");
        let mut after = state();
        after.kept = KeptScreens::after(KeptScreen::parse(&text).ok());
        assert!(restore(&mut after).is_empty(), "real time in calm air");
        assert_eq!(present(&after), present(&before));
        assert_eq!(after.shared.focus, Panel::Graphs);
    }

    #[test]
    fn speed_and_air_come_back_unless_the_options_set_them() {
        let screen =
            KeptScreen { speed: Some(4.0), air: vec!["wind=5@270".to_owned()], ..KeptScreen::default() };
        let mut state = state();
        state.kept = KeptScreens::after(Some(screen.clone()));
        state.shared.view.speed_wanted = 1.0;
        let effects = restore(&mut state);
        assert!(
            matches!(&effects[..], [Effect::Send(Command::Speed(4.0)), Effect::World(line)] if line == "wind=5@270"),
            "{effects:?}"
        );
        state.kept = KeptScreens::after(Some(screen));
        state.shared.view.speed_wanted = 2.0;
        std::sync::Arc::make_mut(&mut state.shared.view.vehicle).world.gust_mps = 3.0;
        std::sync::Arc::make_mut(&mut state.shared.view.vehicle).world.wind =
            Some(crate::telemetry::snapshot::WindView { speed_mps: 0.0, from_deg: 0.0 });
        assert!(restore(&mut state).is_empty());
    }

    #[test]
    fn a_screen_with_unknown_names_and_impossible_numbers_is_taken_as_far_as_it_is_known() {
        let text = r#"{"version": 1, "focus": "Radar", "places": ["Map"], "graphs": {"plots": ["none"]},
            "map": {"mode": {"Free": {"n": 1e300, "e": 0.0, "scale": 1.0}}}, "row": 4000000, "speed": -1.0,
            "air": ["thermal=9", "wind=3@90"]}"#;
        let mut state = state();
        state.shared.view.speed_wanted = 1.0;
        state.kept = KeptScreens::after(KeptScreen::parse(text).ok());
        let effects = restore(&mut state);
        assert!(matches!(&effects[..], [Effect::World(line)] if line == "wind=3@90"), "{effects:?}");
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
