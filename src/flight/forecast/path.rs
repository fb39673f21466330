//! The path of a forecast: a polyline with a maximum number of points.

use crate::geo;
use crate::math;

/// The maximum number of points.
const MAX_POINTS: usize = 2048;
/// The initial spacing of points, m.
const SPACING_M: f64 = 0.5;

/// A point of the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathPoint {
    /// North of the boot place, m.
    pub n: f64,
    /// East of the boot place, m.
    pub e: f64,
    /// Above the boot place, m.
    pub alt: f64,
    /// Distance flown along the plan, m: legs from home, without holds and detours. It never decreases.
    pub along_m: f64,
    /// Simulated time since boot, s.
    pub time_s: f64,
}

impl geo::Located for PathPoint {
    fn distance_m(&self, other: &Self) -> f64 {
        math::hypot(math::hypot(self.n - other.n, self.e - other.e), self.alt - other.alt)
    }
}

/// The points so far.
#[derive(Debug, Clone)]
pub(super) struct Path {
    kept: geo::BoundedPath<PathPoint>,
    /// Newest place of the craft, which may be too near the last point to be kept.
    newest: PathPoint,
}

impl Path {
    /// Returns a path that begins here.
    pub(super) fn new(start: PathPoint) -> Self {
        let mut kept = geo::BoundedPath::new(MAX_POINTS, SPACING_M);
        kept.push(start);
        Self { kept, newest: start }
    }

    pub(super) fn push(&mut self, point: PathPoint) {
        self.newest = point;
        self.kept.push(point);
    }

    /// Returns the horizontal distance from the first to the newest point, m.
    pub(super) fn moved_m(&self) -> f64 {
        self.kept
            .points()
            .first()
            .map_or(0.0, |first| math::hypot(self.newest.n - first.n, self.newest.e - first.e))
    }

    /// Returns all points, with the end last.
    pub(super) fn points(&self) -> Vec<PathPoint> {
        let mut points = self.kept.points().to_vec();
        if points.last() != Some(&self.newest) {
            points.push(self.newest);
        }
        points
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_way_stays_bounded_and_keeps_both_ends() {
        let at = |step: i32| PathPoint { n: f64::from(step), e: 0.0, alt: 10.0, along_m: 0.0, time_s: 0.0 };
        let mut path = Path::new(at(0));
        for step in 1..50_000 {
            path.push(at(step));
        }
        let points = path.points();
        assert!(points.len() <= MAX_POINTS + 1, "{}", points.len());
        assert_eq!((points.first(), points.last()), (Some(&at(0)), Some(&at(49_999))));
        assert!((path.moved_m() - 49_999.0).abs() < 1e-9);
    }

    #[test]
    fn a_climb_on_the_spot_is_part_of_the_way() {
        let at = |alt| PathPoint { n: 0.0, e: 0.0, alt, along_m: 0.0, time_s: 0.0 };
        let mut path = Path::new(at(0.0));
        path.push(at(5.0));
        assert_eq!(path.points().len(), 2);
        assert!(path.moved_m() < 1e-9);
    }
}
