//! The events of a flight for displays, logs and reports: those of the vehicle, and those of the program around it.

mod notice;

use std::net::SocketAddr;

pub use notice::{Notice, ReplayNotice, SimulatorNotice};

use crate::fc::RemoteNotice;
use crate::signals::{RcFrame, SimTime};
use crate::telemetry::{self, EventKind};

/// An event with its time.
#[derive(Debug, Clone, PartialEq)]
pub struct Event {
    /// Simulated time since boot.
    pub time: SimTime,
    pub kind: SessionEvent,
}

#[derive(Debug, Clone, PartialEq)]
pub enum SessionEvent {
    Vehicle(EventKind),
    /// A notice for the user, as a sentence.
    Notice(String),
    /// A notice about something that went wrong or will, such as a failed save.
    Warning(String),
    /// A notice about the remote flight controller.
    Remote(RemoteNotice),
    /// The reason why a craft does not arm although its script holds the ARM switch on, as a sentence.
    ArmingBlocked(String),
    /// Other programs can reach the vehicle from now on.
    Endpoints(EndpointAddresses),
    /// A notice about the recorded flight that is shown.
    Replay(ReplayNotice),
    /// A notice about the external simulator that moves the craft.
    Simulator(SimulatorNotice),
    /// A state from an external simulator that arrived before any was accepted.
    FirstState {
        /// The simulator's clock, s.
        stamp_s: f64,
        from: SocketAddr,
    },
    /// The first RC frame from a script.
    FirstRc {
        /// The script's clock, s.
        stamp_s: f64,
        frame: RcFrame,
    },
    /// A client of a link restarted the firmware, which loaded the stored configuration.
    Restarted,
    /// The flight continued from an earlier instant, that of this event. The part after it is discarded.
    Branch {
        /// The number of branches so far.
        number: u32,
        /// The newest instant of the discarded part.
        left: SimTime,
    },
}

/// The addresses at which other programs reach the vehicle; `None` = that endpoint is closed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct EndpointAddresses {
    /// The websocket of the Betaflight App.
    pub ws: Option<SocketAddr>,
    /// Command line and MSP over TCP.
    pub tcp: Option<SocketAddr>,
    /// States from an external simulator, UDP.
    pub fdm: Option<SocketAddr>,
    /// RC from scripts, UDP.
    pub rc: Option<SocketAddr>,
}

impl From<Notice> for SessionEvent {
    fn from(Notice { text, is_warning }: Notice) -> Self {
        if is_warning { Self::Warning(text) } else { Self::Notice(text) }
    }
}

impl Event {
    /// Creates a notice at this time.
    pub fn notice(time: SimTime, notice: impl Into<Notice>) -> Self {
        Self { time, kind: notice.into().into() }
    }
}

impl From<telemetry::Event> for Event {
    fn from(event: telemetry::Event) -> Self {
        Self { time: event.time, kind: SessionEvent::Vehicle(event.kind) }
    }
}
