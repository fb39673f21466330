//! Commands that go through the craft's command line.

use strum::IntoEnumIterator as _;

use crate::fc::{CraftSetting, cli_block};
use crate::telemetry::FirmwareProfile;
use crate::ui::model::action::Action;
use crate::ui::model::effect::Effect;
use crate::ui::model::files::FileRequest;
use crate::ui::model::message::Request;
use crate::ui::model::panel_table::Panel;
use crate::ui::shared::Shared;

/// Runs `set NAME=VALUE`, or `set NAME` to read the value.
pub(super) fn set(_: &mut Shared, _: &str, argument: &str) -> Result<Vec<Request>, String> {
    if argument.is_empty() {
        return Err("Write :set NAME=VALUE, such as :set ap_max_angle=25.".to_owned());
    }
    let line = match argument.split_once(['=', ' ']) {
        Some((name, value)) => match value.trim().trim_start_matches('=').trim_start() {
            "" => format!("get {}", name.trim()),
            value => format!("set {} = {value}", name.trim()),
        },
        None => format!("get {argument}"),
    };
    Ok(vec![Request::Cli { line, is_reported: true }])
}

/// Returns the matching names of settings and their values.
pub(super) fn complete_set(state: &Shared, _: &str, typed: &str) -> Vec<String> {
    let lines = (state.cli_help.complete)(&format!("set {typed}"));
    let arguments = lines.iter().filter_map(|line| line.strip_prefix("set "));
    // After a name, only its value can follow.
    arguments.map(|line| if line.contains('=') { line.to_owned() } else { format!("{line}=") }).collect()
}

/// Changes the laws of the embedded autopilot.
pub(super) fn profile(state: &mut Shared, _: &str, name: &str) -> Result<Vec<Request>, String> {
    let Ok(profile) = name.parse::<FirmwareProfile>() else {
        return Err("Write :profile guide or :profile master.".to_owned());
    };
    if state.view.remote.is_some() {
        return Err("The flight controller is another program, whose laws are its own.".to_owned());
    }
    if state.view.vehicle.craft.armed == Some(true) {
        return Err("The laws cannot change in flight: disarm first.".to_owned());
    }
    let line = format!("set {}", profile.setting());
    Ok(vec![Request::Cli { line, is_reported: true }])
}

/// Returns the names of the profiles.
pub(super) fn complete_profile(_: &Shared, _: &str, typed: &str) -> Vec<String> {
    let names = FirmwareProfile::iter().map(|profile| profile.to_string());
    names.filter(|name| name.starts_with(typed)).collect()
}

/// Runs a line of the firmware's command line and shows the CLI panel with the answer. Without an argument it only
/// shows the panel.
pub(super) fn cli(_: &mut Shared, _: &str, argument: &str) -> Result<Vec<Request>, String> {
    let line = (!argument.is_empty()).then(|| Request::Cli { line: argument.to_owned(), is_reported: false });
    Ok([Request::Act(Action::Show(Panel::Cli))].into_iter().chain(line).collect())
}

/// Returns the firmware's completions.
pub(super) fn complete_cli(state: &Shared, _: &str, typed: &str) -> Vec<String> {
    (state.cli_help.complete)(typed)
}

/// Saves the settings that differ from their defaults as lines of the command line.
pub(super) fn settings_file(state: &mut Shared, _: &str, file: &str) -> Result<Vec<Request>, String> {
    if file.is_empty() {
        return Err("Write :settings-file FILE, such as :settings-file craft.txt.".to_owned());
    }
    let path = std::path::absolute(file).map_err(|error| format!("{file}: {error}."))?;
    let Some(craft) = state.settings.craft() else {
        let show = state.key(Action::Show(Panel::Settings));
        return Err(format!("The settings of the craft were not read yet: `{show}` shows them."));
    };
    let changed: Vec<&CraftSetting> = craft.all.iter().filter(|setting| setting.is_changed()).collect();
    if changed.is_empty() {
        return Err("Every setting has its default, so there is nothing to save.".to_owned());
    }
    let (count, text) = (changed.len(), cli_block(&changed));
    Ok(vec![Effect::Files(FileRequest::SaveSettings { path, text, count }).into()])
}
