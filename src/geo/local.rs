//! The simulator's local frame on WGS-84: metres east, north, up of home ↔ latitude, longitude, altitude.

use nalgebra::Vector3;

use crate::math;

/// The WGS-84 semi-major axis, m.
const SEMI_MAJOR: f64 = 6_378_137.0;
/// The WGS-84 flattening.
const FLATTENING: f64 = 1.0 / 298.257_223_563;

/// An ENU frame (metres) anchored at a home position. It uses the radii of curvature of the ellipsoid there, raised
/// by the altitude of home: meridian `a(1−e²)/(1−e²sin²φ)^1.5`, prime vertical `a/√(1−e²sin²φ)`. It is within 3 mm of
/// the exact tangent plane at 250 m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalFrame {
    /// Latitude of the origin, degrees.
    pub lat_deg: f64,
    /// Longitude of the origin, degrees.
    pub lon_deg: f64,
    /// Altitude of the origin above mean sea level, m.
    pub alt_amsl_m: f64,
    metres_per_deg_lat: f64,
    metres_per_deg_lon: f64,
}

impl LocalFrame {
    /// Returns the frame with its origin at the given latitude and longitude (degrees) and altitude (m above sea
    /// level).
    pub fn new(lat_deg: f64, lon_deg: f64, alt_amsl_m: f64) -> Self {
        let e2 = FLATTENING * (2.0 - FLATTENING);
        let (sin, cos) = math::sin_cos(lat_deg.to_radians());
        let w = 1.0 - e2 * sin * sin;
        let meridian = SEMI_MAJOR * (1.0 - e2) / (w * w.sqrt());
        let prime_vertical = SEMI_MAJOR / w.sqrt();
        Self {
            lat_deg,
            lon_deg,
            alt_amsl_m,
            metres_per_deg_lat: (meridian + alt_amsl_m).to_radians(),
            // Never zero, so that the inverse stays finite at a pole.
            metres_per_deg_lon: ((prime_vertical + alt_amsl_m) * cos.max(1e-9)).to_radians(),
        }
    }

    /// Returns the metres in a degree of latitude and in a degree of longitude.
    pub fn metres_per_deg(&self) -> (f64, f64) {
        (self.metres_per_deg_lat, self.metres_per_deg_lon)
    }

    /// Returns latitude (deg, ±90), longitude (deg, −180…180) and altitude (m AMSL) of a point given in metres east,
    /// north, up.
    pub fn to_geodetic(&self, enu: Vector3<f64>) -> (f64, f64, f64) {
        let lat = (self.lat_deg + enu.y / self.metres_per_deg_lat).clamp(-90.0, 90.0);
        let mut lon = self.lon_deg + enu.x / self.metres_per_deg_lon;
        if !(-180.0..=180.0).contains(&lon) {
            lon = (lon + 180.0).rem_euclid(360.0) - 180.0;
        }
        (lat, lon, self.alt_amsl_m + enu.z)
    }

    /// Returns metres east, north, up of a point given by latitude (deg), longitude (deg) and altitude (m AMSL).
    pub fn to_enu(&self, lat_deg: f64, lon_deg: f64, alt_amsl_m: f64) -> Vector3<f64> {
        let mut dlon = lon_deg - self.lon_deg;
        if dlon > 180.0 {
            dlon -= 360.0;
        } else if dlon <= -180.0 {
            dlon += 360.0;
        }
        Vector3::new(
            dlon * self.metres_per_deg_lon,
            (lat_deg - self.lat_deg) * self.metres_per_deg_lat,
            alt_amsl_m - self.alt_amsl_m,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scale_at_the_default_home() {
        let frame = LocalFrame::new(40.4635, -79.5182, 0.0);
        assert!((frame.metres_per_deg_lat - 111_043.55).abs() < 0.01);
        assert!((frame.metres_per_deg_lon - 84_813.69).abs() < 0.01);
    }

    #[test]
    fn longitude_wraps_at_the_antimeridian() {
        let frame = LocalFrame::new(10.0, 179.9999, 0.0);
        let east = Vector3::new(100.0, 0.0, 0.0);
        let (lat, lon, alt) = frame.to_geodetic(east);
        assert!(lon < -179.9, "{lon}");
        assert!((frame.to_enu(lat, lon, alt) - east).norm() < 1e-6);
    }
}
