//! The flight since the craft was last at home, as data.

use super::Timeline;
use super::replay::Replay;
use crate::signals::SimTime;
use crate::vehicle::{Vehicle, VehicleCommand};

/// A flight from its start to now.
#[derive(Debug)]
pub struct RecordedFlight {
    /// The vehicle at the start: at boot, or after the craft was put back home or restarted.
    pub start: Vehicle,
    /// Inputs since then, with their times since boot.
    pub inputs: Vec<(SimTime, VehicleCommand)>,
    /// Instant at which the flight ends.
    pub until: SimTime,
}

/// Returns `true` if the input puts the craft back home or restarts it, so that a flight ends and another begins.
pub fn begins_flight(input: &VehicleCommand) -> bool {
    matches!(input, VehicleCommand::ResetCraft | VehicleCommand::Restart(_))
}

impl Timeline {
    /// Returns the end of the flight that an instant belongs to, or `None` for the last flight.
    pub fn flight_ends(&self, instant: SimTime) -> Option<SimTime> {
        self.recording.inputs().find(|(at, input)| *at >= instant && begins_flight(input)).map(|(at, _)| at)
    }

    /// Returns the flight from its start to `until`, or `None` if the recording does not reach back so far.
    pub fn recorded_flight(&self, until: SimTime) -> Option<RecordedFlight> {
        let recorded = || self.recording.inputs().filter(|(at, _)| *at < until);
        let last = recorded().enumerate().filter(|(_, (_, input))| begins_flight(input)).last();
        let (skipped, start_at) = match last {
            // Earlier inputs at the same instant belong to the previous flight.
            Some((index, (at, _))) => (index + 1, SimTime(at.0 + 1)),
            None => (0, SimTime::ZERO),
        };
        let first = self.recording.first()?;
        if start_at == SimTime::ZERO && first > SimTime::ZERO || first > start_at {
            return None;
        }
        let frozen = self.recording.latest_before(start_at)?;
        let mut replay = Replay::new(frozen);
        replay.fly_to(start_at, &self.recording);
        let inputs = recorded().skip(skipped).map(|(at, input)| (at, input.clone())).collect();
        Some(RecordedFlight { start: replay.into_vehicle(), inputs, until })
    }
}
