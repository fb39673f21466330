//! The requests whose outcome is not known at once, and what is answered then.

use std::time::Duration;

use tokio::sync::oneshot;

use super::controls::Until;
use super::texts::ascii;
use crate::fc::UploadReport;
use crate::mavlink::craft::Ticket;
use crate::plan::FlightPlan;
use crate::session::SessionView;
use crate::session::command::CliOutput;

/// The longest answer about a mission, lines.
const MAX_LINES: usize = 12;

/// A request whose outcome is not known yet.
pub(super) enum Waiting {
    /// A switch was moved; the time after which it had no effect.
    Switch(Ticket, Until, Duration),
    /// A mission is uploaded: the plan, and the lines about it.
    Upload(Ticket, oneshot::Receiver<Result<UploadReport, String>>, FlightPlan, Vec<String>),
    /// A mission was uploaded and is to be shown as the stored plan; the time after which that does not matter.
    Shown(Ticket, FlightPlan, Vec<String>, Duration),
    /// A setting is changed: its name, the new value, the answer of the command line.
    Setting(Ticket, String, f32, oneshot::Receiver<CliOutput>),
}

/// Returns the answer if there is one; `Err` if there will be none.
pub(super) fn taken<T>(receiver: &mut oneshot::Receiver<T>) -> Option<Result<T, ()>> {
    match receiver.try_recv() {
        Ok(answer) => Some(Ok(answer)),
        Err(oneshot::error::TryRecvError::Empty) => None,
        Err(oneshot::error::TryRecvError::Closed) => Some(Err(())),
    }
}

/// Returns what the command line says of a `set`: its first line as the error if the value was not taken.
pub(super) fn as_set(answer: Result<CliOutput, ()>) -> Result<(), String> {
    let text = answer.map(|answer| answer.text).unwrap_or_default();
    if text.contains("set to") {
        return Ok(());
    }
    let said = text.lines().map(str::trim).find(|line| !line.is_empty());
    Err(said.unwrap_or("The craft did not answer.").to_owned())
}

/// Returns the first lines, and the number of the others.
pub(super) fn shortened(mut lines: Vec<String>) -> Vec<String> {
    let more = lines.len().saturating_sub(MAX_LINES);
    if more > 0 {
        lines.truncate(MAX_LINES);
        lines.push(format!("and {more} more differences"));
    }
    lines.iter().map(|line| ascii(line)).collect()
}

pub(super) fn outcome(view: &SessionView, until: Until) -> Option<bool> {
    let vehicle = &view.vehicle;
    match until {
        Until::Now => Some(true),
        Until::Armed => vehicle.craft.armed,
        Until::Disarmed => vehicle.craft.armed.map(|armed| !armed),
        Until::Engaged => Some(vehicle.is_engaged()),
    }
}

/// Returns the reason why a switch had no effect.
pub(super) fn without_effect(view: &SessionView, until: Until) -> String {
    let vehicle = &view.vehicle;
    match until {
        Until::Armed => match vehicle.craft.arming_flags() {
            flags if flags.is_empty() => "The craft did not arm.".to_owned(),
            flags => format!("Cannot arm: {flags}."),
        },
        Until::Engaged => match vehicle.nav.as_ref().and_then(|nav| nav.refusal) {
            Some(refusal) => format!("Autopilot refused: {refusal}"),
            None => "The autopilot did not engage.".to_owned(),
        },
        Until::Now | Until::Disarmed => "The craft did not disarm.".to_owned(),
    }
}
