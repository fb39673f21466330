//! What recordings of flights have in common, whoever records them: the first line, the events, the sentences.
#![allow(clippy::disallowed_methods, reason = "a recording has its date")]

mod recorder;

use std::path::PathBuf;
use std::time::SystemTime;

use crate::events::{Event, SessionEvent};
use crate::files::named_file::Kind;
use crate::process::build;
use crate::recording::{FORMAT, Happened, Header, RecordedEvent};
use crate::report::{UtcSeconds, sentence};

pub(crate) use recorder::Recorder;

/// The first bytes of a recording, those of a gzip member.
pub(crate) const GZIP: [u8; 2] = [0x1f, 0x8b];
const RECORDING: Kind = Kind { extension: "flight", command: "record" };

/// Writes a recording to `file`, or to a new file named after the plan. Never replaces an existing file. Returns a
/// sentence with the name of the file, or with the reason for a failure.
pub(crate) fn write(file: Option<PathBuf>, plan: &str, bytes: &[u8]) -> Result<String, String> {
    let path = RECORDING.write(file, plan, bytes)?;
    let shown = path.display();
    Ok(format!("The flight so far is recorded as {shown}: `betadeck open {shown}` flies it again."))
}

/// Returns the first line of a recording that begins now.
pub(crate) fn header(plan: &str) -> Header {
    Header { format: FORMAT, program: build::version(), date: now().to_string(), plan: plan.to_owned() }
}

/// Returns the present time.
pub(crate) fn now() -> UtcSeconds {
    let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
    UtcSeconds(since.map_or(0, |since| since.as_secs()))
}

/// Returns an event as it is recorded; `None` for one that only matters to the running program.
pub(crate) fn recorded(event: &Event) -> Option<RecordedEvent> {
    let what = match &event.kind {
        SessionEvent::Vehicle(kind) => kind.clone().into(),
        // The part that was left is not in the recording.
        SessionEvent::Branch { .. } => return None,
        other => Happened::Notice(sentence::text(other)?),
    };
    Some(RecordedEvent { time: event.time, what })
}
