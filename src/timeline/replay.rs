//! A frozen vehicle that flies again through the recorded inputs.

use super::recording::{KeyFrame, Recording};
use crate::signals::SimTime;
use crate::vehicle::Vehicle;

/// A vehicle on its way through the recording.
#[derive(Debug)]
pub(super) struct Replay {
    vehicle: Vehicle,
    /// The number of the first input that it has not taken.
    next_input: u64,
}

impl Replay {
    /// A replay from a frozen vehicle.
    pub(super) fn new(start: &KeyFrame) -> Self {
        Self { vehicle: start.vehicle().clone(), next_input: start.next_input() }
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

    /// The number of the first input that it has not taken.
    pub(super) fn next_input(&self) -> u64 {
        self.next_input
    }

    /// Flies to `time` as it was flown; the inputs that came at that instant are still to come.
    pub(super) fn fly_to(&mut self, time: SimTime, recording: &Recording) {
        while self.vehicle.time() < time {
            while let Some(input) = recording.input(self.next_input, self.vehicle.time()) {
                self.vehicle.apply(input);
                self.next_input += 1;
            }
            self.vehicle.tick();
            self.vehicle.drain_events(drop);
        }
    }
}
