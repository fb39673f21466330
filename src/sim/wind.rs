//! The mean wind: `SPEED@FROM_DEG`.

use std::str::FromStr;

use nalgebra::Vector3;

use crate::math;
use crate::sim::value_text::{ParseError, number, number_in};

/// A steady horizontal wind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wind {
    /// Speed, m/s.
    pub speed_mps: f64,
    /// Direction that it blows from, degrees clockwise from north.
    pub from_deg: f64,
}

impl Wind {
    /// No wind.
    pub const CALM: Self = Self { speed_mps: 0.0, from_deg: 0.0 };

    /// The maximum wind, m/s.
    pub const MAX_MPS: f64 = 60.0;

    /// Returns the velocity of the air, ENU, m/s: the direction that the wind blows to.
    pub fn velocity_enu(&self) -> Vector3<f64> {
        let (east, north) = math::sin_cos(self.from_deg.to_radians());
        Vector3::new(-self.speed_mps * east, -self.speed_mps * north, 0.0)
    }
}

impl Default for Wind {
    fn default() -> Self {
        Self::CALM
    }
}

impl FromStr for Wind {
    type Err = ParseError;

    /// Reads `SPEED@FROM_DEG` or `calm`.
    fn from_str(text: &str) -> Result<Self, ParseError> {
        if text == "calm" {
            return Ok(Self::CALM);
        }
        let error = |problem: String| {
            ParseError::new(
                "wind",
                text,
                format!(
                    "{problem}; write SPEED@FROM, for example 5@270: 5 m/s blowing from the west, or calm"
                ),
            )
        };
        let (speed, from) =
            text.split_once('@').ok_or_else(|| error("the direction it blows from is missing".to_owned()))?;
        let speed_mps = number_in("speed", speed, 0.0, Self::MAX_MPS).map_err(error)?;
        let from_deg = number("direction", from).map_err(error)?.rem_euclid(360.0);
        Ok(Self { speed_mps, from_deg })
    }
}

impl std::fmt::Display for Wind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}@{}", self.speed_mps, self.from_deg)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wind_from_the_west_blows_east() {
        let wind: Wind = "5@270".parse().unwrap();
        assert!((wind.velocity_enu() - Vector3::new(5.0, 0.0, 0.0)).norm() < 1e-12);
        assert_eq!(wind.to_string(), "5@270");
        assert_eq!("calm".parse(), Ok(Wind::CALM));
        assert_eq!("3@-90".parse(), Ok(Wind { speed_mps: 3.0, from_deg: 270.0 }));
    }

    #[test]
    fn wind_errors_say_what_to_write() {
        for (text, part) in [
            ("5", "the direction it blows from is missing"),
            ("5@", "the direction is missing"),
            ("x@3", "speed x is not a number"),
            ("-1@3", "out of range; allowed are 0 to 60"),
            ("NaN@3", "not a number"),
            ("1@inf", "not a number"),
        ] {
            let error = text.parse::<Wind>().unwrap_err().to_string();
            assert!(error.contains(part) && error.contains("5@270"), "{error}");
        }
    }
}
