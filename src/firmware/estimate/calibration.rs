//! Removing the constant errors of the inertial sensors while the craft stands still.

use nalgebra::Vector3;

use crate::geo::GRAVITY;

/// Gyro units per rad/s: 16.4 per degree a second.
const GYRO_UNITS: f64 = 16.4 * 180.0 / std::f64::consts::PI;
/// Samples of an accelerometer calibration, one every 10 ms.
const ACC_SAMPLES: u32 = 400;
/// Accelerometer units of the stored calibration per g.
const ACC_UNITS_PER_G: f64 = 2048.0;

/// Averages the gyro until it was quiet for long enough.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct GyroCalibration {
    first: Vector3<f64>,
    sum: Vector3<f64>,
    squares: Vector3<f64>,
    samples: u32,
    elapsed_s: f64,
    /// Zero rate offset, rad/s.
    pub bias: Vector3<f64>,
    /// Whether the offset is known.
    pub done: bool,
}

impl GyroCalibration {
    pub fn new() -> Self {
        let zero = Vector3::zeros();
        Self { first: zero, sum: zero, squares: zero, samples: 0, elapsed_s: 0.0, bias: zero, done: false }
    }

    /// One sample (rad/s). `duration_s` of samples whose standard deviation stays below `noise_limit` (gyro units; 0:
    /// any) give the offset; otherwise it starts anew.
    pub fn feed(&mut self, rate: &Vector3<f64>, dt: f64, duration_s: f64, noise_limit: f64) {
        if self.samples == 0 {
            self.first = *rate;
        }
        let deviation = rate - self.first;
        self.sum += deviation;
        self.squares += deviation.component_mul(&deviation);
        self.samples += 1;
        self.elapsed_s += dt;
        if self.elapsed_s < duration_s {
            return;
        }
        let n = f64::from(self.samples);
        let mean = self.sum / n;
        let variance = (self.squares / n - mean.component_mul(&mean)).max();
        let is_quiet = noise_limit == 0.0 || variance.max(0.0).sqrt() * GYRO_UNITS <= noise_limit;
        if is_quiet {
            self.bias = self.first + mean;
            self.done = true;
        } else {
            *self = Self::new();
        }
    }
}

/// A running accelerometer calibration.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct AccCalibration {
    sum: Vector3<f64>,
    left: u32,
}

impl AccCalibration {
    pub fn new() -> Self {
        Self { sum: Vector3::zeros(), left: ACC_SAMPLES }
    }

    /// One sample (m/s², uncorrected); at the end the offset in units of the setting.
    pub fn feed(&mut self, force: &Vector3<f64>) -> Option<[i64; 3]> {
        self.sum += force;
        self.left = self.left.saturating_sub(1);
        if self.left > 0 {
            return None;
        }
        let mean = self.sum / f64::from(ACC_SAMPLES) - Vector3::new(0.0, 0.0, GRAVITY);
        let units = mean * (ACC_UNITS_PER_G / GRAVITY);
        Some([units.x.round() as i64, units.y.round() as i64, units.z.round() as i64])
    }
}

/// The accelerometer offset (m/s²) that a stored calibration stands for.
pub(super) fn acc_offset(units: &[i64]) -> Vector3<f64> {
    let axis = |at: usize| units.get(at).map_or(0.0, |&value| value as f64 * GRAVITY / ACC_UNITS_PER_G);
    Vector3::new(axis(0), axis(1), axis(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_moving_craft_is_not_calibrated() {
        let mut gyro = GyroCalibration::new();
        for step in 0..5000 {
            gyro.feed(&Vector3::new(f64::from(step) * 0.001, 0.0, 0.0), 0.001, 1.25, 48.0);
        }
        assert!(!gyro.done);
        for _ in 0..2600 {
            gyro.feed(&Vector3::new(0.0, 0.0, 0.02), 0.001, 1.25, 48.0);
        }
        assert!(gyro.done);
        assert!((gyro.bias.z - 0.02).abs() < 1e-12);
    }

    #[test]
    fn accelerometer_offset_round_trips_through_the_setting() {
        let mut acc = AccCalibration::new();
        let mut result = None;
        for _ in 0..ACC_SAMPLES {
            result = acc.feed(&Vector3::new(0.05, -0.1, GRAVITY + 0.2));
        }
        let offset = acc_offset(&result.unwrap());
        assert!((offset - Vector3::new(0.05, -0.1, 0.2)).norm() < 0.006);
    }
}
