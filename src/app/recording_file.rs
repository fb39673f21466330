//! What recordings of flights have in common, whoever records them: the first line, the events, the sentences.
#![allow(clippy::disallowed_methods, reason = "a recording has its date")]

use std::time::SystemTime;

use crate::recording::{FORMAT, Happened, Header, RecordedEvent};
use crate::report::{UtcSeconds, sentence};
use crate::session::{Event, SessionEvent};

/// Returns the first line of a recording that begins now.
pub(super) fn header(plan: &str) -> Header {
    Header {
        format: FORMAT,
        program: format!("{} ({})", env!("CARGO_PKG_VERSION"), env!("BETADECK_REVISION")),
        date: now().to_string(),
        plan: plan.to_owned(),
    }
}

/// Returns the present time.
pub(super) fn now() -> UtcSeconds {
    let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
    UtcSeconds(since.map_or(0, |since| since.as_secs()))
}

/// Returns an event as it is recorded; `None` for one that only matters to the running program.
pub(super) fn recorded(event: &Event) -> Option<RecordedEvent> {
    let what = match &event.kind {
        SessionEvent::Vehicle(kind) => kind.clone().into(),
        // The part that was left is not in the recording.
        SessionEvent::Branch { .. } => return None,
        other => Happened::Notice(sentence::text(other)?),
    };
    Some(RecordedEvent { time: event.time, what })
}
