//! The options and settings of the estimator.

use super::alignment::mag_alignment;
use super::calibration::{acc_offset, mag_offset};
use super::vertical::AltitudeSource;
use crate::firmware::settings::Settings;
use crate::telemetry::FirmwareProfile;
use nalgebra::{Rotation3, Vector3};

/// The source of the attitude.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, strum::Display)]
#[strum(serialize_all = "lowercase")]
pub enum AttitudeSource {
    /// Gyro, accelerometer, magnetometer and GPS.
    #[default]
    Estimated,
    /// The simulator, if it reports the attitude.
    Truth,
}

/// The options of the estimator that are not settings of the craft.
#[derive(Debug, Clone, Copy, PartialEq)]
#[doc(hidden)]
pub struct EstimatorOptions {
    /// The source of the attitude.
    pub attitude: AttitudeSource,
    /// The GPS silence that ends the fix, s, at 10 solutions a second or more.
    pub gps_timeout_s: f64,
    /// The declination of the field at the flying site, degrees east, used while `mag_declination` is 0.
    pub declination_deg: f64,
}

/// The declination of the field that SITL simulates, degrees east: (2046.8, −71.5) counts north and west.
const SITL_DECLINATION_DEG: f64 = 2.000_675_735_167_871;

impl Default for EstimatorOptions {
    fn default() -> Self {
        Self {
            attitude: AttitudeSource::Estimated,
            gps_timeout_s: 0.3,
            declination_deg: SITL_DECLINATION_DEG,
        }
    }
}

/// The settings of the estimator in its own units.
#[derive(Debug, Clone, PartialEq)]
#[doc(hidden)]
pub struct EstimatorTuning {
    /// `true` for the estimator of master: Kalman filters without a term for the acceleration error, a tilt that follows
    /// the accelerometer also while the craft speeds up, and, as in its SITL target, no zero of the gyro.
    pub is_plain: bool,
    /// The gain of the correction towards the vertical, rad/s per unit of the sine of the error.
    pub kp: f64,
    /// The integral gain of that correction, rad/s² per unit.
    pub ki: f64,
    /// The cutoff of the accelerometer for the tilt correction, Hz; 0 = no filter.
    pub acc_lpf_hz: f64,
    /// The accelerometer zero, body forward-left-up, m/s².
    pub acc_offset_flu: Vector3<f64>,
    /// The magnetometer zero, body forward-left-up, sensor units.
    pub mag_offset_flu: Vector3<f64>,
    /// The rotation from the axes of the magnetometer to those of the body.
    pub mag_alignment: Option<Rotation3<f64>>,
    /// The quiet time of a gyro calibration, s.
    pub gyro_calibration_s: f64,
    /// The standard deviation above which it restarts, gyro units; 0 = no limit.
    pub gyro_noise_limit: f64,
    /// The period of the attitude loop, µs.
    pub attitude_us: u64,
    /// `true` if there is a magnetometer.
    pub has_mag: bool,
    /// `true` if the magnetometer is trusted in flight.
    pub trust_mag: bool,
    /// The ground speed from which a straight flight shows the heading, m/s.
    pub min_forward_mps: f64,
    /// The declination set by the user, degrees east; 0 = that of the flying site.
    pub declination_deg: f64,
    /// The expected number of solutions a second from the receiver.
    pub gps_rate_hz: f64,
    /// The sources of the altitude.
    pub altitude_source: AltitudeSource,
    /// The weight of the barometer, 0…1.
    pub baro_preference: f64,
    /// The cutoff of the shown altitude, Hz.
    pub shown_alt_hz: f64,
    /// The cutoff of the shown climb rate, Hz.
    pub shown_climb_hz: f64,
    /// `ap_position_a`: the trust in the accelerometer; 30 is neutral.
    pub accel_trust: f64,
}

impl Default for EstimatorTuning {
    fn default() -> Self {
        Self::from_settings(&Settings::default())
    }
}

impl EstimatorTuning {
    /// Reads the tuning of the active profiles.
    pub fn from_settings(settings: &Settings) -> Self {
        let number = |name: &str| settings.number(name) as f64;
        Self {
            is_plain: settings.profile() == FirmwareProfile::Master,
            kp: number("imu_dcm_kp") * 1e-4,
            ki: number("imu_dcm_ki") * 1e-4,
            acc_lpf_hz: number("acc_lpf_hz"),
            acc_offset_flu: acc_offset(settings.array("acc_calibration")),
            mag_offset_flu: mag_offset(settings.array("mag_calibration")),
            mag_alignment: mag_alignment(settings),
            gyro_calibration_s: number("gyro_calib_duration") * 0.01,
            gyro_noise_limit: number("gyro_calib_noise_limit"),
            attitude_us: 1000 * settings.number("imu_process_denom").clamp(1, 4).unsigned_abs(),
            has_mag: settings.text("mag_hardware") != "NONE",
            trust_mag: settings.flag("trust_mag"),
            min_forward_mps: number("ap_min_forward_velocity") * 0.01,
            declination_deg: number("mag_declination") * 0.1,
            gps_rate_hz: number("gps_update_rate_hz").max(1.0),
            altitude_source: match settings.text("altitude_source") {
                "BARO_ONLY" => AltitudeSource::BaroOnly,
                "GPS_ONLY" => AltitudeSource::GpsOnly,
                _ => AltitudeSource::Both,
            },
            baro_preference: number("altitude_prefer_baro") * 0.01,
            shown_alt_hz: number("altitude_lpf") * 0.01,
            shown_climb_hz: number("altitude_d_lpf") * 0.01,
            accel_trust: number("ap_position_a"),
        }
    }

    /// Returns a sample of the magnetometer in the axes of the body, before the calibration.
    pub(super) fn aligned_mag(&self, sample: &Vector3<f64>) -> Vector3<f64> {
        self.mag_alignment.map_or(*sample, |rotation| rotation * sample)
    }

    /// Returns the field from a sample of the magnetometer, body forward-left-up, sensor units.
    pub fn field_flu(&self, sample: &Vector3<f64>) -> Vector3<f64> {
        self.aligned_mag(sample) - self.mag_offset_flu
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_those_of_the_settings() {
        let tuning = EstimatorTuning::default();
        assert!((tuning.kp - 0.25).abs() < 1e-12);
        assert!((tuning.gyro_calibration_s - 1.25).abs() < 1e-12);
        assert_eq!((tuning.shown_alt_hz, tuning.baro_preference, tuning.has_mag), (3.0, 1.0, true));
    }
}
