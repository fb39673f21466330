//! Metres north and east of a place on the sphere, exact both ways everywhere: across ±180° and at the poles.

use nalgebra::{Vector2, Vector3};

use super::{LatLon, METRES_PER_E7};
use crate::math;

/// The radius of the sphere on which [`super::distance_bearing`] measures, m.
const RADIUS_M: f64 = METRES_PER_E7 * 1e7 * 180.0 / std::f64::consts::PI;

/// The azimuthal equidistant projection around a place: distance and bearing from the place are true.
///
/// Source: Snyder, Map Projections (USGS 1395), §25.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundPlane {
    up: Vector3<f64>,
    north: Vector3<f64>,
    east: Vector3<f64>,
}

impl GroundPlane {
    /// Returns the plane that touches the sphere at `origin`.
    pub fn new(origin: LatLon) -> Self {
        let (lat, lon) = (origin.lat_deg().to_radians(), origin.lon_deg().to_radians());
        Self {
            up: direction(origin),
            north: Vector3::new(
                -math::sin(lat) * math::cos(lon),
                -math::sin(lat) * math::sin(lon),
                math::cos(lat),
            ),
            east: Vector3::new(-math::sin(lon), math::cos(lon), 0.0),
        }
    }

    /// Returns metres north (x) and east (y) of the origin.
    pub fn to_ne(&self, position: LatLon) -> Vector2<f64> {
        let point = direction(position);
        let across = Vector2::new(point.dot(&self.north), point.dot(&self.east));
        let sine = across.norm();
        let angle = math::atan2(sine, point.dot(&self.up));
        if sine < 1e-15 { Vector2::zeros() } else { across * (angle * RADIUS_M / sine) }
    }

    /// Returns the position `ne` metres north and east of the origin, rounded to 1e-7 degrees.
    pub fn to_position(&self, ne: Vector2<f64>) -> LatLon {
        let distance = ne.norm();
        if !(distance.is_finite() && distance > 0.0) {
            return at(self.up);
        }
        let (sine, cosine) = math::sin_cos(distance / RADIUS_M);
        at(self.up * cosine + (self.north * ne.x + self.east * ne.y) * (sine / distance))
    }
}

fn direction(position: LatLon) -> Vector3<f64> {
    let (lat, lon) = (position.lat_deg().to_radians(), position.lon_deg().to_radians());
    Vector3::new(math::cos(lat) * math::cos(lon), math::cos(lat) * math::sin(lon), math::sin(lat))
}

fn at(direction: Vector3<f64>) -> LatLon {
    let lat = math::atan2(direction.z, math::hypot(direction.x, direction.y));
    LatLon::from_degrees(lat.to_degrees(), math::atan2(direction.y, direction.x).to_degrees())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::distance_bearing;
    use proptest::prelude::*;

    #[test]
    fn a_step_over_the_pole_and_over_the_antimeridian_comes_out_on_the_other_side() {
        let pole =
            GroundPlane::new(LatLon::from_degrees(89.9995, 10.0)).to_position(Vector2::new(100.0, 0.0));
        assert!((pole.lon_deg() - -170.0).abs() < 1e-3 && pole.lat_deg() > 89.999, "{pole}");
        let east = GroundPlane::new(LatLon::from_degrees(0.0, 179.9999)).to_position(Vector2::new(0.0, 50.0));
        assert!(east.lon_deg() < -179.99, "{east}");
    }

    proptest! {
        #[test]
        fn there_and_back_is_the_same_place(
            lat in -90.0..=90.0_f64, lon in -180.0..=180.0_f64, n in -3000.0..3000.0_f64, e in -3000.0..3000.0_f64,
        ) {
            let plane = GroundPlane::new(LatLon::from_degrees(lat, lon));
            let there = plane.to_ne(plane.to_position(Vector2::new(n, e)));
            prop_assert!((there - Vector2::new(n, e)).norm() < 0.05, "{there}");
        }

        #[test]
        fn distances_are_those_of_the_autopilot(
            lat in -70.0..=70.0_f64, lon in -180.0..=180.0_f64, n in -300.0..300.0_f64, e in -300.0..300.0_f64,
        ) {
            let origin = LatLon::from_degrees(lat, lon);
            let position = GroundPlane::new(origin).to_position(Vector2::new(n, e));
            let (distance, _) = distance_bearing(origin, position);
            prop_assert!((distance - n.hypot(e)).abs() < 0.1, "{distance}");
        }
    }
}
