//! The recent past of one axis, so that a late measurement is compared with the estimate at its own time.

use super::kalman::Gain;

/// The number of steps remembered: 320 ms at 100 Hz.
const DEPTH: usize = 32;

/// Position and velocity of the last [`DEPTH`] steps, and the present state with its acceleration error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Axis {
    /// The position now, m.
    pub position: f64,
    /// The velocity now, m/s.
    pub velocity: f64,
    /// The acceleration missing from the measured one, m/s².
    pub accel_error: f64,
    /// The largest acceleration error, m/s².
    pub accel_error_limit: f64,
    past: [(f64, f64); DEPTH],
    newest: usize,
}

/// The usual largest acceleration error, m/s²: more than a tilt error of 17° or the worst accelerometer causes.
pub(super) const ACCEL_ERROR_LIMIT: f64 = 3.0;

impl Axis {
    /// Creates an axis at rest at zero.
    pub(super) fn new() -> Self {
        Self {
            position: 0.0,
            velocity: 0.0,
            accel_error: 0.0,
            accel_error_limit: ACCEL_ERROR_LIMIT,
            past: [(0.0, 0.0); DEPTH],
            newest: 0,
        }
    }

    /// Starts again at this position and velocity, as if it had always moved like that.
    pub(super) fn reset(&mut self, position: f64, velocity: f64, dt: f64) {
        (self.position, self.velocity) = (position, velocity);
        for age in 0..DEPTH {
            let slot = self.slot(age);
            self.past[slot] = (position - velocity * age as f64 * dt, velocity);
        }
    }

    /// Takes one step with the measured acceleration (m/s²).
    pub(super) fn predict(&mut self, accel: f64, dt: f64) {
        let accel = accel + self.accel_error;
        self.position += dt * (self.velocity + 0.5 * dt * accel);
        self.velocity += dt * accel;
        self.newest = (self.newest + 1) % DEPTH;
        self.past[self.newest] = (self.position, self.velocity);
    }

    /// Returns position and velocity `age` steps ago, or the oldest known if `age` is larger.
    pub(super) fn past(&self, age: usize) -> (f64, f64) {
        self.past[self.slot(age)]
    }

    /// Applies an innovation of `age` steps ago. It corrects that instant and everything that followed from it.
    pub(super) fn correct(&mut self, gain: &Gain, innovation: f64, age: usize, dt: f64) {
        let age = age.min(DEPTH - 1);
        let (p, v) = (gain.position * innovation, gain.velocity * innovation);
        let before = self.accel_error;
        let limit = self.accel_error_limit;
        self.accel_error = (before + gain.accel * innovation).clamp(-limit, limit);
        let b = self.accel_error - before;
        for back in 0..DEPTH {
            let since = (age as f64 - back as f64).max(0.0) * dt;
            let slot = self.slot(back);
            let (position, velocity) = &mut self.past[slot];
            *position += p + since * (v + 0.5 * since * b);
            *velocity += v + since * b;
        }
        (self.position, self.velocity) = self.past[self.newest];
    }

    /// Moves the zero of the positions.
    pub(super) fn shift(&mut self, by: f64) {
        self.position += by;
        for (position, _) in &mut self.past {
            *position += by;
        }
    }

    fn slot(&self, age: usize) -> usize {
        (self.newest + DEPTH - age.min(DEPTH - 1)) % DEPTH
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_late_velocity_correction_moves_the_present_position_too() {
        let mut axis = Axis::new();
        for _ in 0..20 {
            axis.predict(0.0, 0.01);
        }
        let gain = Gain { position: 0.0, velocity: 1.0, accel: 0.0, innovation: 1.0 };
        axis.correct(&gain, 2.0, 10, 0.01);
        assert!((axis.velocity - 2.0).abs() < 1e-12);
        assert!((axis.position - 0.2).abs() < 1e-12);
        assert_eq!(axis.past(10), (0.0, 2.0));
    }

    #[test]
    fn remembers_where_it_was() {
        let mut axis = Axis::new();
        axis.reset(5.0, 1.0, 0.01);
        assert!((axis.past(10).0 - 4.9).abs() < 1e-12);
        for _ in 0..7 {
            axis.predict(0.0, 0.01);
        }
        assert!((axis.past(7).0 - 5.0).abs() < 1e-12);
    }
}
