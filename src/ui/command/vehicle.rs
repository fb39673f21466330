//! Commands that go through the craft's command line.

use crate::ui::app_state::AppState;
use crate::ui::message::Effect;
use crate::ui::panel::Panel;
use crate::ui::update;

/// Runs `set NAME=VALUE`, or `set NAME` to read the value.
pub(super) fn set(state: &mut AppState, _: &str, argument: &str) -> Result<Vec<Effect>, String> {
    if argument.is_empty() {
        return Err("Write :set NAME=VALUE, such as :set ap_max_angle=25.".to_owned());
    }
    let line = match argument.split_once(['=', ' ']) {
        Some((name, value)) => {
            format!("set {} = {}", name.trim(), value.trim().trim_start_matches('=').trim_start())
        }
        None => format!("get {argument}"),
    };
    state.cli.run_and_report(line);
    Ok(update::run_cli(state))
}

/// Returns the matching names of settings and their values.
pub(super) fn complete_set(state: &AppState, _: &str, typed: &str) -> Vec<String> {
    let lines = (state.cli_help.complete)(&format!("set {typed}"));
    lines.iter().filter_map(|line| line.strip_prefix("set ")).map(str::to_owned).collect()
}

/// Runs a line of the firmware's command line and shows the CLI panel with the answer. Without an argument it only
/// shows the panel.
pub(super) fn cli(state: &mut AppState, _: &str, argument: &str) -> Result<Vec<Effect>, String> {
    let mut effects = update::focus(state, Panel::Cli);
    if !argument.is_empty() {
        state.cli.run_line(argument.to_owned());
        effects.extend(update::run_cli(state));
    }
    Ok(effects)
}

/// Returns the firmware's completions.
pub(super) fn complete_cli(state: &AppState, _: &str, typed: &str) -> Vec<String> {
    (state.cli_help.complete)(typed)
}
