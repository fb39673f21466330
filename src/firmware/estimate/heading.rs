//! Correction of the heading: by the magnetometer, and by comparing accelerations with the GPS.

use nalgebra::{Rotation3, Vector2, Vector3};

use crate::geo::wrap_pi;
use crate::math;

/// The time constants of the correction by the magnetometer, s: on the ground, trusted in the air, and not trusted in
/// the air.
const PARKED_S: f64 = 0.5;
const TRUSTED_S: f64 = 5.0;
/// That of master, measured by the error beside a steady bias of the gyro.
const PLAIN_S: f64 = 7.5;
const DOUBTED_S: f64 = 20.0;
/// The largest error at which a doubted magnetometer is still used, rad.
const DOUBT_LIMIT: f64 = 10.0 * std::f64::consts::PI / 180.0;
/// The number of remembered steps of inertial velocity: 320 ms.
const DEPTH: usize = 32;
/// The number of solutions between the ends of a comparison: 1 s at 10 Hz.
const WINDOW: usize = 10;
/// The least change of velocity over the window that indicates a direction, m/s, and the change with full weight.
const MIN_CHANGE: f64 = 1.0;
const FULL_CHANGE: f64 = 3.0;
/// The share of the disagreement that one comparison corrects.
const SHARE: f64 = 0.05;
/// The least velocity change that counts as evidence, m/s, and the share of the evidence kept per comparison: 5 s.
const EVIDENT_CHANGE: f64 = 0.5;
const EVIDENCE_KEPT: f64 = 0.98;
/// The evidence that is enough, (m/s)², and the share of it that must agree on the same angle.
const ENOUGH: f64 = 5.0;
const COHERENT: f64 = 0.8;

/// Returns the angle of the estimated heading clockwise from the true one by a magnetometer sample (body axes), rad;
/// `None` if the field points straight up or down.
pub(super) fn magnetic_error(
    attitude: &Rotation3<f64>,
    mag_flu: &Vector3<f64>,
    declination_rad: f64,
) -> Option<f64> {
    let field = attitude * mag_flu;
    let horizontal = field.xy().norm();
    let error = wrap_pi(math::atan2(field.x, field.y) - declination_rad);
    (horizontal > 0.05 * field.norm() && error.is_finite()).then_some(error)
}

/// The trust in the magnetometer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MagTrust {
    Parked,
    /// In the air, `trust_mag` on.
    Trusted,
    /// The same with the weights of master.
    Plain,
    /// In the air, `trust_mag` off.
    Doubted,
}

impl MagTrust {
    /// Returns the trust on the ground or in the air, by `trust_mag`, and by the weights of master.
    pub(super) fn new(armed: bool, trust_mag: bool, is_plain: bool) -> Self {
        match (armed, trust_mag) {
            (false, _) => Self::Parked,
            (true, true) if is_plain => Self::Plain,
            (true, true) => Self::Trusted,
            (true, false) => Self::Doubted,
        }
    }

    /// Returns the part of a heading error that one sample corrects after `dt` seconds, rad; zero if it is not trusted.
    pub(super) fn correction(self, error: f64, dt: f64) -> f64 {
        let time_constant = match self {
            Self::Parked => PARKED_S,
            Self::Trusted => TRUSTED_S,
            Self::Plain => PLAIN_S,
            Self::Doubted if error.abs() < DOUBT_LIMIT => DOUBTED_S,
            Self::Doubted => return 0.0,
        };
        error * (dt / time_constant).min(1.0)
    }
}

/// Compares the velocity change felt by the accelerometer with the one seen by the GPS. The angle between them is the
/// error of the heading. It works only while the craft accelerates.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CourseComparison {
    inertial: [Vector2<f64>; DEPTH],
    newest: usize,
    window: [(Vector2<f64>, Vector2<f64>); WINDOW],
    filled: usize,
    next: usize,
    /// The felt velocity changes relative to the seen ones: the sum of (scalar product, felt to the right of seen), and
    /// the sum of sizes.
    evidence: Vector2<f64>,
    evidence_size: f64,
}

impl CourseComparison {
    pub(super) fn new() -> Self {
        let zero = Vector2::zeros();
        Self {
            inertial: [zero; DEPTH],
            newest: 0,
            window: [(zero, zero); WINDOW],
            filled: 0,
            next: 0,
            evidence: zero,
            evidence_size: 0.0,
        }
    }

    /// Takes one step of inertial acceleration (north, east), m/s².
    pub(super) fn predict(&mut self, accel: Vector2<f64>, dt: f64) {
        let velocity = self.inertial[self.newest] + accel * dt;
        self.newest = (self.newest + 1) % DEPTH;
        self.inertial[self.newest] = velocity;
    }

