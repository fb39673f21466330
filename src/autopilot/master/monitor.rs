//! Notices a mission that makes no progress, flies away, or flies by a wrong heading.

use crate::geo::wrap_pi;

/// Coming nearer by this much is progress, m.
const PROGRESS_M: f64 = 2.0;
/// The time without progress after which the mission is given up, s.
pub(super) const STALLED_S: f64 = 30.0;
/// The margin beyond the least distance at which the craft flies away: a share of the first distance, within limits, m.
const AWAY_SHARE: f64 = 0.25;
const AWAY_M: [f64; 2] = [20.0, 100.0];
/// A course that differs from the nose by more than this, degrees, while the nose points at the target within so many
/// degrees, above this speed, m/s, is a sign of a wrong heading.
const COURSE_OFF_DEG: f64 = 70.0;
const NOSE_ON_DEG: f64 = 30.0;
const FAST_MPS: f64 = 3.0;
/// The signs last this long, s. They are forgotten twice as fast.
const WRONG_S: f64 = 2.0;

/// A value and its limit, for guards.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Margin {
    pub(super) value: f64,
    pub(super) limit: f64,
}

/// Watches the distance to a target.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Progress {
    /// The distance at the begin, and the least one since, m.
    first_m: f64,
    least_m: f64,
    /// The least distance that counted as progress, m, and the time since then, s.
    progress_m: f64,
    without_s: f64,
    /// The distance of the last update, m.
    distance_m: f64,
}

impl Progress {
    /// Begins at this distance.
    pub(super) fn new(distance_m: f64) -> Self {
        Self { first_m: distance_m, least_m: distance_m, progress_m: distance_m, without_s: 0.0, distance_m }
    }

    /// Takes the distance after `dt` seconds. Returns the time without progress, s, and the distance, m, with their limits.
    pub(super) fn follow(&mut self, distance_m: f64, dt: f64) -> [Margin; 2] {
        self.least_m = self.least_m.min(distance_m);
        if distance_m <= self.progress_m - PROGRESS_M {
            (self.progress_m, self.without_s) = (distance_m, 0.0);
        } else {
            self.without_s += dt;
        }
        self.distance_m = distance_m;
        self.margins()
    }

    /// Returns the time without progress, s, and the distance, m, with their limits.
    pub(super) fn margins(&self) -> [Margin; 2] {
        let margin_m = (AWAY_SHARE * self.first_m).clamp(AWAY_M[0], AWAY_M[1]);
        [
            Margin { value: self.without_s, limit: STALLED_S },
            Margin { value: self.distance_m, limit: self.least_m + margin_m },
        ]
    }
}

/// Angles of a craft on its way, rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Angles {
    pub(super) heading_rad: f64,
    pub(super) course_rad: f64,
    pub(super) bearing_rad: f64,
}

/// Watches a nose that should point along the course.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct HeadingCheck {
    wrong_s: f64,
}

impl HeadingCheck {
    /// Takes the motion after `dt` seconds; `None` while the nose is not expected to point along the course. Returns the time
    /// of the signs, s, with its limit.
    pub(super) fn follow(&mut self, angles: Option<&Angles>, speed_mps: f64, dt: f64) -> Margin {
        let off_deg = |a: f64, b: f64| wrap_pi(a - b).abs().to_degrees();
        let is_wrong = speed_mps > FAST_MPS
            && angles.is_some_and(|angles| {
                off_deg(angles.heading_rad, angles.bearing_rad) <= NOSE_ON_DEG
                    && off_deg(angles.course_rad, angles.heading_rad) > COURSE_OFF_DEG
            });
        self.wrong_s = (self.wrong_s + if is_wrong { dt } else { -2.0 * dt }).max(0.0);
        self.margin()
    }

    /// Returns the time of the signs, s, with its limit.
    pub(super) fn margin(&self) -> Margin {
        Margin { value: self.wrong_s, limit: WRONG_S }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_craft_that_does_not_come_nearer_is_stalled_and_two_metres_are_progress() {
        let mut progress = Progress::new(100.0);
        let waited = (0..290).map(|_| progress.follow(98.5, 0.1)[0].value).last().unwrap();
        assert!((waited - 29.0).abs() < 1e-6);
        assert_eq!(progress.follow(98.0, 0.1)[0].value, 0.0);
    }

    #[test]
    fn flying_away_counts_from_the_least_distance() {
        let limit = |first_m: f64| Progress::new(first_m).follow(first_m - 30.0, 0.01)[1].limit;
        assert_eq!(limit(100.0), 70.0 + 25.0);
        assert_eq!(limit(40.0), 10.0 + 20.0);
        assert_eq!(limit(1000.0), 970.0 + 100.0);
    }

    #[test]
    fn a_course_across_the_nose_counts_up_and_is_forgotten_twice_as_fast() {
        let mut check = HeadingCheck::default();
        let across = Angles { heading_rad: 0.0, course_rad: 1.5, bearing_rad: 0.2 };
        assert!((check.follow(Some(&across), 5.0, 1.0).value - 1.0).abs() < 1e-9);
        assert!((check.follow(Some(&across), 2.0, 0.25).value - 0.5).abs() < 1e-9, "too slow to tell");
        assert!((check.follow(None, 5.0, 0.25).value).abs() < 1e-9);
        let beside = Angles { bearing_rad: 1.0, ..across };
        assert_eq!(check.follow(Some(&beside), 5.0, 1.0).value, 0.0, "the nose is not on the target");
    }
}
