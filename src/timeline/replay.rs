//! A frozen vehicle that flies again through the recorded inputs.

use super::recording::{KeyFrame, Recording};
use crate::signals::SimTime;
use crate::vehicle::Vehicle;

/// A vehicle that replays the recording.
#[derive(Debug)]
pub(super) struct Replay {
    vehicle: Vehicle,
    /// The instant of a still picture, which the vehicle shows at or after it.
    still_at: Option<SimTime>,
    /// Number of the first input that it has not taken.
    next_input: u64,
}

impl Replay {
    /// Returns a replay from a frozen vehicle.
    pub(super) fn new(start: &KeyFrame) -> Self {
        Self { vehicle: start.vehicle().clone(), still_at: None, next_input: start.next_input() }
    }

    /// Returns a still picture for an instant.
    pub(super) fn still(picture: &KeyFrame, at: SimTime) -> Self {
        Self { still_at: Some(at), ..Self::new(picture) }
    }

    /// Returns the instant that is shown.
    pub(super) fn at(&self) -> SimTime {
        self.still_at.unwrap_or(self.time())
    }

    pub(super) fn time(&self) -> SimTime {
        self.vehicle.time()
    }

    pub(super) fn vehicle(&self) -> &Vehicle {
        &self.vehicle
    }

    pub(super) fn into_vehicle(self) -> Vehicle {
        self.vehicle
    }

    /// Returns the number of the first input that it has not taken.
    pub(super) fn next_input(&self) -> u64 {
        self.next_input
    }

    /// Flies to `time` as recorded. The inputs of that instant are not applied yet.
    pub(super) fn fly_to(&mut self, time: SimTime, recording: &Recording) {
        while self.vehicle.time() < time {
            while let Some(input) = recording.input(self.next_input, self.vehicle.time()) {
                // The answer was reported when the command came.
                let _reported = self.vehicle.apply(input);
                self.next_input += 1;
            }
            self.vehicle.tick();
            self.vehicle.drain_events(drop);
        }
    }
}
