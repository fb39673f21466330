//! The craft at one instant of a log.

use arrayvec::ArrayVec;
use nalgebra::Vector3;

use super::boxes::BoxFlags;
use super::failsafe_phase::FailsafePhase;
use crate::geo::LatLon;
use crate::signals::SimTime;

/// The most motors of a craft.
pub const MAX_MOTORS: usize = 8;

/// The values of the newest frames at an instant. A value that the log does not have, or not yet, is `None`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LogSample {
    /// The time of the main frame.
    pub time: SimTime,
    /// The loop iteration of the main frame.
    pub iteration: u32,
    /// From the logged quaternion; else from gyro and accelerometer, with a heading that starts at the first GPS course.
    pub attitude: Option<LogAttitude>,
    /// Body rates, forward, left, up, °/s.
    pub gyro_dps: Option<Vector3<f64>>,
    /// Specific force, forward, left, up, m/s²: +9.8 up at rest.
    pub accel_mps2: Option<Vector3<f64>>,
    /// The place that the GPS reported last.
    pub position: Option<LatLon>,
    /// North of home, m.
    pub n: Option<f64>,
    /// East of home, m.
    pub e: Option<f64>,
    /// Above home, m: by the barometer, else by the GPS.
    pub alt: Option<f64>,
    /// Above mean sea level by the GPS, m.
    pub alt_amsl_m: Option<f64>,
    /// Speed over ground, m/s.
    pub ground_speed_mps: Option<f64>,
    /// Climb rate by the GPS, m/s.
    pub climb_mps: Option<f64>,
    /// Course over ground, degrees clockwise from north.
    pub course_deg: Option<f64>,
    pub sats: Option<u8>,
    pub gps_fix: Option<bool>,
    pub battery_v: Option<f64>,
    pub battery_a: Option<f64>,
    /// RC command: roll, pitch, yaw, ±500; right, forward and left positive, as the firmware counts.
    pub rc_command: Option<[f64; 3]>,
    /// RC command of the throttle, 1000…2000 µs.
    pub rc_throttle_us: Option<f64>,
    /// Setpoints of the rate loop: roll, pitch, yaw, °/s, signs as in [`Self::gyro_dps`].
    pub setpoint_dps: Option<[f64; 3]>,
    /// Throttle setpoint, 0…1.
    pub setpoint_throttle: Option<f64>,
    /// Motor outputs M1…, 0…1; empty without motors in the log.
    pub motors: ArrayVec<f64, MAX_MOTORS>,
    /// The boxes that are on.
    pub boxes: Option<BoxFlags>,
    /// The phase of the failsafe; `None` also for numbers that Betaflight does not have.
    pub failsafe_phase: Option<FailsafePhase>,
    /// `true` while the receiver gets a signal.
    pub rx_signal: Option<bool>,
    /// `true` while the pulses of the flight channels are valid.
    pub rx_channels_valid: Option<bool>,
    /// The values of all signals of the log, in the order of its list; NaN for an unknown one.
    pub values: Vec<f64>,
}

/// The attitude, degrees.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LogAttitude {
    /// Right positive.
    pub roll_deg: f64,
    /// Nose **up** positive.
    pub pitch_deg: f64,
    /// Clockwise from north, 0…360.
    pub heading_deg: f64,
}
