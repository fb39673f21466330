//! The flight as it was: recording, rewind and branches.
//!
//! `recording` keeps frozen vehicles and the inputs between them, `replay` flies from one of them to an earlier instant,
//! `marks` knows when something happened. While an earlier instant is shown, the vehicle that flies waits where it is.
//!
//! Nothing here reads a clock: whoever owns the vehicle says when to record and what to show.

mod idle;
mod marks;
mod recorded_flight;
mod recording;
mod replay;
#[cfg(test)]
mod tests;
mod view;

use crate::signals::SimTime;
use crate::vehicle::Vehicle;
use recording::{Bounds, Recording};
use replay::Replay;

pub use idle::IdleSpan;
pub use marks::{Mark, MarkKind, Marks};
pub use recorded_flight::RecordedFlight;
pub use view::TimelineView;

/// The recording of a flight, and the earlier instant of it that is shown.
#[derive(Debug)]
pub struct Timeline {
    recording: Recording,
    replay: Option<Replay>,
    branch: u32,
    branched_at: SimTime,
}

/// What replaying led to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// An earlier instant is shown.
    Earlier,
    /// It has come to where the vehicle that flies waits.
    Newest,
}

impl Timeline {
    /// Records `vehicle` from now on; `None` when it cannot be flown again, because its time or its flight controller
    /// is not ours.
    pub fn new(vehicle: &mut Vehicle) -> Option<Self> {
        Self::within(Bounds::default(), vehicle)
    }

    fn within(bounds: Bounds, vehicle: &mut Vehicle) -> Option<Self> {
        if !vehicle.keep_inputs(true) {
            return None;
        }
        Some(Self { recording: Recording::new(bounds), replay: None, branch: 0, branched_at: SimTime::ZERO })
    }

    /// Records what came from outside since the tick before; to be called right before each tick, and when much has
    /// come while time stands still.
    pub fn record(&mut self, vehicle: &mut Vehicle) {
        self.recording.record(vehicle);
    }

    /// The vehicle at the earlier instant that is shown, if one is.
    pub fn shown(&self) -> Option<&Vehicle> {
        self.replay.as_ref().map(Replay::vehicle)
    }

    /// The earliest instant that can be shown.
    pub fn first(&self) -> Option<SimTime> {
        self.recording.first()
    }

    /// The parts in which nothing happens that a display folds beside a flight with these marks, the oldest first.
    pub fn folds(&self, marks: &[Mark]) -> Vec<IdleSpan> {
        self.first().map_or_else(Vec::new, |first| self.recording.idle().folds(marks, first))
    }

    /// How often the flight was flown on from an earlier instant.
    pub fn branch(&self) -> u32 {
        self.branch
    }

    /// The instant from which it was last flown on.
    pub fn branched_at(&self) -> SimTime {
        self.branched_at
    }

    /// Shows the vehicle as it was at `time`, or at the earliest instant; `head` is where the vehicle that flies waits.
    pub fn show(&mut self, time: SimTime, head: SimTime) -> Shown {
        if time >= head {
            self.replay = None;
            return Shown::Newest;
        }
        // Forwards by a little from where it is, else from a frozen vehicle.
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

    /// Flies the replay on by some ticks, at most to `head`.
    pub fn play(&mut self, ticks: u64, head: SimTime) -> Shown {
        let Some(replay) = &self.replay else { return Shown::Newest };
        let to = SimTime(replay.time().0 + ticks * replay.vehicle().step_us());
        self.show(to, head)
    }

    /// Back to the vehicle that flies.
    pub fn leave(&mut self) {
        self.replay = None;
    }

    /// Makes the shown vehicle the one that flies, on a new branch: what was recorded after it is forgotten. `None` when
    /// no earlier instant is shown.
    pub fn fly_on(&mut self) -> Option<Vehicle> {
        let replay = self.replay.take()?;
        self.recording.forget_after(&replay);
        self.branch += 1;
        self.branched_at = replay.time();
        let mut vehicle = replay.into_vehicle();
        vehicle.keep_inputs(true);
        // They were told when they happened.
        vehicle.drain_events(drop);
        Some(vehicle)
    }
}
