//! Positions on the earth, and the two local frames of the program.
//!
//! * [`LatLon`] is the exchange format of CLI, MSP and plans: degrees × 10⁷ as integers.
//! * The autopilot computes on a *flat earth* with one constant ([`METRES_PER_E7`]), like the firmware that it
//!   re-implements: [`distance_bearing`], [`local_offset`], [`offset_to_latlon`].
//! * The simulator places its world on WGS-84 by the radii of curvature at home: [`LocalFrame`].
//!
//! The two differ by up to 0.3 %. Compare truth with truth, never a truth distance with a firmware distance.

use nalgebra::Vector2;

use crate::math;

mod bounded_path;
mod ground_plane;
mod local;

pub use bounded_path::{BoundedPath, Located};
pub use ground_plane::GroundPlane;
pub use local::LocalFrame;

/// Metres per 1e-7 degree of latitude on the firmware's flat earth.
pub const METRES_PER_E7: f64 = 0.011_131_95;

/// Standard gravity, m/s².
pub const GRAVITY: f64 = 9.806_65;

/// A position in degrees × 10⁷, the resolution of plans, CLI and MSP (1.1 cm).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, serde::Serialize, serde::Deserialize)]
pub struct LatLon {
    /// Latitude, degrees × 10⁷, north positive, ±900 000 000.
    pub lat_e7: i32,
    /// Longitude, degrees × 10⁷, east positive, ±1 800 000 000.
    pub lon_e7: i32,
}

impl LatLon {
    /// Returns a position from degrees × 10⁷.
    pub const fn new(lat_e7: i32, lon_e7: i32) -> Self {
        Self { lat_e7, lon_e7 }
    }

    /// Returns a position from degrees, rounded to the nearest 1e-7. Out-of-range values saturate.
    pub fn from_degrees(lat_deg: f64, lon_deg: f64) -> Self {
        Self { lat_e7: (lat_deg * 1e7).round() as i32, lon_e7: (lon_deg * 1e7).round() as i32 }
    }

    /// Returns the latitude, degrees north.
    pub fn lat_deg(self) -> f64 {
        f64::from(self.lat_e7) * 1e-7
    }

    /// Returns the longitude, degrees east.
    pub fn lon_deg(self) -> f64 {
        f64::from(self.lon_e7) * 1e-7
    }

    /// Returns `true` if latitude and longitude are on the globe.
    pub fn is_on_globe(self) -> bool {
        self.lat_e7.unsigned_abs() <= 900_000_000 && self.lon_e7.unsigned_abs() <= 1_800_000_000
    }
}

/// Writes decimal degrees with exactly seven decimals, computed on the integers: `40.4640000,-79.5175000`.
impl std::fmt::Display for LatLon {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{},{}", Degrees7(self.lat_e7), Degrees7(self.lon_e7))
    }
}

/// One coordinate in degrees × 10⁷, displayed with exactly seven decimals.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Degrees7(pub i32);

impl std::fmt::Display for Degrees7 {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let sign = if self.0 < 0 { "-" } else { "" };
        let size = self.0.unsigned_abs();
        write!(f, "{sign}{}.{:07}", size / 10_000_000, size % 10_000_000)
    }
}

/// Returns `lon` wrapped to (−180°, +180°], degrees × 10⁷.
fn wrap_lon_e7(lon: i64) -> i32 {
    let turn = 3_600_000_000_i64;
    let folded = lon.rem_euclid(turn);
    // In range by construction: (−1.8e9, 1.8e9] fits `i32`.
    (if folded > turn / 2 { folded - turn } else { folded }) as i32
}

/// Returns the horizontal distance (m) and bearing (rad, 0…2π clockwise from north) from `a` to `b`. The reference
/// latitude is their mean, so the distance is symmetric. Coincident points give (0, 0).
pub fn distance_bearing(a: LatLon, b: LatLon) -> (f64, f64) {
    let mean_lat = (f64::from(a.lat_e7) + f64::from(b.lat_e7)) * 0.5e-7;
    let ne = offset_with_reference(a, b, mean_lat);
    if ne.x == 0.0 && ne.y == 0.0 {
        return (0.0, 0.0);
    }
    (ne.norm(), math::atan2(ne.y, ne.x).rem_euclid(std::f64::consts::TAU))
}

/// Returns the offset (north, east) in metres from `origin` to `point`. The reference latitude is that of the origin.
pub fn local_offset(origin: LatLon, point: LatLon) -> Vector2<f64> {
    offset_with_reference(origin, point, origin.lat_deg())
}

fn offset_with_reference(from: LatLon, to: LatLon, reference_lat_deg: f64) -> Vector2<f64> {
    let dlat = i64::from(to.lat_e7) - i64::from(from.lat_e7);
    let dlon = wrap_lon_e7(i64::from(to.lon_e7) - i64::from(from.lon_e7));
    Vector2::new(
        dlat as f64 * METRES_PER_E7,
        f64::from(dlon) * METRES_PER_E7 * math::cos(reference_lat_deg.to_radians()),
    )
}

/// Returns the position at `offset_ne` (north, east; metres) from `origin`, the inverse of [`local_offset`]. Latitude
/// is clamped to ±90°, longitude wrapped. Within 1e-6 of a pole (cosine) the longitude stays that of the origin.
pub fn offset_to_latlon(origin: LatLon, offset_ne: Vector2<f64>) -> LatLon {
    let cos_lat = math::cos(origin.lat_deg().to_radians());
    let lat = f64::from(origin.lat_e7) + offset_ne.x / METRES_PER_E7;
    let lat_e7 = lat.round().clamp(-900_000_000.0, 900_000_000.0) as i32;
    if cos_lat < 1e-6 {
        return LatLon::new(lat_e7, origin.lon_e7);
    }
    let lon = f64::from(origin.lon_e7) + offset_ne.y / (METRES_PER_E7 * cos_lat);
    LatLon::new(lat_e7, wrap_lon_e7(lon.round() as i64))
}

/// Does the same as [`offset_to_latlon`] in degrees and without rounding to 1e-7, for displays that compare with the
/// truth.
pub fn offset_to_degrees(origin: LatLon, offset_ne: Vector2<f64>) -> (f64, f64) {
    let cos_lat = math::cos(origin.lat_deg().to_radians()).max(1e-6);
    let per_degree = METRES_PER_E7 * 1e7;
    (origin.lat_deg() + offset_ne.x / per_degree, origin.lon_deg() + offset_ne.y / (per_degree * cos_lat))
}

/// Returns an angle wrapped to (−π, π].
pub fn wrap_pi(angle_rad: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    let folded = angle_rad.rem_euclid(TAU);
    if folded > PI { folded - TAU } else { folded }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_print_exactly_seven_decimals() {
        assert_eq!(Degrees7(-5).to_string(), "-0.0000005");
        assert_eq!(LatLon::new(404_640_000, -795_175_000).to_string(), "40.4640000,-79.5175000");
    }

    #[test]
    fn offset_round_trips_across_the_antimeridian() {
        let origin = LatLon::new(100_000_000, 1_799_999_000);
        let east = offset_to_latlon(origin, Vector2::new(0.0, 200.0));
        assert!(east.lon_e7 < 0);
        assert!((local_offset(origin, east).y - 200.0).abs() < 0.02);
    }
}
