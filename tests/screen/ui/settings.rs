//! The Settings panel: a craft whose settings are read, searched, compared, changed and tried.

use std::time::Duration;

use betadeck::fc::{CraftSettings, UploadReport};
use betadeck::firmware::cli::Interpreter;
use betadeck::firmware::{Firmware, FirmwareOptions, config::Configuration};
use betadeck::flight::forecast::{FlightResult, Forecast, ForecastEnd, ForecastKind, WorstXte};
use betadeck::lookahead::{ForecastReply, ForecastRequest};
use betadeck::session::command::CliOutput;
use betadeck::telemetry::NavState;
use betadeck::ui::files::FileRequest;
use betadeck::ui::{AppState, Effect, Msg, update};
use crossterm::event::{MouseButton, MouseEventKind};

use crate::ui::hands::{keys, mouse, mouse_button, place_of, screen, state_with_fix};
use crate::ui::session_rig::Rig;

/// A firmware that answers the screen.
pub(crate) struct Craft {
    firmware: Firmware,
    console: Interpreter,
    /// The configuration that a restart brings back.
    saved: Configuration,
    /// The lines that it ran.
    ran: Vec<String>,
}

impl Craft {
    /// Returns a craft on which these lines were run before it was saved.
    pub(crate) fn with(lines: &[&str]) -> Self {
        let mut firmware = Firmware::new(Configuration::default(), FirmwareOptions::default());
        let mut console = Interpreter::default();
        for line in lines {
            assert!(!firmware.run_cli(&mut console, line).failed, "{line}");
        }
        let saved = firmware.configuration().clone();
        Self { firmware, console, saved, ran: Vec::new() }
    }

    /// Answers the effects until there are none for the craft. Returns the others.
    pub(crate) fn answer(&mut self, state: &mut AppState, effects: Vec<Effect>) -> Vec<Effect> {
        let mut others = Vec::new();
        let mut left: std::collections::VecDeque<Effect> = effects.into();
        while let Some(effect) = left.pop_front() {
            let reply = match effect {
                Effect::ReadSettings => {
                    let read =
                        CraftSettings::from_configuration(self.firmware.configuration(), Some(&self.saved));
                    Msg::SettingsReply(Ok(Box::new(read)))
                }
                Effect::Set(line) => {
                    let reply = self.firmware.run_cli(&mut self.console, &line);
                    self.ran.push(line.clone());
                    let output = CliOutput { text: reply.text, ..CliOutput::default() };
                    Msg::SetReply { line, output: Some(output) }
                }
                other => {
                    others.push(other);
                    continue;
                }
            };
            left.extend(update(state, reply));
        }
        others
    }

    /// Presses keys and answers.
    pub(crate) fn press(&mut self, state: &mut AppState, names: &str) -> Vec<Effect> {
        let effects = keys(state, names);
        self.answer(state, effects)
    }

    /// Shows the next picture and answers.
    pub(crate) fn go_on(&mut self, state: &mut AppState) {
        let later = state.shared.now + Duration::from_millis(1100);
        update(state, Msg::Clock(later));
        let view = state.shared.view.clone();
        let effects = update(state, Msg::View(view));
        self.answer(state, effects);
    }

    pub(crate) fn number(&self, name: &str) -> i64 {
        self.firmware.configuration().settings.number(name)
    }
}

/// Returns a screen of this size with the settings of a craft on it.
pub(crate) fn opened(size: (u16, u16), lines: &[&str]) -> (AppState, Craft) {
    let (mut state, mut craft) = (state_with_fix(size), Craft::with(lines));
    craft.press(&mut state, "9");
    craft.go_on(&mut state);
    (state, craft)
}

/// Returns a screen with the settings of a craft on which two are changed, after these keys.
pub(crate) fn opened_with(size: (u16, u16), typed: &str) -> AppState {
    let (mut state, mut craft) = opened(size, &["set ap_max_angle = 25", "set p_roll = 60"]);
    craft.press(&mut state, typed);
    state
}

