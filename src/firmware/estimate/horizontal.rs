//! Position and velocity over the ground: dead reckoning by the accelerometer, corrected by the GPS.

use nalgebra::Vector2;

use super::gps::Dilution;
use super::history::Axis;
use super::kalman::{Gain, KalmanCovariance, ProcessNoise};
use crate::geo::{LatLon, local_offset};
use crate::math;
use crate::signals::GpsSample;

/// The nominal step, s.
const STEP_S: f64 = 0.01;
/// The assumed errors: of the acceleration with `ap_position_a` at its default, and of a good solution.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Errors {
    /// The white error of the acceleration, and the random walk of its slow error, tilt and accelerometer together.
    noise: ProcessNoise,
    /// The standard deviation of the slow error at the begin, m/s².
    accel_sigma: f64,
    /// The standard deviations of a good solution, m and m/s.
    position_sigma: f64,
    velocity_sigma: f64,
}

const USUAL: Errors = Errors {
    noise: ProcessNoise { accel: 4e-4, drift: 2.5e-3 },
    accel_sigma: 0.3,
    position_sigma: 0.3,
    velocity_sigma: 0.07,
};

/// Those of master. Its SITL target takes the dilution of its receiver for unknown, which is a tenth of the usual weight.
const PLAIN: Errors = Errors {
    noise: ProcessNoise { accel: 0.05, drift: 0.0 },
    accel_sigma: 0.0,
    position_sigma: 2.236,
    velocity_sigma: 1.0,
};

/// An innovation is suspicious if it exceeds this many standard deviations plus this size (m, m/s).
const GATE_SIGMAS: f64 = 5.0;
const POSITION_GATE: f64 = 2.0;
const VELOCITY_GATE: f64 = 3.0;
/// The number of suspicious solutions in a row that are accepted after all: 1 s.
const PATIENCE: u8 = 10;
/// The number of solutions after which the filter has settled.
const SETTLED: u8 = 20;
/// The time for which dead reckoning counts as valid, s.
const VALID_S: f64 = 2.0;

/// The horizontal filter; vectors are (north, east) of the origin.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Horizontal {
    covariance: KalmanCovariance,
    errors: Errors,
    north: Axis,
    east: Axis,
    origin: Option<LatLon>,
    suspicious: u8,
    solutions: u8,
    since_solution_s: f64,
}

impl Errors {
    fn covariance(&self) -> KalmanCovariance {
        KalmanCovariance::new(self.position_sigma, self.velocity_sigma, self.accel_sigma)
    }
}

impl Horizontal {
    pub(super) fn new() -> Self {
        Self {
            covariance: USUAL.covariance(),
            errors: USUAL,
            north: Axis::new(),
            east: Axis::new(),
            origin: None,
            suspicious: 0,
            solutions: 0,
            since_solution_s: f64::INFINITY,
        }
    }

    /// Chooses the assumed errors, and scales the trust in the accelerometer: 30 is neutral, more trusts it more.
    pub(super) fn set_law(&mut self, is_plain: bool, accel_trust: f64) {
        let was_plain = self.errors.accel_sigma == 0.0;
        self.errors = if is_plain { PLAIN } else { USUAL };
        self.errors.noise.accel *= 30.0 / accel_trust.max(1.0);
        if is_plain != was_plain {
            self.forget_accel_error();
        }
    }

    pub(super) fn origin(&self) -> Option<LatLon> {
        self.origin
    }

    pub(super) fn position(&self) -> Vector2<f64> {
        Vector2::new(self.north.position, self.east.position)
    }

    pub(super) fn velocity(&self) -> Vector2<f64> {
        Vector2::new(self.north.velocity, self.east.velocity)
    }

    /// Returns the acceleration that the measured one lacks because the attitude or the accelerometer is wrong, m/s².
    pub(super) fn accel_error(&self) -> Vector2<f64> {
        Vector2::new(self.north.accel_error, self.east.accel_error)
    }

