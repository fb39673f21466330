//! The gyro path: two low-passes per axis.

use super::derived::Derived;
use crate::firmware::estimate::Rates;
use crate::firmware::filter::LowPassState;

/// The two filters.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct GyroFilter {
    first: LowPassState,
    second: LowPassState,
}

impl GyroFilter {
    /// Filters one sample. Returns the rates in °/s: roll, pitch, yaw.
    pub(super) fn apply(&mut self, rates: &Rates, derived: &Derived) -> [f64; 3] {
        let rates_dps = [rates.roll, rates.pitch_down, rates.yaw].map(f64::to_degrees);
        self.second.apply(&self.first.apply(&rates_dps, &derived.gyro_lpf1), &derived.gyro_lpf2)
    }
}
