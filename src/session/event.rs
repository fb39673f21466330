//! The reports of a session: the vehicle's events, and events of the program around it.

use std::net::SocketAddr;

use tokio::sync::mpsc;

use super::flight_feed::{FeedSender, FlightPart};
use super::notice::Notice;
use super::replay::ReplayNotice;
use super::simulator::SimulatorNotice;
use crate::fc::RemoteNotice;
use crate::signals::{RcFrame, SimTime};
use crate::telemetry::{self, EventKind, FirmwareEvent};
use crate::timeline::Marks;
use crate::vehicle::Vehicle;

/// An event of the session with its time.
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

/// Sends the events of a vehicle and the notices about it in the order of their occurrence, and adds the
/// marks for them.
#[derive(Debug)]
pub(super) struct EventSender {
    receiver: mpsc::UnboundedSender<Event>,
    /// The recorder of flights, if there is one.
    recorder: Option<FeedSender>,
    marks: Marks,
    /// `true` if the craft was disarmed since the last query.
    disarmed: bool,
}

impl EventSender {
    pub(super) fn new(receiver: mpsc::UnboundedSender<Event>) -> Self {
        Self { receiver, recorder: None, marks: Marks::default(), disarmed: false }
    }

    /// Sends all later events to a recorder, too.
    pub(super) fn record(&mut self, recorder: FeedSender) {
        self.recorder = Some(recorder);
    }

    pub(super) fn marks(&self) -> &Marks {
        &self.marks
    }

    /// Reports that the flight of `vehicle` continues from here, an earlier instant than `left`.
    pub(super) fn branch(&mut self, vehicle: &mut Vehicle, number: u32, left: SimTime) {
        self.marks.forget_after(vehicle.time());
        self.report(vehicle, SessionEvent::Branch { number, left });
    }

    /// Sends the events of a flight that was flown before.
    pub(super) fn send_all(&mut self, events: &[Event]) {
        events.iter().for_each(|event| self.send(event));
    }

    /// Sends the new events of the vehicle.
    pub(super) fn send_events_of(&mut self, vehicle: &mut Vehicle) {
        vehicle.drain_events(|event| self.send(&event.into()));
    }

    /// Returns `true` if the craft was disarmed since the last call.
    pub(super) fn take_disarmed(&mut self) -> bool {
        std::mem::take(&mut self.disarmed)
    }

    /// Sends a notice after the earlier events of the vehicle.
    pub(super) fn notice(&mut self, vehicle: &mut Vehicle, notice: impl Into<Notice>) {
        self.report(vehicle, notice.into().into());
    }

    /// Sends any event, in the same way as [`Self::notice`].
    pub(super) fn report(&mut self, vehicle: &mut Vehicle, kind: SessionEvent) {
        self.send_events_of(vehicle);
        self.send(&Event { time: vehicle.time(), kind });
    }

    /// Sends a notice about an earlier instant.
    pub(super) fn notice_at(&mut self, time: SimTime, notice: impl Into<Notice>) {
        self.send(&Event::notice(time, notice));
    }

    pub(super) fn send(&mut self, event: &Event) {
        if let SessionEvent::Vehicle(kind) = &event.kind {
            self.marks.note(event.time, kind);
            self.disarmed |= matches!(kind, EventKind::Firmware(FirmwareEvent::Disarmed(_)));
        }
        if let Some(recorder) = &self.recorder {
            recorder.send(FlightPart::Event(event.clone()));
        }
        let _is_heard = self.receiver.send(event.clone());
    }
}