    /// Subtracts the acceleration error that a turn of the attitude has explained.
    pub(super) fn explain(&mut self, accel: Vector2<f64>) {
        self.north.accel_error -= accel.x;
        self.east.accel_error -= accel.y;
    }

    /// Clears the acceleration error, which came from a wrong heading that is now known.
    pub(super) fn forget_accel_error(&mut self) {
        (self.north.accel_error, self.east.accel_error) = (0.0, 0.0);
        self.covariance = self.errors.covariance();
    }

    /// Returns `true` if position and velocity are valid.
    pub(super) fn is_valid(&self) -> bool {
        self.origin.is_some() && self.since_solution_s <= VALID_S
    }

    /// Returns `true` if the filter has settled and still gets solutions.
    pub(super) fn is_settled(&self) -> bool {
        self.solutions >= SETTLED && self.since_solution_s <= 0.5
    }

    /// Moves the origin. The position on earth stays.
    pub(super) fn set_origin(&mut self, origin: LatLon) {
        if let Some(old) = self.origin {
            let offset = local_offset(origin, old);
            self.north.shift(offset.x);
            self.east.shift(offset.y);
        }
        self.origin = Some(origin);
    }

    /// Takes one step with the measured acceleration (north, east), m/s².
    pub(super) fn predict(&mut self, accel: Vector2<f64>, dt: f64) {
        self.since_solution_s += dt;
        if !self.is_valid() {
            self.solutions = 0;
            return;
        }
        self.covariance.predict(dt, &self.errors.noise);
        self.north.predict(accel.x, dt);
        self.east.predict(accel.y, dt);
    }

    /// Applies a solution that describes the craft `age_s` ago.
    pub(super) fn fuse(&mut self, sample: &GpsSample, age_s: f64) {
        let velocity = Vector2::new(sample.vel_enu.y, sample.vel_enu.x);
        let origin = *self.origin.get_or_insert(sample.position);
        let position = local_offset(origin, sample.position);
        let is_valid = self.is_valid();
        self.since_solution_s = 0.0;
        if !is_valid {
            self.restart(position, velocity, age_s);
            return;
        }
        let dilution = Dilution::of(sample);
        let age = (age_s / STEP_S).round().max(0.0) as usize;
        let mut covariance = self.covariance;
        let by_velocity =
            covariance.measure_velocity(math::powi(self.errors.velocity_sigma * dilution.speed, 2));
        let (p, v) = self.past(age);
        let velocity_error = velocity - v;
        if exceeds(velocity_error, &by_velocity, VELOCITY_GATE) {
            if self.lose_patience() {
                self.restart(position, velocity, age_s);
            }
            return;
        }
        self.correct(&by_velocity, velocity_error, age);
        let before = covariance;
        let by_position =
            covariance.measure_position(math::powi(self.errors.position_sigma * dilution.horizontal, 2));
        let position_error = position - p;
        if exceeds(position_error, &by_position, POSITION_GATE) {
            // A plausible velocity with a displaced position: after a while the new position is accepted.
            self.covariance = before;
            if self.lose_patience() {
                let (p, _) = self.past(age);
                self.north.shift(position.x - p.x);
                self.east.shift(position.y - p.y);
            }
            return;
        }
        self.covariance = covariance;
        // The correction by the velocity has also moved the past position.
        let (p, _) = self.past(age);
        self.correct(&by_position, position - p, age);
        self.suspicious = 0;
        self.solutions = self.solutions.saturating_add(1);
    }

    fn past(&self, age: usize) -> (Vector2<f64>, Vector2<f64>) {
        let ((pn, vn), (pe, ve)) = (self.north.past(age), self.east.past(age));
        (Vector2::new(pn, pe), Vector2::new(vn, ve))
    }

    fn correct(&mut self, gain: &Gain, error: Vector2<f64>, age: usize) {
        self.north.correct(gain, error.x, age, STEP_S);
        self.east.correct(gain, error.y, age, STEP_S);
    }

    fn lose_patience(&mut self) -> bool {
        self.suspicious += 1;
        if self.suspicious >= PATIENCE {
            self.suspicious = 0;
            return true;
        }
        false
    }