/// Returns the line of a setting in the list.
fn row(state: &AppState, name: &str) -> String {
    let seen = screen(state);
    let line = seen.lines().find(|line| line.contains(&format!("{name} ")) && !line.contains('─'));
    line.unwrap_or_else(|| panic!("no {name} in\n{seen}")).to_owned()
}

fn said(state: &AppState) -> String {
    state.shared.notice.as_ref().map(|notice| notice.text.clone()).unwrap_or_default()
}

#[test]
fn changed_settings_come_first_and_each_has_its_value_unit_and_default() {
    let (state, _) = opened((120, 40), &["set ap_max_angle = 25", "set p_roll = 60"]);
    let seen = screen(&state);
    let (first, gyro) = (seen.find("─ Changed").unwrap(), seen.find("─ Gyro").unwrap());
    let angle = seen.find("● ap_max_angle").or(seen.find("●  ap_max_angle")).unwrap();
    assert!(first < angle && angle < gyro, "{seen}");
    let line = row(&state, "ap_max_angle");
    assert!(line.contains("25") && line.contains("deg"), "{line}");
}

#[test]
fn typing_finds_settings_by_name_and_by_description() {
    let (mut state, mut craft) = opened((80, 24), &[]);
    craft.press(&mut state, "/ 'fence");
    assert!(screen(&state).contains("ap_max_distance_from_home"), "{}", screen(&state));
    assert!(!screen(&state).contains("gyro_lpf1_type"));
    craft.press(&mut state, "enter n n N");
    assert!(screen(&state).contains("/fence"), "the search stays in the title");
    craft.press(&mut state, "esc");
    assert!(screen(&state).contains("ap_l1_turn_rate"), "what was found is among all: {}", screen(&state));
    craft.press(&mut state, "/ 'qqq enter");
    assert!(screen(&state).contains("No setting has"), "{}", screen(&state));
}

#[test]
fn a_value_is_typed_in_place_nudged_reset_undone_and_redone() {
    let (mut state, mut craft) = opened((80, 24), &[]);
    craft.press(&mut state, "/ 'ap_max_angle enter enter 'x enter");
    assert!(screen(&state).contains("✗ x is no value of ap_max_angle"), "{}", screen(&state));
    craft.press(&mut state, "backspace '30 enter");
    assert_eq!(craft.number("ap_max_angle"), 30);
    assert!(said(&state).starts_with("ap_max_angle = 30."), "{}", said(&state));
    assert!(row(&state, "ap_max_angle").contains("●"));
    craft.press(&mut state, "+ + -");
    assert_eq!(craft.number("ap_max_angle"), 31);
    craft.press(&mut state, "shift-up");
    assert_eq!(craft.number("ap_max_angle"), 41);
    craft.press(&mut state, "backspace");
    assert_eq!(craft.number("ap_max_angle"), 50, "its default");
    craft.press(&mut state, "u u u u u");
    assert_eq!(craft.number("ap_max_angle"), 30);
    craft.press(&mut state, "u");
    assert_eq!(craft.number("ap_max_angle"), 50);
    craft.press(&mut state, "u");
    assert_eq!(said(&state), "No change of a setting to undo.");
    craft.press(&mut state, "ctrl-r");
    assert_eq!(craft.number("ap_max_angle"), 30);
    assert!(craft.ran.iter().all(|line| line.starts_with("set ap_max_angle = ")), "{:?}", craft.ran);
    craft.go_on(&mut state);
    assert!(row(&state, "ap_max_angle").contains("30"));
}

#[test]
fn keys_pressed_before_the_craft_answers_count_from_the_new_value() {
    let (mut state, mut craft) = opened((80, 24), &[]);
    keys(&mut state, "/ 'ap_max_angle enter");
    let effects = keys(&mut state, "+ + +");
    assert!(row(&state, "ap_max_angle").contains("…"), "not confirmed: {}", row(&state, "ap_max_angle"));
    assert!(row(&state, "ap_max_angle").contains("53"));
    craft.answer(&mut state, effects);
    assert_eq!((craft.number("ap_max_angle"), craft.ran.len()), (53, 3));
}

