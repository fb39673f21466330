//! Instants at equal intervals of simulated time.

use crate::vehicle::Vehicle;

/// The interval between two samples.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pace {
    every_us: u64,
}

impl Pace {
    /// Returns the pace of so many samples a second.
    pub(super) fn from_hz(hz: f64) -> Self {
        Self::from_us((1e6 / hz).round() as u64)
    }

    /// Returns the pace of one sample in so many microseconds.
    pub(super) fn from_us(every_us: u64) -> Self {
        Self { every_us: every_us.max(1) }
    }

    /// Returns `true` if a sample is due after the last tick of the vehicle.
    pub(super) fn is_due(self, vehicle: &Vehicle) -> bool {
        let now = vehicle.time().0;
        now / self.every_us != now.saturating_sub(vehicle.step_us()) / self.every_us
    }
}
