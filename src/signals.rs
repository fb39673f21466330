//! The signals between the airframe, its sensors and the flight controller: plain data that belongs to
//! neither side.
//!
//! Frames: world ENU (x east, y north, z up); body FLU (x forward, y left, z up). Quaternions are body →
//! world, Hamilton. All units are SI. A measurement that did not arrive with this frame is `None`.

use nalgebra::{UnitQuaternion, Vector3};

/// The simulated time since boot in whole microseconds, the only time that the core uses.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, Hash, serde::Serialize, serde::Deserialize,
)]
pub struct SimTime(pub u64);

/// The date of boot, 2026-01-01 UTC, in seconds since 1970. A simulated clock has no date, so all flights have this one.
pub const SIMULATED_BOOT_UNIX_S: u64 = 1_767_225_600;

impl SimTime {
    /// The time of boot.
    pub const ZERO: Self = Self(0);

    /// Converts seconds to a time, rounded to the microsecond. Negative or non-finite values give zero.
    pub fn from_secs_f64(seconds: f64) -> Self {
        Self((seconds * 1e6).round() as u64)
    }

    /// Returns the seconds since boot, as the nearest number to the exact quotient: 100 000 µs gives the
    /// number `0.1`.
    pub fn as_secs_f64(self) -> f64 {
        self.0 as f64 / 1e6
    }

    /// Returns the seconds from `earlier` to this time; zero if `earlier` is later.
    pub fn seconds_since(self, earlier: Self) -> f64 {
        self.0.saturating_sub(earlier.0) as f64 / 1e6
    }
}

/// The number of motors of the craft.
pub const MOTORS: usize = 4;

/// A value for each motor, M1…M4: rear right, front right, rear left, front left.
pub type PerMotor<T = f64> = [T; MOTORS];

/// Normalised motor commands, 0…1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MotorCommand(pub PerMotor);

impl MotorCommand {
    /// Returns the mean of the commands.
    pub fn mean(&self) -> f64 {
        self.0.iter().sum::<f64>() / MOTORS as f64
    }

    /// Returns the mean of the squares of the commands, the share of the full thrust.
    pub fn mean_square(&self) -> f64 {
        self.0.iter().map(|motor| motor * motor).sum::<f64>() / MOTORS as f64
    }
}

/// The measurements of the sensors at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorFrame {
    /// The time of the inertial samples.
    pub time: SimTime,
    /// Body rates, FLU, rad/s.
    pub rate_flu: Vector3<f64>,
    /// Specific force, FLU, m/s²: +9.81 on z at rest.
    pub specific_force_flu: Vector3<f64>,
    /// Static pressure, Pa, if a new sample arrived.
    pub pressure_pa: Option<f64>,
    /// Magnetic field, FLU, in the field's own units (only the direction matters), if a new sample arrived.
    pub mag_flu: Option<Vector3<f64>>,
    /// A navigation solution, if a new one arrived. A solution without a fix is also a message.
    pub gps: Option<GpsSample>,
    /// The battery, if a new sample arrived.
    pub battery: Option<BatterySample>,
    /// True attitude, body FLU → ENU, for a firmware that is configured to trust it; `None` if the source has
    /// none.
    pub truth_attitude: Option<UnitQuaternion<f64>>,
}

impl Default for SensorFrame {
    /// Returns a frame at rest, level, facing east, without new samples.
    fn default() -> Self {
        Self {
            time: SimTime::ZERO,
            rate_flu: Vector3::zeros(),
            specific_force_flu: Vector3::new(0.0, 0.0, crate::geo::GRAVITY),
            pressure_pa: None,
            mag_flu: None,
            gps: None,
            battery: None,
            truth_attitude: None,
        }
    }
}

/// The pose of the craft according to an external simulator. No sensor measures it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Latitude and longitude, degrees; `None` if the simulator gives none.
    pub place_deg: Option<(f64, f64)>,
    /// Altitude above the simulator's datum, m.
    pub alt_m: f64,
    /// Velocity, ENU, m/s.
    pub vel_enu: Vector3<f64>,
    /// Attitude, body FLU → ENU.
    pub attitude: UnitQuaternion<f64>,
}

/// One GPS navigation solution.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GpsSample {
    /// `true` for a 3-D fix. Without one the position fields are meaningless.
    pub fix: bool,
    /// The number of satellites in the solution.
    pub sats: u8,
    /// Position, degrees × 10⁷.
    pub position: crate::geo::LatLon,
    /// Altitude above mean sea level, cm.
    pub alt_amsl_cm: i32,
    /// Velocity east, north, up, m/s.
    pub vel_enu: Vector3<f64>,
    /// Horizontal dilution of precision; 0 = not reported.
    pub hdop: f64,
    /// Horizontal accuracy estimate, m; 0 = not reported.
    pub horizontal_accuracy_m: f64,
    /// Vertical accuracy estimate, m; 0 = not reported.
    pub vertical_accuracy_m: f64,
    /// Speed accuracy estimate, m/s; 0 = not reported.
    pub speed_accuracy_mps: f64,
    /// The age of the solution at its delivery, s: receivers stamp the instant that their solution describes.
    pub latency_s: f64,
}

/// One reading of the battery.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BatterySample {
    /// Voltage at the terminals, V.
    pub voltage_v: f64,
    /// Current drawn, A.
    pub current_a: f64,
    /// Charge drawn since the start, mAh.
    pub drawn_mah: f64,
}

/// The number of RC channels on the wire.
pub const RC_CHANNELS: usize = 16;

/// The source of an RC frame.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Hash,
    strum::Display,
    strum::EnumCount,
    strum::EnumIter,
    serde::Serialize,
    serde::Deserialize,
)]
#[strum(serialize_all = "lowercase")]
pub enum RcSource {
    /// UDP 9004 (scripts, joysticks).
    Udp,
    /// `MSP_SET_RAW_RC`.
    Msp,
    /// The virtual sticks of the user interface and of the scripted pilot.
    Sticks,
}

/// One RC frame in wire order (AETR1234 …), µs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct RcFrame {
    /// Pulses, µs: roll, pitch, throttle, yaw, AUX1 … AUX12.
    pub channels: [u16; RC_CHANNELS],
}

impl RcFrame {
    /// Sticks centred, throttle and all switches low.
    pub const SAFE: Self = Self {
        channels: [
            1500, 1500, 1000, 1500, 1000, 1000, 1000, 1000, 1000, 1000, 1000, 1000, 1000, 1000, 1000, 1000,
        ],
    };
}

impl Default for RcFrame {
    fn default() -> Self {
        Self::SAFE
    }
}