    fn restart(&mut self, position: Vector2<f64>, velocity: Vector2<f64>, age_s: f64) {
        let now = position + velocity * age_s;
        self.north.reset(now.x, velocity.x, STEP_S);
        self.east.reset(now.y, velocity.y, STEP_S);
        self.covariance = self.errors.covariance();
        (self.suspicious, self.solutions) = (0, 0);
    }
}

/// Returns `true` if an innovation is too large to be noise.
fn exceeds(error: Vector2<f64>, gain: &Gain, size: f64) -> bool {
    error.norm() > size + GATE_SIGMAS * gain.innovation.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::offset_to_latlon;
    use nalgebra::Vector3;

    const HOME: LatLon = LatLon::new(404_635_000, -795_182_000);

    /// Flies accelerations along north with a solution each 100 ms that is `age_s` old. Returns the filter and the true
    /// position and velocity.
    fn fly(age_s: f64, accel_bias: f64, seconds: f64) -> (Horizontal, f64, f64) {
        let mut filter = Horizontal::new();
        let mut truth = vec![(0.0, 0.0)];
        for step in 0..(seconds / STEP_S) as usize {
            let accel = 2.0 * (step as f64 * STEP_S).sin();
            let (p, v) = truth[truth.len() - 1];
            truth.push((p + v * STEP_S + 0.5 * accel * STEP_S * STEP_S, v + accel * STEP_S));
            filter.predict(Vector2::new(accel + accel_bias, 0.0), STEP_S);
            if step % 10 == 0 {
                let late = truth.len().saturating_sub(1 + (age_s / STEP_S).round() as usize);
                let (p, v) = truth[late];
                filter.fuse(
                    &GpsSample {
                        fix: true,
                        position: offset_to_latlon(HOME, Vector2::new(p, 0.0)),
                        vel_enu: Vector3::new(0.0, v, 0.0),
                        ..GpsSample::default()
                    },
                    age_s,
                );
            }
        }
        let (p, v) = truth[truth.len() - 1];
        (filter, p, v)
    }

    #[test]
    fn latency_and_bias_are_compensated() {
        for age_s in [0.0, 0.1] {
            let (filter, position, velocity) = fly(age_s, 0.1, 60.0);
            assert!((filter.position().x - position).abs() < 0.05, "{} {position}", filter.position());
            assert!((filter.velocity().x - velocity).abs() < 0.02, "{} {velocity}", filter.velocity());
            assert!((filter.accel_error().x + 0.1).abs() < 0.02);
        }
    }

    #[test]
    fn a_short_glitch_is_ignored_and_a_long_one_believed() {
        let (mut filter, ..) = fly(0.0, 0.0, 20.0);
        let before = filter.position();
        let velocity = filter.velocity();
        let shifted = offset_to_latlon(HOME, before + Vector2::new(0.0, 30.0));
        for sample in 1..=10 {
            let solution = GpsSample {
                fix: true,
                position: shifted,
                vel_enu: Vector3::new(velocity.y, velocity.x, 0.0),
                ..GpsSample::default()
            };
            filter.fuse(&solution, 0.0);
            let shift = (filter.position() - before).y;
            assert!(if sample < 10 { shift.abs() < 0.01 } else { (shift - 30.0).abs() < 0.1 }, "{shift}");
        }
    }

    #[test]
    fn moving_the_origin_keeps_the_place() {
        let (mut filter, ..) = fly(0.0, 0.0, 10.0);
        let place = offset_to_latlon(HOME, filter.position());
        filter.set_origin(place);
        assert!(filter.position().norm() < 0.02);
    }

    #[test]
    fn is_invalid_two_seconds_after_the_last_solution() {
        let (mut filter, ..) = fly(0.0, 0.0, 10.0);
        for _ in 0..185 {
            filter.predict(Vector2::zeros(), STEP_S);
        }
        assert!(filter.is_valid());
        for _ in 0..20 {
            filter.predict(Vector2::zeros(), STEP_S);
        }
        assert!(!filter.is_valid());
    }
}
