//! Removal of the constant errors of the inertial sensors and the magnetometer.

use nalgebra::{Matrix4, Vector3, Vector4};

use crate::geo::GRAVITY;

/// Gyro units per rad/s: 16.4 per degree a second.
const GYRO_UNITS: f64 = 16.4 * 180.0 / std::f64::consts::PI;
/// The number of samples of an accelerometer calibration, one every 10 ms.
const ACC_SAMPLES: u32 = 400;
/// The duration of a magnetometer calibration, s.
const MAG_CALIBRATION_S: f64 = 30.0;
/// Signs that the craft was turned: the least ratio of the smallest span of an axis to the largest, and of the largest
/// span to the farthest sample.
const MIN_ROUNDNESS: f64 = 0.5;
const MIN_SPAN: f64 = 0.5;
/// A field in sensor units that keeps the numbers of the fit near one.
const MAG_UNIT: f64 = 1000.0;
/// Accelerometer units of the stored calibration per g.
const ACC_UNITS_PER_G: f64 = 2048.0;

/// Averages the gyro until it has been quiet for long enough.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct GyroCalibration {
    first: Vector3<f64>,
    sum: Vector3<f64>,
    squares: Vector3<f64>,
    samples: u32,
    elapsed_s: f64,
    /// The zero-rate offset, rad/s.
    pub bias: Vector3<f64>,
    /// `true` once the offset is known.
    pub done: bool,
}

impl GyroCalibration {
    pub(super) fn new() -> Self {
        Self::after(Vector3::zeros())
    }

    /// Begins again. The known offset (rad/s) remains in use until there is a new one.
    pub(super) fn after(bias: Vector3<f64>) -> Self {
        let zero = Vector3::zeros();
        Self { first: zero, sum: zero, squares: zero, samples: 0, elapsed_s: 0.0, bias, done: false }
    }

    /// Takes one sample (rad/s). After `duration_s` the samples give the offset if their standard deviation is at most
    /// `noise_limit` (gyro units; 0 = any); otherwise the calibration starts again.
    pub(super) fn feed(&mut self, rate: &Vector3<f64>, dt: f64, duration_s: f64, noise_limit: f64) {
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
            *self = Self::after(self.bias);
        }
    }
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct AccCalibration {
    sum: Vector3<f64>,
    left: u32,
}

impl AccCalibration {
    pub(super) fn new() -> Self {
        Self { sum: Vector3::zeros(), left: ACC_SAMPLES }
    }

    /// Takes one sample (m/s², uncorrected). At the end returns the offset in units of the setting.
    pub(super) fn feed(&mut self, force: &Vector3<f64>) -> Option<[i64; 3]> {
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

/// The result of a magnetometer calibration in which the craft was not turned about all its axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[doc(hidden)]
pub struct NotTurned;

/// A running magnetometer calibration. While the craft is turned about all axes, the field draws a part of a sphere
/// about the offset of the sensor: |m − c|² = r², which is linear in c and r² − |c|². It is solved by least squares.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MagCalibration {
    normal: Matrix4<f64>,
    right: Vector4<f64>,
    low: Vector3<f64>,
    high: Vector3<f64>,
    left_s: f64,
}

impl MagCalibration {
    pub(super) fn new() -> Self {
        let limit = Vector3::repeat(f64::INFINITY);
        Self {
            normal: Matrix4::zeros(),
            right: Vector4::zeros(),
            low: limit,
            high: -limit,
            left_s: MAG_CALIBRATION_S,
        }
    }

    /// Takes a sample (sensor units, uncorrected).
    pub(super) fn feed(&mut self, field: &Vector3<f64>) {
        self.low = self.low.inf(field);
        self.high = self.high.sup(field);
        let scaled = field / MAG_UNIT;
        let row = (2.0 * scaled).push(1.0);
        self.normal += row * row.transpose();
        self.right += row * scaled.norm_squared();
    }

    /// Counts down by `dt` seconds. At the end returns the offset in units of the setting.
    pub(super) fn wait(&mut self, dt: f64) -> Option<Result<[i64; 3], NotTurned>> {
        self.left_s -= dt;
        if self.left_s > 0.0 {
            return None;
        }
        let span = self.high - self.low;
        let farthest = self.high.abs().sup(&self.low.abs()).norm();
        let turned = span.min() >= MIN_ROUNDNESS * span.max() && span.max() >= MIN_SPAN * farthest;
        let centre = self.normal.lu().solve(&self.right).map(|fit| fit.xyz() * MAG_UNIT);
        let found = centre.filter(|centre| turned && centre.iter().all(|axis| axis.is_finite()));
        Some(
            found
                .map(|centre| [centre.x, centre.y, centre.z].map(|axis| axis.round() as i64))
                .ok_or(NotTurned),
        )
    }
}

/// Converts a stored calibration to the magnetometer offset (sensor units).
pub(super) fn mag_offset(units: &[i64]) -> Vector3<f64> {
    let axis = |at: usize| units.get(at).map_or(0.0, |&value| value as f64);
    Vector3::new(axis(0), axis(1), axis(2))
}

/// Converts a stored calibration to the accelerometer offset (m/s²).
pub(super) fn acc_offset(units: &[i64]) -> Vector3<f64> {
    let axis = |at: usize| units.get(at).map_or(0.0, |&value| value as f64 * GRAVITY / ACC_UNITS_PER_G);
    Vector3::new(axis(0), axis(1), axis(2))
}

#[cfg(test)]
mod tests {
    use nalgebra::UnitQuaternion;

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
    fn a_gyro_that_is_calibrated_again_keeps_its_offset_meanwhile() {
        let mut gyro = GyroCalibration::after(Vector3::new(0.1, 0.0, 0.0));
        for step in 0..2000 {
            gyro.feed(&Vector3::new(f64::from(step) * 0.001, 0.0, 0.0), 0.001, 1.25, 48.0);
        }
        assert_eq!((gyro.done, gyro.bias.x), (false, 0.1));
    }

    #[test]
    fn turning_the_craft_finds_the_magnetometer_offset() {
        let offset = Vector3::new(300.0, -120.0, 45.0);
        let field = Vector3::new(2046.8, -71.5, -3547.2);
        let mut mag = MagCalibration::new();
        let mut result = None;
        for step in 0..3000 {
            let t = f64::from(step) * 0.01;
            let turn = UnitQuaternion::from_euler_angles(1.3 * t, 0.9 * t, 0.4 * t);
            mag.feed(&(turn * field + offset));
            result = mag.wait(0.01).or(result);
        }
        let found = mag_offset(&result.unwrap().unwrap());
        assert!((found - offset).norm() < 2.0, "{found}");
    }

    #[test]
    fn a_craft_at_rest_or_that_only_spins_keeps_its_magnetometer_offset() {
        for spin in [0.0, 1.0] {
            let mut mag = MagCalibration::new();
            let mut result = None;
            for step in 0..3000 {
                let turn = UnitQuaternion::from_euler_angles(0.0, 0.0, spin * f64::from(step) * 0.01);
                mag.feed(&(turn * Vector3::new(2046.8, -71.5, -3547.2)));
                result = mag.wait(0.01).or(result);
            }
            assert_eq!(result, Some(Err(NotTurned)), "{spin}");
        }
        let mut silent = MagCalibration::new();
        assert_eq!(silent.wait(31.0), Some(Err(NotTurned)));
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