#[test]
fn a_switch_is_switched_and_words_are_stepped_through_or_typed() {
    let (mut state, mut craft) = opened((80, 24), &[]);
    craft.press(&mut state, "/ 'ap_l1_enable enter enter");
    assert_eq!(craft.number("ap_l1_enable"), 0);
    craft.press(&mut state, "/ 'ap_yaw_mode enter enter");
    assert!(screen(&state).contains("Enter sets it"), "{}", screen(&state));
    craft.press(&mut state, "down enter");
    let second = craft.firmware.configuration().settings.text("ap_yaw_mode").to_owned();
    assert_ne!(second, "VELOCITY");
    craft.press(&mut state, "= 'velo enter");
    assert_eq!(craft.firmware.configuration().settings.text("ap_yaw_mode"), "VELOCITY");
}

#[test]
fn all_settings_are_reset_after_a_question_and_come_back_with_one_undo() {
    let (mut state, mut craft) = opened((80, 24), &["set ap_max_angle = 25", "set p_roll = 60"]);
    craft.press(&mut state, "X");
    assert!(screen(&state).contains("This changes 2 settings of the craft"), "{}", screen(&state));
    craft.press(&mut state, "n");
    assert!(craft.ran.is_empty());
    craft.press(&mut state, "X y");
    assert_eq!((craft.number("ap_max_angle"), craft.number("p_roll")), (50, 45));
    assert!(said(&state).starts_with("2 settings were set."), "{}", said(&state));
    craft.press(&mut state, "u");
    assert_eq!((craft.number("ap_max_angle"), craft.number("p_roll")), (25, 60));
}

#[test]
fn only_what_differs_from_the_defaults_the_plan_and_the_flash_is_compared() {
    let (mut state, mut craft) = opened((80, 24), &["set ap_max_angle = 25"]);
    craft.press(&mut state, "z / 'ap_max_velocity enter + esc f");
    let seen = screen(&state);
    assert!(seen.contains("changed from the defaults") && seen.contains("ap_max_velocity"), "{seen}");
    assert!(seen.contains("ap_max_angle") && !seen.contains("gyro_lpf1_type"), "{seen}");
    craft.press(&mut state, "f");
    assert!(screen(&state).contains("The open plan sets no settings."), "{}", screen(&state));
    craft.press(&mut state, "f");
    let seen = screen(&state);
    assert!(seen.contains("not saved in flash") && row(&state, "ap_max_velocity").contains("510"), "{seen}");
    assert!(row(&state, "ap_max_velocity").contains("500") && !seen.contains(" ap_max_angle "), "{seen}");
    craft.press(&mut state, "esc");
    assert!(screen(&state).contains("gyro_lpf1_type"));
}

#[test]
fn settings_go_into_the_plan_onto_the_clipboard_and_into_a_file() {
    let (mut state, mut craft) = opened((80, 24), &["set ap_max_angle = 25", "set p_roll = 60"]);
    let effects = craft.press(&mut state, "y");
    let copied = effects.iter().find_map(|effect| match effect {
        Effect::Copy(text) => Some(text.as_str()),
        _ => None,
    });
    assert_eq!(copied, Some("set ap_max_angle = 25\nprofile 0\nset p_roll = 60\n"));
    craft.press(&mut state, "/ 'ap_max_angle enter p");
    assert_eq!(state.shared.editor.document().settings, ["ap_max_angle = 25"]);
    craft.press(&mut state, "+");
    craft.press(&mut state, "f f");
    assert!(row(&state, "ap_max_angle").contains("26") && row(&state, "ap_max_angle").contains("25"));
    let effects = craft.press(&mut state, "s 'craft.txt enter");
    let saved = effects.iter().find_map(|effect| match effect {
        Effect::Files(FileRequest::SaveSettings { path, text, count }) => Some((path, text.as_str(), *count)),
        _ => None,
    });
    let (path, text, count) = saved.unwrap();
    assert!(path.ends_with("craft.txt") && count == 2, "{path:?}");
    assert_eq!(text, "set ap_max_angle = 26\nprofile 0\nset p_roll = 60\n");
}

