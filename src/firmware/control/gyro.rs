//! The gyro path: two low-passes per axis.

use super::derived::Derived;
use crate::firmware::estimate::Rates;
use crate::firmware::filter::LowPassState;

/// The filters of the three axes.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct GyroFilter {
    axes: [[LowPassState; 2]; 3],
}

impl GyroFilter {
    /// Filters one sample. Returns the rates in °/s: roll, pitch, yaw.
    pub(super) fn apply(&mut self, rates: &Rates, derived: &Derived) -> [f64; 3] {
        let mut filtered = [rates.roll, rates.pitch_down, rates.yaw];
        for (value, [first, second]) in filtered.iter_mut().zip(&mut self.axes) {
            *value = second.apply(first.apply(value.to_degrees(), &derived.gyro_lpf1), &derived.gyro_lpf2);
        }
        filtered
    }
}
