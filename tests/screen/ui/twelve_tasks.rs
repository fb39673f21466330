//! The twelve tasks of `docs/guide.md`: its keys do what it says, and no task takes more than eight.

use betadeck::events::{Event, SessionEvent};
use betadeck::lookahead::ForecastRequest;
use betadeck::plan::Altitude;
use betadeck::session::Command;
use betadeck::signals::SimTime;
use betadeck::telemetry::{EventKind, FirmwareEvent, NavEvent, NavState, Refusal};
use betadeck::ui::{AppState, Effect, Msg, Panel, screen_layout, update};

use crate::ui::fixture;
use crate::ui::hands::{screen, state_with_fix};
use crate::ui::settings::Craft;

const GUIDE: &str = include_str!("../../../docs/guide.md");
const FENCE: &str = "ap_max_distance_from_home";

/// Returns the tasks with their keys, as the keymap names them.
fn tasks() -> Vec<(String, Vec<String>)> {
    let rows = GUIDE.split("## Twelve tasks").nth(1).and_then(|rest| rest.split("\n## ").next());
    let rows = rows.expect("the tasks").lines().filter(|line| line.starts_with("| ") && line.contains('`'));
    let row = |line: &str| {
        let mut cells = line.trim_matches('|').split(" | ");
        let task = cells.next().expect("a task").trim().to_owned();
        let keys = cells.next().expect("its keys").split_whitespace().map(|key| {
            let key = key.trim_matches('`');
            if key.chars().count() > 1 { key.to_lowercase() } else { key.to_owned() }
        });
        (task, keys.filter(|key| !key.is_empty() && key != "|").collect())
    };
    rows.map(row).collect()
}

/// A screen on which the tasks are done one after another, and its craft.
struct User {
    state: AppState,
    craft: Craft,
}

impl User {
    fn new() -> Self {
        Self { state: state_with_fix((80, 24)), craft: Craft::with(&[]) }
    }

    /// Presses the keys of a task. The craft answers after each, as it does while the user looks for the next key.
    fn press(&mut self, keys: &[String]) -> Vec<Effect> {
        let mut effects = Vec::new();
        for key in keys {
            effects.extend(self.craft.press(&mut self.state, key));
            self.craft.go_on(&mut self.state);
        }
        effects
    }
}

fn sends(effects: &[Effect], is_wanted: impl Fn(&Command) -> bool) -> bool {
    effects.iter().any(|effect| matches!(effect, Effect::Send(command) if is_wanted(command)))
}

/// Does a task and checks its result.
fn check(user: &mut User, task: &str, keys: &[String]) {
    let fence = user.craft.number(FENCE);
    match task {
        "fly the plan" => {
            let effects = user.press(keys);
            assert!(sends(&effects, |command| matches!(command, Command::StartPilot)), "{effects:?}");
        }
        "raise the craft's fence" => {
            user.press(keys);
            assert!(user.craft.number(FENCE) > fence, "{}", screen(&user.state));
        }
        "undo that" => {
            user.press(keys);
            assert!(user.craft.number(FENCE) < fence, "{}", screen(&user.state));
        }
        "see what the gain P changes in the flight" => {
            let effects = user.press(keys);
            let tried = effects.iter().find_map(|effect| match effect {
                Effect::Forecast(job) => match &job.request {
                    ForecastRequest::SettingChange { changed, .. } => Some(changed.concat()),
                    _ => None,
                },
                _ => None,
            });
            let tried = tried.unwrap_or_else(|| panic!("nothing is flown ahead\n{}", screen(&user.state)));
            assert!(tried.contains("p_"), "{tried}");
        }
        "find the last refusal" => {
            let refused = Refusal::Geofence { wp: 3, distance_cm: 15_043, limit_m: 100 };
            let kind = EventKind::Firmware(FirmwareEvent::Nav(NavEvent::Refused(refused)));
            for at in 0..40 {
                let kind = if at == 10 { kind.clone() } else { EventKind::Firmware(FirmwareEvent::Armed) };
                let time = SimTime::from_secs_f64(f64::from(at));
                update(&mut user.state, Msg::Event(Event { time, kind: SessionEvent::Vehicle(kind) }));
            }
            user.press(keys);
            let seen = screen(&user.state);
            assert!(seen.contains("Refused") && seen.contains("15043"), "{seen}");
        }
        "make the map wider" => {
            let width = |state: &AppState| {
                screen_layout::screen(&state.shared)
                    .and_then(|screen| screen.panel(Panel::Map))
                    .map(|map| map.width)
            };
            let before = width(&user.state);
            user.press(keys);
            assert!(width(&user.state) > before && before.is_some(), "{}", screen(&user.state));
        }
        "let the wind blow at 5 m/s" => {
            let effects = user.press(keys);
            let is_wind =
                |effect: &Effect| matches!(effect, Effect::World(line) if line.starts_with("wind=5@"));
            assert!(effects.iter().any(is_wind), "{effects:?}");
        }
        "raise the second waypoint by 10 m" => {
            let before = user.state.shared.editor.document().plan.waypoints[1].altitude.above_home_m();
            user.press(keys);
            let after = user.state.shared.editor.document().plan.waypoints[1].altitude;
            assert_eq!(after, Altitude::above_home(before + 10.0), "{}", screen(&user.state));
        }
        "cut the radio link" => {
            let effects = user.press(keys);
            let cuts = |command: &Command| format!("{command:?}").contains("CutRc(true)");
            assert!(sends(&effects, cuts), "{effects:?}");
        }
        "fly on from the state before" => {
            fixture::rewind(&mut user.state);
            let effects = user.press(keys);
            let seeks = |command: &Command| matches!(command, Command::Seek(_));
            assert!(sends(&effects, seeks), "{effects:?}");
            let branches = |command: &Command| matches!(command, Command::FlyOn);
            assert!(sends(&effects, branches), "{effects:?}");
        }
        "show the battery current as a graph" => {
            user.press(keys);
            let seen = screen(&user.state);
            assert!(seen.contains("✓ ") && seen.contains("current"), "{seen}");
            user.press(&["esc".to_owned()]);
        }
        "write the blackbox log of the flight so far" => {
            let effects = user.press(keys);
            assert!(effects.iter().any(|effect| matches!(effect, Effect::WriteFlight { .. })), "{effects:?}");
        }
        other => panic!("no check for the task {other:?}"),
    }
}

#[test]
fn the_twelve_tasks_of_the_guide_take_at_most_eight_keys_each() {
    let tasks = tasks();
    assert_eq!(tasks.len(), 12, "{tasks:?}");
    let mut user = User::new();
    assert_eq!(user.state.shared.view.vehicle.nav.as_ref().map(|nav| nav.state), Some(NavState::Idle));
    for (task, keys) in tasks {
        assert!((1..=8).contains(&keys.len()), "{task}: {keys:?}");
        check(&mut user, &task, &keys);
    }
}
