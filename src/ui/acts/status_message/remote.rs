//! Messages about a remote flight controller: its connection, and the state of a real craft.

use super::{StatusMessage, message};
use crate::fc::{RemoteState, RemoteView};
use crate::ui::acts::arming_hint::most_useful_flag;
use crate::ui::model::action::{Action, EditAction};
use crate::ui::model::event_log::Severity;
use crate::ui::model::panel_table::Panel;
use crate::ui::shared::Shared;

/// Returns the message about the connection, or any message about a real craft; `None` if the messages of a simulated
/// craft apply.
pub(super) fn current(state: &Shared, remote: &RemoteView) -> Option<StatusMessage> {
    let name = &remote.name;
    let is_real = remote.access.is_limited();
    match &remote.state {
        RemoteState::Unusable(sentence) if is_real => {
            message(Severity::Fault, sentence, "plug in another one, or name another place with --connect")
        }
        RemoteState::Unusable(sentence) => {
            message(Severity::Fault, sentence, format!("{} ends the program", state.key(Action::Quit)))
        }
        RemoteState::Connecting => {
            let action = if is_real { "plug it in; trying again" } else { "wait until it has started" };
            message(Severity::Warn, format!("No connection to {name} yet."), action)
        }
        RemoteState::Lost => {
            let condition = format!("The connection to {name} is lost.");
            message(Severity::Fault, condition, "reconnecting; the values shown are old")
        }
        RemoteState::Identifying => {
            message(Severity::Info, format!("{name} is being identified."), "wait a moment")
        }
        RemoteState::Ready if is_real => ready(state, remote),
        RemoteState::Ready => None,
    }
}

/// Returns the message for a real craft that answers.
fn ready(state: &Shared, remote: &RemoteView) -> Option<StatusMessage> {
    let vehicle = &state.view.vehicle;
    let craft = &vehicle.craft;
    let [cli, download, upload] =
        [Action::Show(Panel::Cli), Action::Edit(EditAction::Download), Action::Upload]
            .map(|action| state.key(action));
    if remote.in_cli {
        let action = format!("{cli} CLI: `exit` leaves it, which restarts the craft");
        return message(Severity::Warn, "The command line is open: telemetry stops.", action);
    }
    if craft.is_armed() {
        if craft.failsafe_stage.is_some_and(|stage| stage > 0) {
            return message(Severity::Fault, "Failsafe: the RC link is lost.", "its own rules bring it down");
        }
        return message(Severity::Warn, "Armed.", "its own transmitter flies and disarms it");
    }
    if craft.armed.is_none() {
        let condition = "The flight controller does not report arming.";
        return message(Severity::Warn, condition, "wait for an answer");
    }
    if craft.gps_fix == Some(false) {
        return message(Severity::Warn, "No GPS fix yet.", "wait for satellites");
    }
    if let Some(flag) = most_useful_flag(craft.arming_flags()) {
        return message(Severity::Warn, format!("Arming is blocked: {flag}."), flag.hint());
    }
    if vehicle.stored_plan.as_ref().is_some_and(|plan| plan.waypoints.is_empty()) {
        return message(Severity::Info, "The craft has no plan.", format!("{upload} uploads the open one"));
    }
    let action = format!("{download} downloads its plan, {cli} opens the CLI");
    message(Severity::Good, "Disarmed; nothing blocks arming.", action)
}
