//! What the flight controller believes about its own motion.
//!
//! ```text
//! gyro ──► calibration ──► quaternion ──► matrix, roll, pitch ──────────────► rate and angle loops
//!   every step              every step     500 Hz      ▲
//! accelerometer ──────────────────────► world axes ────┤ tilt corrections, 100 Hz
//!                                          │           │
//! GPS (delayed, 10 Hz) ──► horizontal filter: position, velocity, acceleration error ─► navigator
//! barometer, GPS ────────► vertical filter:   altitude, climb rate, acceleration error
//! magnetometer, GPS ─────► heading: by the magnetometer while it agrees with the course over ground, else by the course
//! ```
//!
//! **Axes and signs of the whole firmware.** Roll is positive to the right, pitch is positive nose *down*, yaw is
//! positive clockwise seen from above; headings count clockwise from north. For roll and pitch these are the
//! directions of the body axes forward-left-up; yaw is opposed. The mixer table uses the same signs, so the yaw sum
//! enters it as it is. What leaves the firmware in Betaflight's own convention (yaw rate anticlockwise) is negated at
//! the border.
//!
//! Inside the estimator vectors are body forward-left-up (`_flu`) or world east-north-up; the horizontal filter and
//! all outputs use (north, east).
//!
//! The tilt correction follows Mahony (complementary filter on the rotation group): the accelerometer shows the
//! vertical. A multirotor that leans to accelerate feels its thrust only, along its own vertical axis, so this would
//! slowly unlearn every lean. While the horizontal filter is fed it tells how the craft really accelerates, and the
//! correction uses that.

use nalgebra::{UnitQuaternion, Vector2, Vector3};

use crate::geo::{LatLon, offset_to_latlon};

mod attitude;
mod calibration;
mod compass;
mod estimator;
mod gps;
mod heading;
mod history;
mod horizontal;
mod kalman;
mod schedule;
mod straight;
mod tuning;
mod vertical;

pub use calibration::NotTurned;
pub use estimator::Estimator;
pub use gps::GpsStatus;
pub use schedule::DueTasks;
pub use tuning::{AttitudeSource, EstimatorOptions, EstimatorTuning};
pub use vertical::AltitudeSource;

/// Turn rates, rad/s.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rates {
    pub roll: f64,
    pub pitch: f64,
    pub yaw: f64,
}

impl Rates {
    /// From rates about the body axes forward, left, up.
    pub fn from_flu(rate: &Vector3<f64>) -> Self {
        Self { roll: rate.x, pitch: rate.y, yaw: -rate.z }
    }
}

/// The estimate of one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Attitude, body forward-left-up → world east-north-up.
    pub attitude: UnitQuaternion<f64>,
    /// Whether the attitude is known.
    pub attitude_valid: bool,
    /// Whether the heading is known.
    pub heading_valid: bool,
    /// By how much the magnetometer is off the course over ground, rad, while it is doubted for that.
    pub heading_doubt_rad: Option<f64>,
    /// Roll, rad, right positive.
    pub roll_rad: f64,
    /// Pitch, rad, nose **down** positive.
    pub pitch_rad: f64,
    /// Heading, rad clockwise from true north, 0…2π.
    pub heading_rad: f64,
    /// Cosine of the tilt from level.
    pub cos_tilt: f64,
    /// Turn rates, calibrated, unfiltered, rad/s.
    pub rates: Rates,
    /// Specific force, calibrated, body forward-left-up, m/s².
    pub force_flu: Vector3<f64>,
    /// Where `pos_ne` is zero; home while armed. `None` before the first fix.
    pub origin: Option<LatLon>,
    /// Whether position and velocity were held by a solution within the last 2 s.
    pub position_valid: bool,
    /// Position north and east of the origin, m.
    pub pos_ne: Vector2<f64>,
    /// Velocity north and east, m/s.
    pub vel_ne: Vector2<f64>,
    /// Acceleration north and east, without gravity, m/s².
    pub accel_ne: Vector2<f64>,
    /// Whether the altitude was held by a measurement within the last 2 s.
    pub altitude_valid: bool,
    /// Altitude above the place of the last arming (before the first: of boot), m.
    pub alt_m: f64,
    /// Climb rate, m/s.
    pub climb_mps: f64,
    /// Altitude for displays: low-passed by `altitude_lpf`, m.
    pub shown_alt_m: f64,
    /// Climb rate for displays: low-passed by `altitude_d_lpf`, m/s.
    pub shown_climb_mps: f64,
    pub gps: GpsStatus,
    /// A sensor calibration is running.
    pub calibrating: bool,
    /// The inertial sensors have repeated the same sample for a second while turning.
    pub imu_frozen: bool,
}

impl Default for Estimate {
    /// Nothing known: level, facing north, at the origin.
    fn default() -> Self {
        Self {
            attitude: UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::FRAC_PI_2),
            attitude_valid: false,
            heading_valid: false,
            heading_doubt_rad: None,
            roll_rad: 0.0,
            pitch_rad: 0.0,
            heading_rad: 0.0,
            cos_tilt: 1.0,
            rates: Rates::default(),
            force_flu: Vector3::new(0.0, 0.0, crate::geo::GRAVITY),
            origin: None,
            position_valid: false,
            pos_ne: Vector2::zeros(),
            vel_ne: Vector2::zeros(),
            accel_ne: Vector2::zeros(),
            altitude_valid: false,
            alt_m: 0.0,
            climb_mps: 0.0,
            shown_alt_m: 0.0,
            shown_climb_mps: 0.0,
            gps: GpsStatus::default(),
            calibrating: true,
            imu_frozen: false,
        }
    }
}

impl Estimate {
    /// The estimated place on earth; `None` before the first fix.
    pub fn place(&self) -> Option<LatLon> {
        self.origin.map(|origin| offset_to_latlon(origin, self.pos_ne))
    }
}
