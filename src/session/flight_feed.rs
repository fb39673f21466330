//! What a session passes to a recorder of flights. It never waits for the recorder.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::reply::ReplyTo;
use crate::events::Event;
use crate::plan::FlightPlan;
use crate::recording::{Cadence, Seen};
use crate::signals::SimTime;
use crate::timeline::Timeline;
use crate::vehicle::{Vehicle, VehicleCommand};

/// The pictures that may wait for a slow recorder. Later ones are left out until it catches up.
const MAX_PICTURES: usize = 1000;
/// The size of the inputs that may wait for a slow recorder, bytes.
const MAX_INPUT_BYTES: usize = 32 << 20;

/// A part of a flight, in the order of the session.
#[derive(Debug)]
pub enum FlightPart {
    /// A command that the vehicle took before the tick at this time.
    Input(SimTime, VehicleCommand),
    /// Commands are missing from here on.
    Gap,
    Event(Event),
    Picture(Box<Seen>),
    /// The flight continued from this earlier instant, with this many inputs since boot.
    Branch {
        at: SimTime,
        inputs: u64,
    },
    /// A plan with this name is uploaded to the craft.
    Plan(String, Box<FlightPlan>),
    /// Asks for the recording of the flight so far.
    Copy(ReplyTo<Result<Vec<u8>, String>>),
}

/// The parts that wait for the recorder.
#[derive(Debug, Default)]
struct Waiting {
    pictures: AtomicUsize,
    input_bytes: AtomicUsize,
}

/// Sends parts of a flight to a recorder.
#[derive(Debug, Clone)]
pub(super) struct FeedSender {
    parts: std::sync::mpsc::Sender<FlightPart>,
    waiting: Arc<Waiting>,
}

impl FeedSender {
    /// Sends a part. A recorder that has ended gets none.
    pub(super) fn send(&self, part: FlightPart) {
        self.parts.send(part).ok();
    }
}

/// The recorder's end.
#[derive(Debug)]
pub struct FeedReceiver {
    parts: std::sync::mpsc::Receiver<FlightPart>,
    waiting: Arc<Waiting>,
}

impl FeedReceiver {
    /// Returns the next part; `None` if none comes within `timeout`.
    ///
    /// # Errors
    /// Returns an error after the last part of a session that has ended.
    pub fn next(
        &self,
        timeout: std::time::Duration,
    ) -> Result<Option<FlightPart>, std::sync::mpsc::RecvError> {
        use std::sync::mpsc::RecvTimeoutError;
        let part = match self.parts.recv_timeout(timeout) {
            Ok(part) => part,
            Err(RecvTimeoutError::Timeout) => return Ok(None),
            Err(RecvTimeoutError::Disconnected) => return Err(std::sync::mpsc::RecvError),
        };
        match &part {
            FlightPart::Picture(_) => _ = self.waiting.pictures.fetch_sub(1, Ordering::Relaxed),
            FlightPart::Input(_, input) => {
                self.waiting.input_bytes.fetch_sub(input.bytes(), Ordering::Relaxed);
            }
            _ => {}
        }
        Ok(Some(part))
    }
}

/// The session's end: follows the vehicle that flies.
#[derive(Debug)]
pub struct FlightFeed {
    sender: FeedSender,
    cadence: Cadence,
    /// Number of the first input of the timeline that was not sent.
    next_input: u64,
    /// The number of inputs before those of the timeline.
    earlier: u64,
}

/// Returns both ends. The recorder has `earlier` inputs from before those of the session's timeline.
pub fn flight_feed(earlier: u64) -> (FlightFeed, FeedReceiver) {
    let (parts, receiver) = std::sync::mpsc::channel();
    let waiting = Arc::<Waiting>::default();
    let sender = FeedSender { parts, waiting: Arc::clone(&waiting) };
    let feed = FlightFeed { sender, cadence: Cadence::default(), next_input: 0, earlier };
    (feed, FeedReceiver { parts: receiver, waiting })
}

impl FlightFeed {
    /// Returns a sender for the events.
    pub(super) fn sender(&self) -> FeedSender {
        self.sender.clone()
    }

    /// Sends the inputs that the timeline has recorded since the last call.
    pub(super) fn take_inputs(&mut self, timeline: &Timeline) {
        let next = timeline.next_input();
        if next == self.next_input {
            return;
        }
        if timeline.first_input() > self.next_input {
            self.sender.send(FlightPart::Gap);
        }
        for (time, input) in timeline.inputs_from(self.next_input) {
            let waiting = &self.sender.waiting.input_bytes;
            if waiting.fetch_add(input.bytes(), Ordering::Relaxed) > MAX_INPUT_BYTES {
                waiting.fetch_sub(input.bytes(), Ordering::Relaxed);
                self.sender.send(FlightPart::Gap);
                break;
            }
            self.sender.send(FlightPart::Input(time, input.clone()));
        }
        self.next_input = next;
    }

    /// Sends a picture of the vehicle if one is due.
    pub(super) fn look(&mut self, vehicle: &Vehicle) {
        let pictures = &self.sender.waiting.pictures;
        if pictures.load(Ordering::Relaxed) < MAX_PICTURES
            && let Some(seen) = self.cadence.due(vehicle)
        {
            pictures.fetch_add(1, Ordering::Relaxed);
            self.sender.send(FlightPart::Picture(Box::new(seen)));
        }
    }

    /// Notes that the flight continues from an earlier instant, whose inputs the timeline has kept.
    pub(super) fn branch(&mut self, at: SimTime, timeline: &Timeline) {
        self.next_input = timeline.next_input();
        self.sender.send(FlightPart::Branch { at, inputs: self.earlier + self.next_input });
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::flight::FlightSetup;

    fn parts(receiver: &FeedReceiver) -> Vec<FlightPart> {
        std::iter::from_fn(|| receiver.next(Duration::ZERO).ok().flatten()).collect()
    }

    #[test]
    fn a_recorder_that_does_not_keep_up_loses_pictures_and_no_inputs() {
        let (mut vehicle, _) = FlightSetup::default().build().unwrap();
        let mut timeline = Timeline::new(&mut vehicle).unwrap();
        let (mut feed, receiver) = flight_feed(0);
        vehicle.apply(&VehicleCommand::StartPilot(5.0)).accepted().unwrap();
        let ticks = 150_000;
        for tick in 0..ticks {
            if tick % 1000 == 0 {
                let _reported = vehicle.apply(&VehicleCommand::single_line("status"));
            }
            timeline.record(&mut vehicle);
            feed.take_inputs(&timeline);
            vehicle.tick();
            vehicle.drain_events(drop);
            feed.look(&vehicle);
        }
        let parts = parts(&receiver);
        let pictures = parts.iter().filter(|part| matches!(part, FlightPart::Picture(_))).count();
        let inputs = parts.iter().filter(|part| matches!(part, FlightPart::Input(..))).count();
        assert_eq!((pictures, inputs), (MAX_PICTURES, 151));
        vehicle.tick();
        while vehicle.time().0 % 1_000_000 != 0 {
            vehicle.tick();
        }
        feed.look(&vehicle);
        assert_eq!(parts_of(&receiver), 1, "it goes on once the recorder has caught up");
    }

    fn parts_of(receiver: &FeedReceiver) -> usize {
        parts(receiver).len()
    }
}
