//! The distance of a craft from the figure that it should fly.

use nalgebra::Vector2;

/// The figure of a hold around its waypoint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Pattern {
    Point,
    /// A circle of this radius, m.
    Orbit(f64),
    /// Two circles of this radius that touch at the waypoint, their centres west and east of it, m.
    Figure8(f64),
}

impl Pattern {
    /// Returns the distance of a place (north and east of the waypoint, m) from the figure, m.
    pub(super) fn error_m(self, offset_ne: Vector2<f64>) -> f64 {
        match self {
            Self::Point => offset_ne.norm(),
            Self::Orbit(radius) => (offset_ne.norm() - radius).abs(),
            Self::Figure8(radius) => {
                let circle = |side: f64| (relative(offset_ne, side * radius) - radius).abs();
                circle(-1.0).min(circle(1.0))
            }
        }
    }

    /// Returns the distance of a place outside the area that the figure encloses, m. For the point it is the distance
    /// from it.
    pub(super) fn outside_m(self, offset_ne: Vector2<f64>) -> f64 {
        match self {
            Self::Point => offset_ne.norm(),
            Self::Orbit(radius) => (offset_ne.norm() - radius).max(0.0),
            Self::Figure8(radius) => {
                let disc = |side: f64| (relative(offset_ne, side * radius) - radius).max(0.0);
                disc(-1.0).min(disc(1.0))
            }
        }
    }

    /// Returns the distance from the waypoint to the figure, m.
    pub(super) fn entry_m(self) -> f64 {
        match self {
            Self::Point => 0.0,
            Self::Orbit(radius) | Self::Figure8(radius) => radius,
        }
    }
}

fn relative(offset_ne: Vector2<f64>, east_m: f64) -> f64 {
    (offset_ne - Vector2::new(0.0, east_m)).norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_measured_from_the_figure() {
        let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
        let at = |n, e| Vector2::new(n, e);
        assert!(near(Pattern::Point.error_m(at(3.0, 4.0)), 5.0));
        let orbit = Pattern::Orbit(10.0);
        assert!(near(orbit.error_m(at(0.0, 7.0)), 3.0) && near(orbit.outside_m(at(0.0, 7.0)), 0.0));
        assert!(near(orbit.error_m(at(0.0, 17.0)), 7.0) && near(orbit.outside_m(at(0.0, 17.0)), 7.0));
        let eight = Pattern::Figure8(10.0);
        assert!(near(eight.error_m(at(0.0, 0.0)), 0.0), "it passes the waypoint");
        assert!(near(eight.error_m(at(10.0, -10.0)), 0.0) && near(eight.error_m(at(0.0, 20.0)), 0.0));
        assert!(near(eight.error_m(at(0.0, 10.0)), 10.0) && near(eight.outside_m(at(0.0, 10.0)), 0.0));
        assert!(near(eight.outside_m(at(0.0, 25.0)), 5.0));
    }
}
