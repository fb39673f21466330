//! The events of a flight as they are recorded.

use serde::{Deserialize, Serialize};

use crate::signals::SimTime;
use crate::telemetry::{Event, EventKind, FirmwareEvent};

/// An event with its time since boot.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedEvent {
    pub time: SimTime,
    pub what: Happened,
}

/// Something that happened.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Happened {
    /// An event of the vehicle. The notices of its firmware are sentences.
    Vehicle(EventKind),
    /// A sentence for the user.
    Notice(String),
}

impl From<EventKind> for Happened {
    fn from(kind: EventKind) -> Self {
        match kind {
            EventKind::Firmware(FirmwareEvent::Notice(notice)) => Self::Notice(notice.to_string()),
            kind => Self::Vehicle(kind),
        }
    }
}

impl From<Event> for RecordedEvent {
    fn from(event: Event) -> Self {
        Self { time: event.time, what: event.kind.into() }
    }
}
