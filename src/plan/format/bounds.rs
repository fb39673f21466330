//! Bounds for the files of other programs, and the values that they share.

use super::HomePosition;
use super::loss::{Finding, Severity};
use crate::geo::LatLon;
use crate::plan::Altitude;

/// The most items that are read of a file.
pub(super) const MAX_ITEMS: usize = 10_000;
/// The deepest nesting of elements.
pub(super) const MAX_DEPTH: usize = 64;
/// The most attributes of an element.
pub(super) const MAX_ATTRIBUTES: usize = 64;
/// The largest altitude of a file, m, up and down.
const MAX_ALTITUDE_M: f64 = 20_000.0;

/// Returns a position in degrees as a position of a plan. A longitude up to ±360° is wrapped; the second value is
/// `true` then.
///
/// # Errors
///
/// Returns the reason, with the value and the range.
pub(super) fn position(lat_deg: f64, lon_deg: f64) -> Result<(LatLon, bool), String> {
    if !(-90.0..=90.0).contains(&lat_deg) {
        return Err(format!("latitude {lat_deg} is out of range, allowed: -90 to 90"));
    }
    if !(-360.0..=360.0).contains(&lon_deg) {
        return Err(format!("longitude {lon_deg} is out of range, allowed: -180 to 180"));
    }
    let wrapped = match lon_deg {
        lon if lon > 180.0 => lon - 360.0,
        lon if lon < -180.0 => lon + 360.0,
        lon => lon,
    };
    Ok((LatLon::from_degrees(lat_deg, wrapped), wrapped.to_bits() != lon_deg.to_bits()))
}

/// Checks an altitude in metres.
///
/// # Errors
///
/// Returns the reason, with the value and the range.
pub(super) fn altitude_m(metres: f64) -> Result<f64, String> {
    if (-MAX_ALTITUDE_M..=MAX_ALTITUDE_M).contains(&metres) {
        Ok(metres)
    } else {
        Err(format!("altitude {metres} is out of range, allowed: -20000 to 20000 m"))
    }
}

/// The reference of an altitude.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reference {
    Home,
    SeaLevel,
    Ground,
}

impl Reference {
    /// Returns an altitude of this reference above home. A value above ground is taken as one above home with a
    /// finding, without one if the user says that the ground is flat.
    ///
    /// # Errors
    ///
    /// Returns the reason: the value is out of range, or the altitude of the home above sea level is unknown.
    pub(super) fn above_home(
        self,
        metres: f64,
        home: Option<HomePosition>,
        flat: bool,
    ) -> Result<(Altitude, Option<Finding>), String> {
        let metres = altitude_m(metres)?;
        match self {
            Self::Home => Ok((Altitude::above_home(metres), None)),
            Self::SeaLevel => {
                let home_m = home.and_then(|home| home.amsl_m).ok_or_else(|| {
                    format!(
                        "altitude {metres} m is above sea level, and the altitude of the home is unknown: \
                         add --home LAT,LON,AMSL"
                    )
                })?;
                let above_m = metres - home_m;
                let shown = |metres: f64| (metres * 100.0).round() / 100.0;
                let finding =
                    Finding::new(Severity::Info, "altitude reference", "altitudes of a plan are above home");
                let values = finding.values(
                    format!("{} m above sea level", shown(metres)),
                    format!("{} m above home", shown(above_m)),
                );
                Ok((Altitude::above_home(above_m), Some(values)))
            }
            Self::Ground if flat => Ok((Altitude::above_home(metres), None)),
            Self::Ground => {
                let finding = Finding::new(
                    Severity::Assumed,
                    "altitude reference",
                    "altitudes above ground are taken as above home, which is right on flat ground only",
                );
                Ok((Altitude::above_home(metres), Some(finding.values("above ground", "above home"))))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_have_bounds() {
        assert_eq!(position(-90.0, 180.0), Ok((LatLon::new(-900_000_000, 1_800_000_000), false)));
        assert_eq!(position(1.0, 359.0), Ok((LatLon::new(10_000_000, -10_000_000), true)));
        assert_eq!(position(91.0, 0.0).unwrap_err(), "latitude 91 is out of range, allowed: -90 to 90");
        for (lat, lon) in [(f64::NAN, 0.0), (0.0, f64::NAN), (0.0, f64::INFINITY), (0.0, -361.0)] {
            assert!(position(lat, lon).is_err(), "{lat} {lon}");
        }
    }

    #[test]
    fn altitudes_have_a_reference() {
        let home: HomePosition = "1,2,300".parse().unwrap();
        let above = |reference: Reference, home| reference.above_home(350.5, home, false);
        assert_eq!(above(Reference::SeaLevel, Some(home)).unwrap().0, Altitude::above_home(50.5));
        assert!(above(Reference::SeaLevel, None).unwrap_err().contains("add --home LAT,LON,AMSL"));
        assert_eq!(above(Reference::Home, None), Ok((Altitude::above_home(350.5), None)));
        let (altitude, finding) = above(Reference::Ground, None).unwrap();
        assert_eq!(altitude, Altitude::above_home(350.5));
        assert_eq!(finding.unwrap().severity, Severity::Assumed);
        assert_eq!(Reference::Ground.above_home(1.0, None, true).unwrap().1, None);
        assert!(altitude_m(f64::NAN).unwrap_err().contains("altitude NaN is out of range"));
    }
}
