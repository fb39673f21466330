//! Attitude: gyro integration, and slow corrections of its drift.
//!
//! Quaternion body FLU → world ENU. Corrections are rotations about world axes.

use nalgebra::{Quaternion, Rotation3, UnitQuaternion, Vector3};

use crate::geo::GRAVITY;
use crate::math;

/// The largest relative difference from gravity at which the accelerometer shows the vertical.
const STEADY_PART: f64 = 0.1;
/// The turn rate (rad/s) above which the integral of the correction stops.
const INTEGRAL_RATE_LIMIT: f64 = 20.0 * std::f64::consts::PI / 180.0;
/// The largest integral, rad/s.
const INTEGRAL_LIMIT: f64 = 0.4;

/// The gains of the correction towards the measured vertical.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct VerticalGains {
    /// The proportional gain, rad/s per unit of the sine of the error.
    pub kp: f64,
    /// The integral gain, rad/s² per unit.
    pub ki: f64,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Attitude {
    /// Body FLU → world ENU.
    pub q: UnitQuaternion<f64>,
    /// The same as a matrix, as of the last [`Attitude::refresh`].
    pub matrix: Rotation3<f64>,
    /// The rate correction found by the integral, body axes, rad/s.
    rate_correction: Vector3<f64>,
    last_rate: Vector3<f64>,
}

impl Attitude {
    /// Creates a level attitude facing north.
    pub(super) fn new() -> Self {
        Self::at(UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::FRAC_PI_2))
    }

    fn at(q: UnitQuaternion<f64>) -> Self {
        Self {
            q,
            matrix: q.to_rotation_matrix(),
            rate_correction: Vector3::zeros(),
            last_rate: Vector3::zeros(),
        }
    }

    /// Sets the tilt by the accelerometer. The heading stays.
    pub(super) fn align(&mut self, force: &Vector3<f64>) {
        let up = self.q * force;
        if let Some(turn) = UnitQuaternion::rotation_between(&up, &Vector3::z()) {
            self.set(turn * self.q);
        }
    }

    /// Sets an attitude known from another source.
    pub(super) fn set(&mut self, q: UnitQuaternion<f64>) {
        self.q = q;
        self.refresh();
    }

    /// Integrates one gyro sample (body rates, rad/s), averaged with the one before.
    pub(super) fn integrate(&mut self, rate: &Vector3<f64>, dt: f64) {
        let turn = (0.5 * (rate + self.last_rate) + self.rate_correction) * dt;
        self.last_rate = *rate;
        // The exponential to third order, because the turn of one step is far below a radian.
        let square = turn.norm_squared();
        let half = turn * (0.5 - square / 48.0);
        let step = Quaternion::new(1.0 - square * 0.125, half.x, half.y, half.z);
        let q = self.q.into_inner() * step;
        // One Newton step keeps the length at one, because the error of a single step is tiny.
        self.q = UnitQuaternion::new_unchecked(q * (1.5 - 0.5 * q.norm_squared()));
    }

    /// Normalises the quaternion and updates the matrix.
    pub(super) fn refresh(&mut self) {
        let q = UnitQuaternion::new_normalize(self.q.into_inner());
        self.q = if q.coords.iter().all(|c| c.is_finite()) { q } else { UnitQuaternion::identity() };
        self.matrix = self.q.to_rotation_matrix();
    }

    /// Turns the attitude by a small rotation vector in world axes, rad.
    pub(super) fn turn_world(&mut self, angle: &Vector3<f64>) {
        self.q = UnitQuaternion::from_scaled_axis(*angle) * self.q;
        self.refresh();
    }

    /// Corrects the tilt towards the vertical. The specific force `force` (world axes) belongs to a craft whose real
    /// acceleration is `force + missing − g`, so gravity can be found from a known motion. Returns the part of
    /// `missing` that the turn has explained, m/s².
    pub(super) fn correct_tilt(
        &mut self,
        force: &Vector3<f64>,
        missing: &Vector3<f64>,
        gains: &VerticalGains,
        dt: f64,
    ) -> Vector3<f64> {
        let square = force.norm_squared().max(1.0);
        let error = force.cross(missing) / square;
        if gains.ki > 0.0 && self.last_rate.norm() < INTEGRAL_RATE_LIMIT {
            self.rate_correction += self.matrix.inverse_transform_vector(&error) * (gains.ki * dt);
            self.rate_correction = self.rate_correction.cap_magnitude(INTEGRAL_LIMIT);
        }
        let angle = error * (gains.kp * dt).min(0.5);
        self.turn_world(&angle);
        angle.cross(force)
    }

    /// Returns the rate correction found by the integral, body axes, rad/s.
    pub(super) fn rate_correction(&self) -> &Vector3<f64> {
        &self.rate_correction
    }

    /// Returns roll, right positive, and pitch, nose down positive, rad.
    pub(super) fn roll_pitch_down(&self) -> (f64, f64) {
        let m = self.matrix.matrix();
        (math::atan2(m[(2, 1)], m[(2, 2)]), math::asin((-m[(2, 0)]).clamp(-1.0, 1.0)))
    }

    /// Returns the heading, rad clockwise from north, 0…2π.
    pub(super) fn heading(&self) -> f64 {
        let m = self.matrix.matrix();
        math::atan2(m[(0, 0)], m[(1, 0)]).rem_euclid(std::f64::consts::TAU)
    }

    /// Returns the cosine of the tilt from level.
    pub(super) fn cos_tilt(&self) -> f64 {
        self.matrix.matrix()[(2, 2)]
    }
}