#[test]
fn another_value_is_flown_ahead_with_the_difference_that_it_makes() {
    let (mut state, mut craft) = opened((80, 24), &[]);
    let effects = craft.press(&mut state, "/ 'ap_max_velocity enter w '900 enter");
    assert!(screen(&state).contains("with 900: flying ahead"), "{}", screen(&state));
    let revision = effects.iter().find_map(|effect| match effect {
        Effect::Forecast(job) => match &job.request {
            ForecastRequest::SettingChange { changed, .. } => {
                assert_eq!(changed, &["ap_max_velocity = 900"]);
                Some(job.revision)
            }
            _ => None,
        },
        _ => None,
    });
    let forecast = |time_s, xte_m, unchanged| Forecast {
        kind: ForecastKind::PlanEstimate,
        end: ForecastEnd::Flight(FlightResult::Complete),
        reason: String::new(),
        time_s,
        battery_used_pct: 40.0,
        worst_xte: Some(WorstXte { xte_m, wp: 1 }),
        fence_margin_m: None,
        legs: Vec::new(),
        moved_m: 0.0,
        path: Vec::new(),
        unchanged,
    };
    let flown = forecast(100.0, 1.4, Some(Box::new(forecast(130.0, 0.9, None))));
    let reply = ForecastReply {
        revision: revision.unwrap(),
        kind: ForecastKind::SettingChange,
        forecast: Ok(Box::new(flown)),
    };
    update(&mut state, Msg::Forecast(reply));
    keys(&mut state, "z");
    let seen = screen(&state);
    assert!(seen.contains("COMPLETE in 1:40, 60 % left") && seen.contains("time −0:30"), "{seen}");
    assert!(seen.contains("xte 0.9 m → 1.4 m"), "{seen}");
    assert!(craft.ran.is_empty(), "the craft keeps its value");
    keys(&mut state, "z 1");
    assert!(screen(&state).contains("··· ap_max_velocity = 900"), "{}", screen(&state));
    craft.press(&mut state, "9 enter enter");
    assert_eq!(craft.number("ap_max_velocity"), 900, "what was tried is offered");
}

#[test]
fn the_mouse_selects_edits_scrolls_and_opens_a_menu_with_everything() {
    let (mut state, mut craft) = opened((200, 60), &[]);
    craft.press(&mut state, "/ 'ap_max_ enter");
    let at = place_of(&state, "ap_max_angle  ");
    mouse(&mut state, MouseEventKind::Down, at);
    mouse(&mut state, MouseEventKind::Up, at);
    assert!(row(&state, "ap_max_angle").contains('▸'), "{}", screen(&state));
    mouse_button(&mut state, MouseEventKind::Down(MouseButton::Right), at);
    let seen = screen(&state);
    assert!(seen.contains("Raise the value, or take the next word") && seen.contains("Fly ahead"), "{seen}");
    let raise = place_of(&state, "Raise the value, or");
    let effects = mouse(&mut state, MouseEventKind::Down, raise);
    craft.answer(&mut state, effects);
    assert_eq!(craft.number("ap_max_angle"), 51);
    // The second press on the value begins to type.
    let at = place_of(&state, "ap_max_angle  ");
    mouse(&mut state, MouseEventKind::Down, at);
    mouse(&mut state, MouseEventKind::Down, (at.0 + 34, at.1));
    assert!(screen(&state).contains("Enter sets it"), "{}", screen(&state));
    craft.press(&mut state, "'20 enter");
    assert_eq!(craft.number("ap_max_angle"), 20);
    let before = row(&state, "ap_max_angle");
    mouse_button(&mut state, MouseEventKind::ScrollDown, at);
    assert!(before.contains('▸') && !row(&state, "ap_max_angle").contains('▸'));
}

