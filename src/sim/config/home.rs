//! The place of the craft at boot: `LAT,LON[,AMSL]`.

use std::str::FromStr;

use crate::sim::value_text::{ParseError, number_in};

use crate::sim::error::WorldError;

/// The place of the craft at boot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Home {
    /// Latitude, degrees.
    pub lat_deg: f64,
    /// Longitude, degrees.
    pub lon_deg: f64,
    /// Altitude of the ground above mean sea level, m.
    pub alt_amsl_m: f64,
    /// Heading of the nose, degrees clockwise from north.
    pub heading_deg: f64,
}

impl Default for Home {
    fn default() -> Self {
        Self { lat_deg: 40.4635, lon_deg: -79.5182, alt_amsl_m: 300.0, heading_deg: 0.0 }
    }
}

impl Home {
    /// The permitted altitudes of the ground, m above mean sea level.
    const ALTITUDE_M: (f64, f64) = (-500.0, 9000.0);

    pub(in crate::sim) fn check(&self) -> Result<(), WorldError> {
        let (low, high) = Self::ALTITUDE_M;
        for (name, value, min, max) in [
            ("latitude", self.lat_deg, -90.0, 90.0),
            ("longitude", self.lon_deg, -180.0, 180.0),
            ("altitude", self.alt_amsl_m, low, high),
            ("heading", self.heading_deg, -360.0, 360.0),
        ] {
            if !(min..=max).contains(&value) {
                return Err(WorldError::Home(name, value, min, max));
            }
        }
        Ok(())
    }
}

impl FromStr for Home {
    type Err = ParseError;

    /// Reads `LAT,LON[,AMSL]`: degrees, degrees, metres above sea level (300 if left out). The craft faces north.
    fn from_str(text: &str) -> Result<Self, ParseError> {
        let error = |problem: String| {
            ParseError::new(
                "home",
                text,
                format!("{problem}; write LAT,LON[,AMSL], for example 40.4635,-79.5182,300"),
            )
        };
        let (low, high) = Self::ALTITUDE_M;
        let parts: Vec<&str> = text.split(',').collect();
        let (lat, lon, alt) = match parts[..] {
            [lat, lon] => (lat, lon, None),
            [lat, lon, alt] => (lat, lon, Some(alt)),
            _ => return Err(error("a place has two or three numbers".to_owned())),
        };
        let default = Self::default();
        Ok(Self {
            lat_deg: number_in("latitude", lat, -90.0, 90.0).map_err(error)?,
            lon_deg: number_in("longitude", lon, -180.0, 180.0).map_err(error)?,
            alt_amsl_m: match alt {
                Some(alt) => number_in("altitude", alt, low, high).map_err(error)?,
                None => default.alt_amsl_m,
            },
            heading_deg: default.heading_deg,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn home_reads_two_or_three_numbers() {
        let home: Home = "-27.5,153.0,30".parse().unwrap();
        assert_eq!((home.lat_deg, home.lon_deg, home.alt_amsl_m), (-27.5, 153.0, 30.0));
        assert_eq!("1,2".parse::<Home>().unwrap().alt_amsl_m, 300.0);
        let error = "91,2".parse::<Home>().unwrap_err().to_string();
        assert!(error.contains("latitude 91 is out of range; allowed are -90 to 90"), "{error}");
    }
}