    /// Starts again. Called after a gap in the solutions.
    pub(super) fn clear(&mut self) {
        self.filled = 0;
        (self.evidence, self.evidence_size) = (Vector2::zeros(), 0.0);
    }

    /// Adapts to a heading that was turned anticlockwise by `angle`, rad: the felt changes are that much further left.
    pub(super) fn turn(&mut self, angle: f64) {
        let (sin, cos) = math::sin_cos(angle);
        let (x, y) = (self.evidence.x, self.evidence.y);
        self.evidence = Vector2::new(x * cos + y * sin, y * cos - x * sin);
    }

    /// Returns the angle of the estimated heading clockwise from the true one over the last seconds, rad, if there is
    /// enough evidence.
    pub(super) fn heading_error(&self) -> Option<f64> {
        let size = self.evidence_size;
        let is_sure = size > ENOUGH && self.evidence.norm() > COHERENT * size;
        is_sure.then(|| math::atan2(self.evidence.y, self.evidence.x))
    }

    /// Compares a solution's velocity (north, east) of `age` steps ago. Returns the correction of the heading,
    /// anticlockwise positive, rad.
    pub(super) fn compare(&mut self, velocity: Vector2<f64>, age: usize) -> f64 {
        let inertial = self.inertial[(self.newest + DEPTH - age.min(DEPTH - 1)) % DEPTH];
        let (then, inertial_then) = self.window[self.next];
        self.window[self.next] = (velocity, inertial);
        self.next = (self.next + 1) % WINDOW;
        if self.filled < WINDOW {
            self.filled += 1;
            return 0.0;
        }
        let (seen, felt) = (velocity - then, inertial - inertial_then);
        let size = seen.norm().min(felt.norm());
        self.evidence *= EVIDENCE_KEPT;
        self.evidence_size *= EVIDENCE_KEPT;
        if size >= EVIDENT_CHANGE {
            // (North, east): positive if the felt change is to the right.
            self.evidence += Vector2::new(felt.dot(&seen), seen.perp(&felt));
            self.evidence_size += felt.norm() * seen.norm();
        }
        if size < MIN_CHANGE {
            return 0.0;
        }
        // Bearings grow from north to east.
        let error = wrap_pi(math::atan2(felt.y, felt.x) - math::atan2(seen.y, seen.x));
        SHARE * math::powi((size / FULL_CHANGE).min(1.0), 2) * error
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_craft_that_believes_to_point_further_right_sees_north_further_right() {
        // The true heading is north; the estimate is 0.1 rad clockwise of it.
        let truth = Rotation3::from_axis_angle(&Vector3::z_axis(), std::f64::consts::FRAC_PI_2);
        let believed = Rotation3::from_axis_angle(&Vector3::z_axis(), -0.1) * truth;
        let field = Vector3::new(0.0, 2046.8, -3547.2);
        let error = magnetic_error(&believed, &(truth.inverse() * field), 0.0).unwrap();
        assert!((error - 0.1).abs() < 1e-9);
        assert_eq!(MagTrust::Doubted.correction(0.3, 0.01), 0.0);
        assert!((MagTrust::Trusted.correction(0.3, 0.01) - 0.0006).abs() < 1e-12);
    }

    #[test]
    fn accelerating_reveals_a_wrong_heading() {
        let mut comparison = CourseComparison::new();
        let mut heading_error = 0.4;
        let mut velocity = Vector2::zeros();
        for step in 0..6000 {
            let accel = Vector2::new(3.0 * (f64::from(step) * 0.01).cos(), 0.0);
            let (sin, cos) = f64::sin_cos(heading_error);
            comparison.predict(Vector2::new(accel.x * cos, accel.x * sin), 0.01);
            velocity += accel * 0.01;
            if step % 10 == 0 {
                heading_error -= comparison.compare(velocity, 0);
            }
        }
        assert!(heading_error.abs() < 0.04, "{heading_error}");
    }

    #[test]
    fn the_evidence_names_the_error_and_follows_a_turn() {
        let mut comparison = CourseComparison::new();
        assert_eq!(comparison.heading_error(), None);
        let mut velocity = Vector2::zeros();
        for step in 0..500 {
            let accel = Vector2::new(0.0, 2.0);
            let (sin, cos) = f64::sin_cos(1.0);
            comparison
                .predict(Vector2::new(accel.x * cos - accel.y * sin, accel.x * sin + accel.y * cos), 0.01);
            velocity += accel * 0.01;
            if step % 10 == 0 {
                comparison.compare(velocity, 0);
            }
        }
        assert!(comparison.heading_error().is_some_and(|error| (error - 1.0).abs() < 0.05));
        comparison.turn(0.7);
        assert!(comparison.heading_error().is_some_and(|error| (error - 0.3).abs() < 0.05));
        comparison.clear();
        assert_eq!(comparison.heading_error(), None);
    }
}
