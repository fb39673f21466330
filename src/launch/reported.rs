//! Messages about a remote firmware on standard error.

use crate::events::{Event, SessionEvent};
use crate::fc::RemoteNotice;
use crate::process::error;

/// Returns the sentence for the user; `None` for the output of its program, and for events that are not notices.
pub(crate) fn sentence(event: &Event) -> Option<String> {
    match &event.kind {
        SessionEvent::Remote(RemoteNotice::Output(_)) => None,
        SessionEvent::Remote(notice) => Some(notice.to_string()),
        SessionEvent::Notice(notice) | SessionEvent::Warning(notice) => Some(notice.clone()),
        _ => None,
    }
}

/// Prints the sentence on standard error.
pub(crate) fn tell(event: &Event) {
    if let Some(sentence) = sentence(event) {
        error::tell(&sentence);
    }
}
