//! From demands to motors: setpoints, levelling, rate control, mixing.
//!
//! ```text
//! sticks ─► rates ─► smoothing ─┬─► acro setpoint ──────────┐
//!                               └─► angle target ─┐         ▼
//! navigator, holds ─► tilt ───────────────────────┴► level ─► rate PID ─► mixer ─► motors
//!                   ─► throttle ──────────────────────────────────────────▲
//! gyro ─► low-pass ─────────────────────────────────────────────▲
//! ```
//!
//! Signs are those of [`crate::firmware::estimate`]: roll right, pitch nose down and yaw clockwise are positive. Angles
//! and rates between settings and PID are in degrees and degrees per second, the units of the tuning. Demands from
//! other modules are in SI units.

use crate::firmware::estimate::DueTasks;
use crate::signals::{MOTORS, MotorCommand, PerMotor};

mod boost;
mod controller;
mod curve;
mod derived;
mod gyro;
mod heading;
pub mod hold;
mod level;
mod mixer;
mod pid;
mod smoothing;
mod tuning;

pub use controller::Controller;
pub use curve::{RateCurve, RatesType, ThrottleCurve, ThrottleLimit};
pub use tuning::{
    AxisGains, BoostTuning, DMax, ItermRelax, LevelTuning, MixerTuning, RateTuning, TiltThrottle, Tuning,
};

/// The meaning of the sticks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum StickMode {
    #[default]
    Acro,
    Angle,
    /// Angles near the centre, rates towards the ends.
    Horizon,
}

/// An attitude demanded by the navigator or a hold mode. It replaces the pilot's angles.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TiltDemand {
    /// Roll, rad, right positive.
    pub roll_rad: f64,
    /// Pitch, rad, nose down positive.
    pub pitch_down_rad: f64,
}

/// The inputs of the controller in one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ControlInput {
    /// The slower loops that are due, as reported by the estimator.
    pub due: DueTasks,
    pub armed: bool,
    /// The meaning of the sticks.
    pub mode: StickMode,
    /// Roll stick, RC command units ±500, right positive.
    pub stick_roll: f64,
    /// Pitch stick, RC command units ±500, forward positive.
    pub stick_pitch: f64,
    /// Yaw stick, RC command units ±500, right positive.
    pub stick_yaw: f64,
    /// Throttle pulse, µs.
    pub throttle_us: f64,
    /// `true` if a new RC frame arrived since the last step.
    pub rc_frame: bool,
    /// The tilt demanded instead of the pilot's. It implies levelling.
    pub tilt: Option<TiltDemand>,
    /// The yaw rate demanded instead of the pilot's, rad/s, clockwise positive.
    pub yaw_rate_rps: Option<f64>,
    /// The throttle demanded instead of the pilot's, 0…1.
    pub throttle: Option<f64>,
    /// `true` while the legs carry weight. The integrals are then cleared while the attitude is levelled.
    pub stands: bool,
    /// Full stabilisation at zero throttle: the AIRMODE feature or its switch, once the throttle has been raised.
    pub airmode: bool,
    /// Raises the gains in quick throttle changes: the ANTI_GRAVITY feature or its switch.
    pub anti_gravity: bool,
    /// Stops the motors at low throttle: the MOTOR_STOP feature.
    pub motor_stop: bool,
    /// `true` while a failsafe procedure runs.
    pub failsafe: bool,
    /// The heading (rad) that roll and pitch sticks refer to: HEADFREE.
    pub headfree_reference_rad: Option<f64>,
    /// Holds the heading while the yaw stick is centred: MAG.
    pub heading_hold: bool,
    /// The outputs of the `motor` command while disarmed, µs.
    pub motor_test_us: PerMotor,
}

impl Default for ControlInput {
    /// Returns the input for a disarmed craft with centred sticks.
    fn default() -> Self {
        Self {
            due: DueTasks::default(),
            armed: false,
            mode: StickMode::Acro,
            stick_roll: 0.0,
            stick_pitch: 0.0,
            stick_yaw: 0.0,
            throttle_us: 1000.0,
            rc_frame: false,
            tilt: None,
            yaw_rate_rps: None,
            throttle: None,
            stands: false,
            airmode: false,
            anti_gravity: false,
            motor_stop: false,
            failsafe: false,
            headfree_reference_rad: None,
            heading_hold: false,
            motor_test_us: [1000.0; MOTORS],
        }
    }
}

/// The terms of the PID sums of roll, pitch and yaw, in their units.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PidTerms {
    pub p: [f64; 3],
    pub i: [f64; 3],
    pub d: [f64; 3],
    /// The feed-forward.
    pub f: [f64; 3],
}

/// The results of the last step of the controller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ControlState {
    pub motors: MotorCommand,
    /// The motor commands as pulses, µs.
    pub motors_us: PerMotor,
    /// The throttle that drove the mixer, RC µs.
    pub throttle_us: f64,
    /// The same as a share of the mixer's range, 0…1.
    pub throttle: f64,
    /// The filtered gyro rates, °/s: roll, pitch, yaw.
    pub gyro_dps: [f64; 3],
    /// The rate setpoints, °/s.
    pub setpoint_dps: [f64; 3],
    /// The PID sums before their limits; ±1000 = the full range of the mixer.
    pub pid_sum: [f64; 3],
    /// The terms of these sums.
    pub terms: PidTerms,
    /// The demanded roll and pitch (nose down positive) while levelling, rad.
    pub angle_demand_rad: Option<[f64; 2]>,
}

impl Default for ControlState {
    fn default() -> Self {
        Self {
            motors: MotorCommand::default(),
            motors_us: [1000.0; MOTORS],
            throttle_us: 1000.0,
            throttle: 0.0,
            gyro_dps: [0.0; 3],
            setpoint_dps: [0.0; 3],
            pid_sum: [0.0; 3],
            terms: PidTerms::default(),
            angle_demand_rad: None,
        }
    }
}