#[test]
fn a_refused_value_is_taken_back_and_the_reason_named() {
    let (mut state, mut craft) = opened((80, 24), &[]);
    let effects = keys(&mut state, "/ 'ap_max_angle enter +");
    let line = effects.iter().find_map(|effect| match effect {
        Effect::Set(line) => Some(line.clone()),
        _ => None,
    });
    let output = CliOutput {
        text: "###ERROR: REWOUND###".to_owned(),
        advice: Some("An earlier instant is shown.".to_owned()),
        restarted: false,
    };
    update(&mut state, Msg::SetReply { line: line.unwrap(), output: Some(output) });
    assert_eq!(said(&state), "ap_max_angle was not set to 51: An earlier instant is shown.");
    craft.go_on(&mut state);
    assert!(row(&state, "ap_max_angle").contains("50"));
    craft.press(&mut state, "u");
    assert_eq!(said(&state), "No change of a setting to undo.");
}

#[tokio::test]
async fn in_flight_a_change_counts_at_once_and_the_past_keeps_its_values() {
    let mut rig = Rig::new().await;
    rig.keys("F").await;
    rig.fly_to(NavState::Approaching).await;
    rig.keys("9").await;
    let is_read = |state: &AppState| screen(state).contains("─ Changed");
    rig.until("the settings", is_read).await;
    rig.keys("/ap_max_angle\n+").await;
    // The plan sets 25.
    assert!(rig.cli("get ap_max_angle").await.text.contains("ap_max_angle = 26"));
    rig.fly_to(NavState::Arrived).await;
    rig.keys("{").await;
    rig.until("the past", |state| state.shared.is_rewound()).await;
    // The settings of the shown instant are read again within a second of the screen's clock.
    let later = rig.state.shared.now + Duration::from_secs(2);
    update(&mut rig.state, Msg::Clock(later));
    rig.until("the value before", |state| row(state, "ap_max_angle").contains(" 25 ")).await;
    rig.keys("+").await;
    assert!(said(&rig.state).contains("An earlier instant is shown"), "{}", said(&rig.state));
    rig.keys("e").await;
    rig.until("the end", |state| !state.shared.is_rewound()).await;
    update(&mut rig.state, Msg::Clock(later + Duration::from_secs(2)));
    rig.until("the newest value", |state| row(state, "ap_max_angle").contains(" 26 ")).await;
}

#[test]
fn a_setting_that_needs_a_restart_says_so() {
    let (mut state, mut craft) = opened((80, 24), &[]);
    craft.press(&mut state, "/ 'mag_hardware enter z");
    assert!(screen(&state).contains("↻ works after save and restart"), "{}", screen(&state));
}

#[test]
fn the_panel_at_four_sizes() {
    for (name, typed) in
        [("list", ""), ("search", "/ 'velocity"), ("edit", "/ 'max_vel enter enter"), ("differences", "f")]
    {
        let seen = [(60, 20), (80, 24), (120, 40), (200, 60)].map(|size| screen(&opened_with(size, typed)));
        insta::assert_snapshot!(format!("settings_{name}"), seen.join("\n"));
    }
}

#[test]
fn the_key_of_the_panel_and_a_comparison_ask_for_settings_that_an_upload_may_have_changed() {
    let asks = |effects: &[Effect]| effects.iter().any(|effect| matches!(effect, Effect::ReadSettings));
    let (mut state, mut craft) = opened((120, 40), &[]);
    for shows in ["9", "2 V"] {
        keys(&mut state, "1");
        assert!(!asks(&keys(&mut state, "9")), "they are known");
        keys(&mut state, "1");
        let id = state.shared.editor.plan().id();
        update(&mut state, Msg::UploadReply { id, count: 4, result: Ok(UploadReport::default()) });
        let effects = keys(&mut state, shows);
        assert!(asks(&effects), "{shows}");
        craft.answer(&mut state, effects);
        keys(&mut state, "esc");
    }
}
