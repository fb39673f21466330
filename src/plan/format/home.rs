//! The place of the craft at boot.

use std::fmt;
use std::str::FromStr;

use super::loss::{Finding, LossReport, Place, Severity};
use super::{bounds, field};
use crate::geo::LatLon;

/// A start position: `LAT,LON` or `LAT,LON,AMSL`.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(into = "String", try_from = "String")]
pub struct HomePosition {
    /// The place.
    pub position: LatLon,
    /// Altitude above mean sea level, m, if given.
    pub amsl_m: Option<f64>,
}

/// The reason why a text is not a home position.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum HomeError {
    /// Not two or three values.
    #[error("{0} is not a place: write LAT,LON or LAT,LON,AMSL, such as 40.4635,-79.5182,300")]
    Shape(String),
    /// A value is wrong.
    #[error("{message}; {hint}")]
    Value {
        /// The problem, as a sentence without its full stop.
        message: String,
        /// The replacement, for the message.
        hint: String,
    },
}

/// The lowest and the highest home above mean sea level, m: the troposphere range of the atmosphere model.
const AMSL_RANGE_M: std::ops::RangeInclusive<f64> = -500.0..=9000.0;

/// Reads an altitude above mean sea level.
pub(super) fn amsl_m(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if AMSL_RANGE_M.contains(&value) => Ok(value),
        Ok(value) if value.is_finite() => Err(format!("altitude {text} is out of range")),
        _ => Err(format!("altitude {text} is not a number")),
    }
}

/// Returns the home of a file of another program. A value that no home has is left out with a finding: the plan does
/// not depend on it.
pub(super) fn of_file(
    lat_deg: f64,
    lon_deg: f64,
    amsl_m: Option<f64>,
    place: Option<&Place>,
    losses: &mut LossReport,
) -> Option<HomePosition> {
    let mut leave_out = |field: &str, message: &str, from: String| {
        let why = format!("{message}: add --home LAT,LON,AMSL");
        let finding = Finding { place: place.cloned(), ..Finding::new(Severity::Lost, field, why) };
        losses.add(finding.values(from, "unknown"));
    };
    let position = match bounds::position(lat_deg, lon_deg) {
        Ok((position, _)) => position,
        Err(message) => {
            leave_out("home", &message, format!("{lat_deg},{lon_deg}"));
            return None;
        }
    };
    let kept = amsl_m.filter(|metres| AMSL_RANGE_M.contains(metres));
    if let (Some(metres), None) = (amsl_m, kept) {
        leave_out("home altitude", AMSL_HINT, format!("{metres} m"));
    }
    Some(HomePosition { position, amsl_m: kept })
}

/// The values that [`amsl_m`] accepts.
pub(super) const AMSL_HINT: &str = "allowed: -500 to 9000 m above mean sea level";

impl FromStr for HomePosition {
    type Err = HomeError;

    fn from_str(text: &str) -> Result<Self, HomeError> {
        let parts: Vec<&str> = text.split(',').map(str::trim).collect();
        let value = |error: field::FieldError| HomeError::Value { message: error.message, hint: error.hint };
        let (lat, lon, amsl) = match parts[..] {
            [lat, lon] => (lat, lon, None),
            [lat, lon, amsl] => (lat, lon, Some(amsl)),
            _ => return Err(HomeError::Shape(text.to_owned())),
        };
        let amsl_m = amsl
            .map(|text| {
                amsl_m(text).map_err(|message| HomeError::Value { message, hint: AMSL_HINT.to_owned() })
            })
            .transpose()?;
        let position =
            LatLon::new(field::latitude(lat).map_err(value)?, field::longitude(lon).map_err(value)?);
        Ok(Self { position, amsl_m })
    }
}

impl TryFrom<String> for HomePosition {
    type Error = HomeError;

    fn try_from(text: String) -> Result<Self, HomeError> {
        text.parse()
    }
}

impl From<HomePosition> for String {
    fn from(home: HomePosition) -> Self {
        home.to_string()
    }
}

impl fmt::Display for HomePosition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.position)?;
        self.amsl_m.map_or(Ok(()), |amsl| write!(f, ",{amsl}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn homes_read_and_print() {
        let home: HomePosition = "40.4635,-79.5182,300".parse().unwrap();
        assert_eq!(home.to_string(), "40.4635000,-79.5182000,300");
        assert_eq!("1,2".parse::<HomePosition>().unwrap().amsl_m, None);
        assert_eq!(field::degrees_e7("40.4635"), Some(home.position.lat_e7));
    }

    #[test]
    fn wrong_homes_say_why() {
        let say = |text: &str| text.parse::<HomePosition>().unwrap_err().to_string();
        assert!(say("40.4").contains("write LAT,LON or LAT,LON,AMSL"));
        assert!(say("95,2").starts_with("latitude 95 is out of range; allowed: -90"));
        assert!(say("5,2,x").starts_with("altitude x is not a number"));
        assert!(say("5,2,nan").starts_with("altitude nan is not a number"));
        assert!(say("5,2,99999").contains("out of range"));
    }
}
