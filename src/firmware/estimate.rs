//! The flight controller's estimate of its own motion.
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
//! **Axes and signs of the whole firmware.** Roll is positive to the right, pitch is positive nose *down*, as
//! the names of angles and rates say (`pitch_down`), and yaw is positive clockwise seen from above. Headings count clockwise from north. For roll and pitch these are the directions
//! of the body axes forward-left-up; yaw is opposed. The mixer table uses the same signs, so the yaw sum enters it
//! unchanged. Values that leave the firmware in Betaflight's own convention (yaw rate anticlockwise) are negated at the
//! interface.
//!
//! Inside the estimator, vectors are in body forward-left-up (`_flu`) or world east-north-up. The horizontal filter and
//! all outputs use (north, east).
//!
//! The tilt correction follows Mahony (complementary filter on the rotation group): the accelerometer shows the
//! vertical. But a multirotor that tilts to accelerate feels only its thrust, along its own vertical axis, so this
//! correction alone would slowly level out every tilt. While the horizontal filter gets measurements, it knows the real
//! acceleration of the craft, and the correction uses that.

use nalgebra::{UnitQuaternion, Vector2, Vector3};

use crate::autopilot::io::NavInputs;
use crate::geo::{LatLon, offset_to_latlon};
use crate::signals::SimTime;

mod alignment;
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
mod tilt_check;
mod tuning;
mod vertical;

pub use calibration::NotTurned;
pub use estimator::Estimator;
pub use gps::GpsStatus;
pub use schedule::DueTasks;
pub use tuning::{AttitudeSource, EstimatorOptions, EstimatorTuning};
pub use vertical::AltitudeSource;
pub(super) use vertical::pressure_altitude_m;

/// The counts of an accelerometer at 1 g, for protocols and logs.
pub const ACC_COUNTS_PER_G: f64 = 256.0;

/// The turn rates, rad/s.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rates {
    /// About the roll axis, right side down positive.
    pub roll: f64,
    /// About the pitch axis, nose down positive.
    pub pitch_down: f64,
    /// About the vertical axis, clockwise from above positive.
    pub yaw: f64,
}

impl Rates {
    /// Converts rates about the body axes forward, left, up.
    pub fn from_flu(rate: &Vector3<f64>) -> Self {
        Self { roll: rate.x, pitch_down: rate.y, yaw: -rate.z }
    }
}

/// The estimate at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The attitude, body forward-left-up → world east-north-up.
    pub attitude: UnitQuaternion<f64>,
    /// `true` if the attitude is known.
    pub attitude_valid: bool,
    /// `true` if the heading is known.
    pub heading_valid: bool,
    /// The difference of the magnetometer from the course over ground, rad, while it is doubted because of it.
    pub heading_doubt_rad: Option<f64>,
    /// The error of the tilt at which gyro and accelerometer began to disagree, rad, while they do.
    pub tilt_doubt_rad: Option<f64>,
    /// The roll angle, rad, right positive.
    pub roll_rad: f64,
    /// The pitch angle, rad, nose down positive.
    pub pitch_down_rad: f64,
    /// The heading, rad clockwise from true north, 0…2π.
    pub heading_rad: f64,
    /// The cosine of the tilt from level.
    pub cos_tilt: f64,
    /// The turn rates, calibrated, unfiltered, rad/s.
    pub rates: Rates,
    /// The specific force, calibrated, body forward-left-up, m/s².
    pub force_flu: Vector3<f64>,
    /// The point at which `pos_ne` is zero; home while armed. `None` before the first fix.
    pub origin: Option<LatLon>,
    /// `true` if a GPS solution supported position and velocity within the last 2 s.
    pub position_valid: bool,
    /// The position north and east of the origin, m.
    pub pos_ne: Vector2<f64>,
    /// The velocity north and east, m/s.
    pub vel_ne: Vector2<f64>,
    /// The acceleration north and east, without gravity, m/s².
    pub accel_ne: Vector2<f64>,
    /// `true` if a measurement supported the altitude within the last 2 s.
    pub altitude_valid: bool,
    /// The altitude above the place of the last arming (before the first arming: of boot), m.
    pub alt_m: f64,
    /// The climb rate, m/s.
    pub climb_mps: f64,
    /// The altitude of the barometer alone above the same place, m.
    pub baro_alt_m: f64,
    /// The altitude for displays: low-passed by `altitude_lpf`, m.
    pub shown_alt_m: f64,
    /// The climb rate for displays: low-passed by `altitude_d_lpf`, m/s.
    pub shown_climb_mps: f64,
    /// The state of the GPS.
    pub gps: GpsStatus,
    /// `true` while a sensor calibration is running.
    pub calibrating: bool,
    /// `true` if the inertial sensors have repeated the same sample for a second while turning.
    pub imu_frozen: bool,
}

impl Estimate {
    /// Returns the inputs of the autopilot at `time`, `dt` seconds after the last ones, so far as the estimate has them.
    /// The rest is that of a disarmed craft with nothing known.
    #[doc(hidden)]
    pub fn nav_inputs(&self, time: SimTime, dt: f64) -> NavInputs {
        NavInputs {
            time,
            dt,
            fix: self.gps.fix && self.position_valid,
            altitude_valid: self.altitude_valid,
            heading_valid: self.heading_valid,
            origin: self.origin.unwrap_or_default(),
            pos_ne: self.pos_ne,
            vel_ne: self.vel_ne,
            alt_m: self.alt_m,
            climb_mps: self.climb_mps,
            heading_rad: self.heading_rad,
            yaw_rate_rps: self.rates.yaw,
            roll_rad: self.roll_rad,
            pitch_down_rad: self.pitch_down_rad,
            cos_tilt: self.cos_tilt,
            accel_ne: self.accel_ne,
            ..NavInputs::unknown()
        }
    }
}

impl Default for Estimate {
    /// Returns an estimate with nothing known: level, facing north, at the origin.
    fn default() -> Self {
        Self {
            attitude: UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::FRAC_PI_2),
            attitude_valid: false,
            heading_valid: false,
            heading_doubt_rad: None,
            tilt_doubt_rad: None,
            roll_rad: 0.0,
            pitch_down_rad: 0.0,
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
            baro_alt_m: 0.0,
            shown_alt_m: 0.0,
            shown_climb_mps: 0.0,
            gps: GpsStatus::default(),
            calibrating: true,
            imu_frozen: false,
        }
    }
}

impl Estimate {
    /// Returns the estimated position on earth; `None` before the first fix.
    pub fn place(&self) -> Option<LatLon> {
        self.origin.map(|origin| offset_to_latlon(origin, self.pos_ne))
    }
}
