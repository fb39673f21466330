//! The shape of the ground: its height at a place, and its tangent plane there.

use nalgebra::{Vector2, Vector3};

use super::value_text::number;
use crate::math;

/// The steepest ground, m in 100 m. A craft does not slide on it and may arm.
pub(super) const MAX_RISE_M: f64 = 40.0;

/// The shape of the ground. Home is on it, at height zero.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Surface {
    /// Level ground at height zero.
    #[default]
    Flat,
    /// A plane through home.
    Slope(Slope),
    /// The relief of elevation tiles.
    Terrain,
}

/// A plane through home that rises towards a bearing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slope {
    rise_m: f64,
    bearing_deg: f64,
    /// Rise in metres per metre east and north.
    gradient: Vector2<f64>,
    normal: Vector3<f64>,
}

/// The tangent plane of the ground at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TangentPlane {
    /// A point of the plane, ENU, m.
    point: Vector3<f64>,
    /// Unit vector that points up from it.
    normal: Vector3<f64>,
}

impl Slope {
    /// Returns a plane that rises by `rise_m` in 100 m towards `bearing_deg`, degrees from north.
    pub fn new(rise_m: f64, bearing_deg: f64) -> Self {
        let (sin, cos) = math::sin_cos(bearing_deg.to_radians());
        let gradient = Vector2::new(sin, cos) * (rise_m / 100.0);
        let normal = Vector3::new(-gradient.x, -gradient.y, 1.0).normalize();
        Self { rise_m, bearing_deg, gradient, normal }
    }
}

impl Surface {
    /// Reads `flat`, `slope,RISE,BEARING` or `terrain`.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let parts: Vec<&str> = text.split(',').map(str::trim).collect();
        match parts[..] {
            ["flat"] => Ok(Self::Flat),
            ["terrain"] => Ok(Self::Terrain),
            ["slope", rise, bearing] => {
                let (rise_m, bearing_deg) = (number("rise", rise)?, number("bearing", bearing)?);
                if !(0.0..=MAX_RISE_M).contains(&rise_m) {
                    return Err(format!("the rise {rise} is out of range"));
                }
                if !(0.0..=360.0).contains(&bearing_deg) {
                    return Err(format!("the bearing {bearing} is out of range"));
                }
                Ok(Self::Slope(Slope::new(rise_m, bearing_deg)))
            }
            ["slope", ..] => Err("a slope has a rise and a bearing, such as slope,8,90".to_owned()),
            _ => Err(format!("{text} is no shape of the ground")),
        }
    }

    /// Returns the height of the ground at a place east and north of home, m; that of tiles is not known here.
    pub fn elevation_m(&self, place: &Vector2<f64>) -> f64 {
        match self {
            Self::Flat | Self::Terrain => 0.0,
            Self::Slope(slope) => slope.gradient.dot(place),
        }
    }

    /// Returns the tangent plane of the ground below or above a point. It is exact for every point where the ground
    /// is a plane.
    pub fn tangent_at(&self, _point: &Vector3<f64>) -> TangentPlane {
        let normal = match self {
            Self::Flat | Self::Terrain => Vector3::z(),
            Self::Slope(slope) => slope.normal,
        };
        TangentPlane { point: Vector3::zeros(), normal }
    }

    /// Returns rise and bearing, for a check that [`Self::parse`] would take them.
    pub(super) fn numbers(&self) -> (f64, f64) {
        match self {
            Self::Flat | Self::Terrain => (0.0, 0.0),
            Self::Slope(slope) => (slope.rise_m, slope.bearing_deg),
        }
    }
}

impl std::fmt::Display for Surface {
    /// Writes the form of the switch `ground`.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Flat => f.write_str("flat"),
            Self::Terrain => f.write_str("terrain"),
            Self::Slope(slope) => write!(f, "slope,{},{}", slope.rise_m, slope.bearing_deg),
        }
    }
}

impl TangentPlane {
    /// Returns the plane through a point that rises by `gradient` metres in a metre east and north.
    pub(super) fn new(point: Vector3<f64>, gradient: &Vector2<f64>) -> Self {
        Self { point, normal: Vector3::new(-gradient.x, -gradient.y, 1.0).normalize() }
    }

    /// Returns the unit vector that points up from the plane.
    pub fn normal(&self) -> &Vector3<f64> {
        &self.normal
    }

    /// Returns the distance of a point from the plane, negative below it, m.
    pub fn distance_m(&self, point: &Vector3<f64>) -> f64 {
        (point - self.point).dot(&self.normal)
    }

    /// Returns the part of a vector that is in the plane.
    pub fn along(&self, vector: &Vector3<f64>) -> Vector3<f64> {
        vector - self.normal * vector.dot(&self.normal)
    }

    /// Returns the point of the plane at a place east and north of home.
    pub fn point_at(&self, place: &Vector2<f64>) -> Vector3<f64> {
        let from = place - self.point.xy();
        let up = self.point.z - self.normal.xy().dot(&from) / self.normal.z;
        Vector3::new(place.x, place.y, up)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slope_rises_towards_its_bearing_and_falls_the_other_way() {
        let ground = Surface::parse("slope, 8, 90").unwrap();
        assert_eq!(ground.to_string(), "slope,8,90");
        for (east, north, up) in [(100.0, 0.0, 8.0), (-50.0, 0.0, -4.0), (0.0, 100.0, 0.0)] {
            let place = Vector2::new(east, north);
            assert!((ground.elevation_m(&place) - up).abs() < 1e-9);
            let plane = ground.tangent_at(&Vector3::new(east, north, 0.0));
            assert!((plane.point_at(&place).z - up).abs() < 1e-9);
            assert!(plane.distance_m(&plane.point_at(&place)).abs() < 1e-9);
        }
    }

    #[test]
    fn an_impossible_ground_is_refused_in_words() {
        for (text, words) in [
            ("hill", "no shape"),
            ("slope", "slope,8,90"),
            ("slope,8", "slope,8,90"),
            ("slope,8,90,1", "slope,8,90"),
            ("slope,41,90", "the rise 41 is out of range"),
            ("slope,-1,90", "the rise -1 is out of range"),
            ("slope,8,361", "the bearing 361 is out of range"),
            ("slope,x,90", "not a number"),
            ("slope,nan,90", ""),
        ] {
            let error = Surface::parse(text).unwrap_err();
            assert!(error.contains(words), "{text}: {error}");
        }
    }
}
