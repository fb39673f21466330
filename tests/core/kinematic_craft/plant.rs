//! A kinematic quadcopter. Thrust sets the climb rate and tilt sets the horizontal acceleration, each with a
//! lag.
//!
//! Its default numbers are those of the public SITL harness. Such a craft reaches a steady sink rate at any
//! throttle, so low throttle alone does not show the ground.

use betadeck_core::geo::{GRAVITY, LatLon, offset_to_latlon};
use betadeck_core::signals::{GpsSample, MotorCommand, SensorFrame};
use betadeck_core::sim::{attitude, pressure_pa};
use nalgebra::{Vector2, Vector3};

/// The number of steps in which the accelerometer feels a touchdown, and the acceleration, m/s².
const BUMP_STEPS: u32 = 4;
const BUMP_MPS2: f64 = 60.0;
/// The body rate per unit of differential thrust, rad/s, and its time constant, s.
const RATE_GAIN: f64 = 12.0;
const RATE_TAU_S: f64 = 0.08;
/// The greatest tilt, rad.
const MAX_TILT_RAD: f64 = 1.2;
/// The share of the hover thrust below which a craft stays on the ground.
const LIFTING_SHARE: f64 = 0.8;
/// The place where the craft starts.
const HOME: LatLon = LatLon::new(-275_000_000, 1_530_000_000);
/// The magnetic field, ENU. Only its direction counts.
const FIELD_ENU: Vector3<f64> = Vector3::new(71.5, 2046.8, -3547.2);

/// The properties that distinguish one craft from another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Kind {
    /// The mean motor command that hovers, 0…1.
    pub(crate) hover: f64,
    /// The horizontal drag, 1/s.
    pub(crate) drag: f64,
    /// The steady climb rate per unit of thrust above hover, m/s.
    pub(crate) climb_gain: f64,
    /// The time constant of the climb rate, s.
    pub(crate) climb_tau_s: f64,
    /// `true` if the accelerometer feels a bump at the touchdown.
    pub(crate) bumps: bool,
}

impl Kind {
    /// The craft of the public harness.
    pub(crate) const HARNESS: Self =
        Self { hover: 0.30, drag: 0.8, climb_gain: 6.0, climb_tau_s: 0.3, bumps: true };
}

/// The craft and its motion; ENU from home, m and m/s.
#[derive(Debug, Clone)]
pub(crate) struct Plant {
    kind: Kind,
    pos: Vector3<f64>,
    vel: Vector3<f64>,
    accel: Vector3<f64>,
    /// Roll right, pitch nose down, heading clockwise, rad and rad/s.
    angles: Vector3<f64>,
    rates: Vector3<f64>,
    bump_steps: u32,
    steps: u64,
    /// `true` while the receiver reports the position.
    pub(crate) has_gps: bool,
}

impl Plant {
    pub(crate) fn new(kind: Kind) -> Self {
        Self {
            kind,
            pos: Vector3::zeros(),
            vel: Vector3::zeros(),
            accel: Vector3::zeros(),
            angles: Vector3::zeros(),
            rates: Vector3::zeros(),
            bump_steps: 0,
            steps: 0,
            has_gps: true,
        }
    }

    /// Returns `true` if the accelerometer feels a bump at the touchdown.
    pub(crate) fn bumps(&self) -> bool {
        self.kind.bumps
    }

    /// Returns the height above the ground, m.
    pub(crate) fn height_m(&self) -> f64 {
        self.pos.z
    }

    /// Returns the climb rate, m/s.
    pub(crate) fn climb_mps(&self) -> f64 {
        self.vel.z
    }

    /// Returns the horizontal distance from home, m.
    pub(crate) fn distance_m(&self) -> f64 {
        self.pos.xy().norm()
    }

    /// Puts the flying craft at this height, with this climb rate.
    pub(crate) fn place(&mut self, height_m: f64, climb_mps: f64) {
        (self.pos.z, self.vel.z) = (height_m, climb_mps);
    }

    /// Runs one step of `dt` seconds.
    pub(crate) fn step(&mut self, dt: f64, motors: &MotorCommand) {
        self.steps += 1;
        let [rear_right, front_right, rear_left, front_left] = motors.0;
        let thrust = motors.0.iter().sum::<f64>() / 4.0;
        if self.pos.z <= 0.001 && thrust < LIFTING_SHARE * self.kind.hover {
            self.stand();
            return;
        }
        let wanted = Vector3::new(
            rear_left + front_left - rear_right - front_right,
            rear_right + rear_left - front_right - front_left,
            front_right + rear_left - rear_right - front_left,
        ) * (RATE_GAIN / 2.0);
        self.rates += (wanted - self.rates) * (dt / RATE_TAU_S).min(1.0);
        self.angles += self.rates * dt;
        for tilt in self.angles.iter_mut().take(2) {
            *tilt = tilt.clamp(-MAX_TILT_RAD, MAX_TILT_RAD);
        }
        let (roll, pitch, heading) = (self.angles.x, self.angles.y, self.angles.z);
        let ahead = GRAVITY * pitch.tan();
        let right = GRAVITY * roll.tan();
        let (sin, cos) = heading.sin_cos();
        let pull = Vector2::new(ahead * sin + right * cos, ahead * cos - right * sin);
        let level = pull - self.kind.drag * self.vel.xy();
        let steady = self.kind.climb_gain * (thrust * pitch.cos() * roll.cos() - self.kind.hover);
        let climb = (steady - self.vel.z) * (1.0 / dt).min(1.0 / self.kind.climb_tau_s);
        self.accel = Vector3::new(level.x, level.y, climb);
        self.vel += self.accel * dt;
        self.pos += self.vel * dt;
        if self.pos.z < 0.0 {
            self.stand();
            self.bump_steps = BUMP_STEPS;
        }
    }

    fn stand(&mut self) {
        self.pos.z = 0.0;
        self.vel = Vector3::zeros();
        self.accel = Vector3::zeros();
        self.rates = Vector3::zeros();
        (self.angles.x, self.angles.y) = (0.0, 0.0);
        if self.bump_steps > 0 && self.kind.bumps {
            self.accel.z = BUMP_MPS2;
        }
        self.bump_steps = self.bump_steps.saturating_sub(1);
    }

    /// Returns the sensor measurements of the present step. `dt` is the length of a step, s.
    pub(crate) fn sensors(&self, dt: f64) -> SensorFrame {
        let every = |seconds: f64| self.steps.is_multiple_of((seconds / dt).round() as u64);
        let q = attitude(self.angles.z.to_degrees(), -self.angles.y.to_degrees(), self.angles.x.to_degrees());
        let force = self.accel + Vector3::new(0.0, 0.0, GRAVITY);
        let solution = GpsSample {
            fix: true,
            sats: 12,
            position: offset_to_latlon(HOME, Vector2::new(self.pos.y, self.pos.x)),
            alt_amsl_cm: (self.pos.z * 100.0) as i32,
            vel_enu: self.vel,
            horizontal_accuracy_m: 0.5,
            vertical_accuracy_m: 0.5,
            ..GpsSample::default()
        };
        SensorFrame {
            rate_flu: Vector3::new(self.rates.x, self.rates.y, -self.rates.z),
            specific_force_flu: q.inverse_transform_vector(&force),
            pressure_pa: Some(pressure_pa(self.pos.z)),
            mag_flu: Some(q.inverse_transform_vector(&FIELD_ENU)),
            gps: (self.has_gps && every(0.1)).then_some(solution),
            truth_attitude: Some(q),
            ..SensorFrame::default()
        }
    }
}
