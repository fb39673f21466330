//! What is told of a firmware outside on standard error.

use crate::app::error;
use crate::session::{Event, RemoteNotice, SessionEvent};

/// The sentence for the user; `None` for what its program prints, and for what is no notice.
pub(in crate::app) fn sentence(event: &Event) -> Option<String> {
    match &event.kind {
        SessionEvent::Remote(RemoteNotice::Output(_)) => None,
        SessionEvent::Remote(notice) => Some(notice.to_string()),
        SessionEvent::Notice(notice) => Some(notice.clone()),
        _ => None,
    }
}

/// Tells it on standard error.
pub(in crate::app) fn tell(event: &Event) {
    if let Some(sentence) = sentence(event) {
        error::tell(&sentence);
    }
}
