//! Commands that go through the craft's command line.

use crate::ui::action::Action;
use crate::ui::message::Request;
use crate::ui::panel::Panel;
use crate::ui::shared::Shared;

/// Runs `set NAME=VALUE`, or `set NAME` to read the value.
pub(super) fn set(_: &mut Shared, _: &str, argument: &str) -> Result<Vec<Request>, String> {
    if argument.is_empty() {
        return Err("Write :set NAME=VALUE, such as :set ap_max_angle=25.".to_owned());
    }
    let line = match argument.split_once(['=', ' ']) {
        Some((name, value)) => {
            format!("set {} = {}", name.trim(), value.trim().trim_start_matches('=').trim_start())
        }
        None => format!("get {argument}"),
    };
    Ok(vec![Request::Cli { line, is_reported: true }])
}

/// Returns the matching names of settings and their values.
pub(super) fn complete_set(state: &Shared, _: &str, typed: &str) -> Vec<String> {
    let lines = (state.cli_help.complete)(&format!("set {typed}"));
    lines.iter().filter_map(|line| line.strip_prefix("set ")).map(str::to_owned).collect()
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
