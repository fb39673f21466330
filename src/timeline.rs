//! The recorded flight: recording, rewind and branches.
//!
//! `recording` keeps frozen vehicles and the inputs between them, `replay` flies from one of them to an earlier
//! instant, `marks` keeps the times of events. While an earlier instant is shown, the flying vehicle waits.
//!
//! A remote flight controller cannot be cloned. Of its flight only the frozen vehicles are kept, ten a second, and an instant is
//! shown as the next of them shows it.
//!
//! Nothing here reads a clock. The owner of the vehicle decides when to record and which instant to show.

mod idle;
mod marks;
mod recorded_flight;
mod recording;
mod replay;
#[cfg(test)]
mod tests;
mod view;

use crate::signals::SimTime;
use crate::vehicle::{Vehicle, VehicleCommand};
use recording::{Bounds, Recording};
use replay::Replay;

pub use idle::IdleSpan;
pub use marks::{Mark, MarkKind, Marks};
pub use recorded_flight::{RecordedFlight, begins_flight};
pub use view::TimelineView;

/// The recording of a flight, and the earlier instant that is shown.
#[derive(Debug)]
pub struct Timeline {
    recording: Recording,
    replay: Option<Replay>,
    branch: u32,
    branched_at: SimTime,
    /// `true` if the vehicle cannot be flown again.
    is_pictures: bool,
}

/// The result of a replay.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// An earlier instant is shown.
    Earlier,
    /// The replay has reached the flying vehicle.
    Newest,
}

impl Timeline {
    /// Records `vehicle` from now on: for replays, or as pictures if its flight controller is remote. Returns `None` if
    /// its world is not simulated by this program.
    pub fn new(vehicle: &mut Vehicle) -> Option<Self> {
        let is_remote = vehicle.embedded().is_none();
        Self::within(if is_remote { Bounds::from_pictures() } else { Bounds::default() }, vehicle)
    }

    fn within(bounds: Bounds, vehicle: &mut Vehicle) -> Option<Self> {
        let flies_again = vehicle.keep_inputs(true);
        (flies_again || vehicle.truth().is_some()).then(|| Self {
            recording: Recording::new(bounds),
            replay: None,
            branch: 0,
            branched_at: SimTime::ZERO,
            is_pictures: !flies_again,
        })
    }

    /// Returns `true` if only pictures are kept. To continue from one, a remote flight controller must compute so far again.
    pub fn is_pictures(&self) -> bool {
        self.is_pictures
    }

    /// Records the inputs since the previous tick. Call it right before each tick, and when there were many inputs
    /// while time is stopped.
    pub fn record(&mut self, vehicle: &mut Vehicle) {
        self.recording.record(vehicle);
    }

    /// Returns the number of the first input that is kept, counted from the beginning of the recording.
    pub fn first_input(&self) -> u64 {
        self.recording.first_input()
    }

    /// Returns the number of the next input.
    pub fn next_input(&self) -> u64 {
        self.recording.next_input()
    }

    /// Returns the kept inputs from this number on, oldest first, with their times.
    pub fn inputs_from(&self, number: u64) -> impl Iterator<Item = (SimTime, &VehicleCommand)> {
        self.recording.inputs_from(number)
    }

    /// Returns the vehicle at the earlier instant that is shown, if there is one.
    pub fn shown(&self) -> Option<&Vehicle> {
        self.replay.as_ref().map(Replay::vehicle)
    }

    /// Returns the earlier instant that is shown. Of a picture it may be a little before the vehicle's time.
    pub fn shown_at(&self) -> Option<SimTime> {
        self.replay.as_ref().map(Replay::at)
    }

    /// Returns the earliest instant that can be shown.
    pub fn first(&self) -> Option<SimTime> {
        self.recording.first()
    }

    /// Returns the parts without events that a display folds for a flight with these marks, oldest first.
    pub fn folds(&self, marks: &[Mark]) -> Vec<IdleSpan> {
        self.first().map_or_else(Vec::new, |first| self.recording.idle().folds(marks, first))
    }

    /// Returns the number of times that the flight was continued from an earlier instant.
    pub fn branch(&self) -> u32 {
        self.branch
    }

    /// Returns the instant from which it was last continued.
    pub fn branched_at(&self) -> SimTime {
        self.branched_at
    }

    /// Shows the vehicle at `time`, or at the earliest instant. `head` is the instant at which the flying vehicle
    /// waits.
    pub fn show(&mut self, time: SimTime, head: SimTime) -> Shown {
        if time >= head {
            self.replay = None;
            return Shown::Newest;
        }
        if self.is_pictures {
            let picture = self.recording.first_from(time).or_else(|| self.recording.latest_before(time));
            self.replay = picture.map(|picture| Replay::still(picture, time));
            return if self.replay.is_some() { Shown::Earlier } else { Shown::Newest };
        }
        // A short step forwards continues from the shown instant. Anything else starts from a frozen vehicle.
        let oldest = self.recording.first_input();
        let shown =
            self.replay.take().filter(|replay| replay.time() <= time && replay.next_input() >= oldest);
        let frozen = self.recording.latest_before(time);
        let newer = |replay: &Replay| frozen.as_ref().is_none_or(|frozen| frozen.time() <= replay.time());
        let start = if shown.as_ref().is_some_and(newer) { shown } else { frozen.map(Replay::new) };
        self.replay = start.map(|mut replay| {
            replay.fly_to(time, &self.recording);
            replay
        });
        if self.replay.is_some() { Shown::Earlier } else { Shown::Newest }
    }

    /// Advances the replay by some ticks, at most to `head`.
    pub fn play(&mut self, ticks: u64, head: SimTime) -> Shown {
        let Some(replay) = &self.replay else { return Shown::Newest };
        let to = SimTime(replay.at().0 + ticks * replay.vehicle().step_us());
        self.show(to, head)
    }

    /// Returns to the flying vehicle.
    pub fn leave(&mut self) {
        self.replay = None;
    }

    /// Returns a copy of the vehicle of the picture that is shown, or else of the newest one; `None` if the recording has no
    /// pictures.
    pub fn picture(&self, head: SimTime) -> Option<Vehicle> {
        let newest = || Some(self.recording.latest_before(head)?.vehicle());
        self.is_pictures.then(|| self.shown().or_else(newest)).flatten().cloned()
    }

    /// Continues from the picture that is shown, on a new branch. Forgets the recording after it. Returns the vehicle of the
    /// picture; `None` if no earlier instant is shown.
    pub fn continue_pictures(&mut self) -> Option<Vehicle> {
        let replay = self.replay.take_if(|_| self.is_pictures)?;
        self.branch_from(&replay);
        Some(replay.into_vehicle())
    }

    fn branch_from(&mut self, replay: &Replay) {
        self.recording.forget_after(replay);
        self.branch += 1;
        self.branched_at = replay.time();
    }

    /// Makes the shown vehicle the flying one, on a new branch. Forgets the recording after it. Returns `None` if no
    /// earlier instant is shown, or if the vehicle cannot be flown again.
    pub fn fly_on(&mut self) -> Option<Vehicle> {
        let replay = self.replay.take_if(|_| !self.is_pictures)?;
        self.branch_from(&replay);
        let mut vehicle = replay.into_vehicle();
        vehicle.keep_inputs(true);
        // The events were reported when they happened.
        vehicle.drain_events(drop);
        Some(vehicle)
    }
}
