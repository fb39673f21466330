//! Sends the events of the vehicle and of the session to their receivers.

use tokio::sync::mpsc;

use super::flight_feed::{FeedSender, FlightPart};
use crate::events::{Event, Notice, SessionEvent};
use crate::signals::SimTime;
use crate::telemetry::{EventKind, FirmwareEvent};
use crate::timeline::Marks;
use crate::vehicle::Vehicle;

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
    /// The number of events sent so far.
    sent: u64,
}

impl EventSender {
    pub(super) fn new(receiver: mpsc::UnboundedSender<Event>) -> Self {
        Self { receiver, recorder: None, marks: Marks::default(), disarmed: false, sent: 0 }
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

    /// Returns the number of events sent so far.
    pub(super) fn sent(&self) -> u64 {
        self.sent
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
        self.sent += 1;
        let _is_heard = self.receiver.send(event.clone());
    }
}
