//! A path that never grows beyond a bound: when it is full, every second point is dropped and the spacing doubles.

/// A point in space.
pub trait Located {
    /// Returns the distance to another point, m.
    fn distance_m(&self, other: &Self) -> f64;
}

/// The points of a path, at least a spacing apart.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundedPath<P> {
    points: Vec<P>,
    most: usize,
    spacing_m: f64,
}

impl<P: Located> BoundedPath<P> {
    /// Returns an empty path of at most this many points, with this spacing until it is full, m.
    pub fn new(most: usize, spacing_m: f64) -> Self {
        Self { points: Vec::new(), most: most.max(2), spacing_m }
    }

    /// Appends a point unless it is nearer to the last one than the spacing.
    pub fn push(&mut self, point: P) {
        if self.points.last().is_none_or(|last| last.distance_m(&point) >= self.spacing_m) {
            self.append(point);
        }
    }

    /// Appends a point, even if it is near the last one.
    pub fn append(&mut self, point: P) {
        if self.points.len() == self.most {
            let mut keep = false;
            self.points.retain(|_| {
                keep = !keep;
                keep
            });
            self.spacing_m *= 2.0;
        }
        self.points.push(point);
    }

    /// Removes the points from this index on, and returns them.
    pub fn split_off(&mut self, at: usize) -> Vec<P> {
        self.points.split_off(at.min(self.points.len()))
    }

    /// Returns the points, the oldest first.
    pub fn points(&self) -> &[P] {
        &self.points
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    impl Located for f64 {
        fn distance_m(&self, other: &Self) -> f64 {
            (self - other).abs()
        }
    }

    #[test]
    fn a_long_path_stays_bounded_and_keeps_its_start() {
        let mut path = BoundedPath::new(100, 0.5);
        (0..10_000).for_each(|step| path.push(f64::from(step)));
        assert!(path.points().len() <= 100);
        assert!(path.points().first().is_some_and(|first| first.abs() < 1e-9));
        assert!(path.points().windows(2).all(|pair| pair[1] > pair[0]), "in order");
        assert!(path.points().last().is_some_and(|last| *last > 9_800.0), "up to the end");
    }

    #[test]
    fn near_points_are_left_out_unless_they_are_appended() {
        let mut path = BoundedPath::new(10, 1.0);
        [0.0, 0.4, 0.8, 1.0].into_iter().for_each(|point| path.push(point));
        path.append(1.1);
        assert_eq!(path.points(), [0.0, 1.0, 1.1]);
        assert_eq!(path.split_off(1), [1.0, 1.1]);
        assert!(path.split_off(7).is_empty());
    }
}
