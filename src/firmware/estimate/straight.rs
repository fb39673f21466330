//! Straight flight: the course over ground of a craft that keeps it for a while.

use nalgebra::Vector2;

use crate::geo::wrap_pi;
use crate::math;

/// The time for which the flight must be straight, s.
const LENGTH_S: f64 = 3.0;
/// The largest change of the course meanwhile, rad.
const WIDTH: f64 = 20.0 * std::f64::consts::PI / 180.0;

/// A stretch of straight flight.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct StraightFlight {
    /// The course at its start, rad clockwise from north, and its length so far, s.
    stretch: Option<(f64, f64)>,
}

impl StraightFlight {
    /// Takes a velocity over ground (north, east), `dt` seconds after the one before. Returns the course, rad clockwise
    /// from north, once the craft has kept it for three seconds at more than `min_mps`.
    pub(super) fn update(&mut self, velocity: Vector2<f64>, min_mps: f64, dt: f64) -> Option<f64> {
        if velocity.norm() <= min_mps {
            self.stretch = None;
            return None;
        }
        let course = math::atan2(velocity.y, velocity.x);
        let (begin, length_s) = match self.stretch {
            Some((begin, length_s)) if wrap_pi(course - begin).abs() < WIDTH => (begin, length_s + dt),
            _ => (course, 0.0),
        };
        self.stretch = Some((begin, length_s));
        (length_s >= LENGTH_S).then_some(course)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_seconds_straight_and_fast_enough_give_a_course() {
        let east = |speed| Vector2::new(0.0, speed);
        let mut flight = StraightFlight::default();
        let mut after = |velocity, seconds: u32| {
            (0..seconds * 10).filter_map(|_| flight.update(velocity, 3.0, 0.1)).next()
        };
        assert_eq!(after(east(2.9), 10), None);
        assert_eq!(after(east(4.0), 2), None);
        assert_eq!(after(Vector2::new(4.0, 0.0), 2), None, "a turn begins a new stretch");
        assert!(after(Vector2::new(4.0, 0.0), 2).is_some_and(|course| course.abs() < 1e-9));
    }
}