/// Returns the difference between a specific force (world axes) and that of a craft in steady motion. It is the input
/// of [`Attitude::correct_tilt`] if nothing better is known. `None` while the force is too far from the size of
/// gravity. The vertical part counts, too: it distinguishes upright from upside down.
pub(super) fn missing_in_steady_motion(force: &Vector3<f64>) -> Option<Vector3<f64>> {
    let size = force.norm() / GRAVITY;
    ((size - 1.0).abs() < STEADY_PART).then(|| Vector3::new(-force.x, -force.y, GRAVITY - force.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_follow_the_conventions() {
        let mut attitude = Attitude::new();
        assert!(attitude.heading().abs() < 1e-12);
        // Turns about the body axes: the forward axis rolls right, the left axis pitches the nose down.
        for (rate, expected) in [
            (Vector3::new(0.5, 0.0, 0.0), (0.05, 0.0, 0.0)),
            (Vector3::new(0.0, 0.5, 0.0), (0.0, 0.05, 0.0)),
            (Vector3::new(0.0, 0.0, -0.5), (0.0, 0.0, 0.05)),
        ] {
            attitude = Attitude::new();
            attitude.last_rate = rate;
            for _ in 0..100 {
                attitude.integrate(&rate, 0.001);
            }
            attitude.refresh();
            let (roll, pitch) = attitude.roll_pitch_down();
            let heading = attitude.heading();
            assert!((roll - expected.0).abs() < 1e-9, "{roll}");
            assert!((pitch - expected.1).abs() < 1e-9, "{pitch}");
            assert!((heading - expected.2).abs() < 1e-9, "{heading}");
        }
    }

    #[test]
    fn converges_to_the_vertical_with_the_gain() {
        let mut attitude = Attitude::new();
        attitude.set(UnitQuaternion::from_euler_angles(0.1, 0.0, 0.0) * attitude.q);
        let body_up = Vector3::new(0.0, 0.0, GRAVITY);
        let gains = VerticalGains { kp: 0.25, ki: 0.0 };
        for _ in 0..400 {
            let force = attitude.matrix * body_up;
            let missing = missing_in_steady_motion(&force).unwrap();
            attitude.correct_tilt(&force, &missing, &gains, 0.01);
        }
        let tilt = attitude.cos_tilt().acos();
        assert!((tilt - 0.1 * (-1.0_f64).exp()).abs() < 0.001, "{tilt}");
    }

    #[test]
    fn an_upside_down_guess_is_righted() {
        let mut attitude = Attitude::new();
        attitude.set(UnitQuaternion::from_euler_angles(3.1, 0.0, 0.0) * attitude.q);
        let body_up = Vector3::new(0.0, 0.0, GRAVITY);
        let gains = VerticalGains { kp: 2.5, ki: 0.0 };
        for _ in 0..1000 {
            let force = attitude.matrix * body_up;
            let missing = missing_in_steady_motion(&force).unwrap();
            attitude.correct_tilt(&force, &missing, &gains, 0.01);
        }
        assert!(attitude.cos_tilt() > 0.999, "{}", attitude.cos_tilt());
    }

    #[test]
    fn long_integration_keeps_a_unit_quaternion() {
        let mut attitude = Attitude::new();
        for _ in 0..100_000 {
            attitude.integrate(&Vector3::new(3.0, -5.0, 9.0), 0.0025);
        }
        assert!((attitude.q.norm() - 1.0).abs() < 1e-6);
    }
}
