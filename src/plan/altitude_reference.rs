//! The reference of a craft for the altitudes of its waypoints. Plans in betadeck use home.

use super::quantity::to_cm;
use super::{FlightPlan, WaypointType};
use crate::plan::record::Records;

/// The reference of a craft for the altitudes of its waypoints.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum AltitudeReference {
    /// The craft has not reported it yet.
    #[default]
    Unreported,
    /// Altitudes count from home.
    Home,
    /// Altitudes count from mean sea level.
    SeaLevel {
        /// The altitude of home above sea level, m; `None` while it is unknown.
        home_m: Option<f64>,
    },
}

/// The durations of a HOLD that never ends and of the shortest one, ds.
const NO_END: u16 = 0;
const SHORTEST: u16 = 1;
/// The duration of a HOLD that ends at once, and the longest one, on firmware whose altitudes count from sea level, ds.
const AT_ONCE: u16 = 0;
const LONGEST: u16 = u16::MAX;

/// The reason why altitudes cannot be converted. `Display` is a sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum AltitudeError {
    /// The reference is not known.
    #[error(
        "The altitude reference of its firmware is not known yet: wait until it has reported its settings."
    )]
    Unreported,
    /// Altitudes count from sea level, and the altitude of home is unknown.
    #[error(
        "Its firmware counts waypoint altitudes from sea level, and the altitude of home, where it is disarmed, is not \
         known yet: wait for a GPS fix."
    )]
    HomeUnknown,
}

impl AltitudeReference {
    /// Returns the difference to add to an altitude above home, m.
    ///
    /// # Errors
    /// Returns an error if the difference is unknown.
    pub fn added_m(self) -> Result<f64, AltitudeError> {
        match self {
            Self::Unreported => Err(AltitudeError::Unreported),
            Self::Home => Ok(0.0),
            Self::SeaLevel { home_m } => home_m.ok_or(AltitudeError::HomeUnknown),
        }
    }

    /// Converts a plan to the reference of the craft. Firmware whose altitudes count from sea level ends a HOLD of duration
    /// 0 at once, so it gets the longest duration for a HOLD without an end, and 0 for the shortest one.
    ///
    /// # Errors
    /// Returns an error if the reference is unknown.
    pub fn plan_for_craft(self, plan: &FlightPlan) -> Result<CraftPlan, AltitudeError> {
        let mut plan = raised(plan.records(), to_cm(self.added_m()?));
        self.replace_durations(&mut plan.records, |duration_ds| match duration_ds {
            NO_END => LONGEST,
            SHORTEST => AT_ONCE,
            other => other,
        });
        Ok(plan)
    }

    /// Converts a plan of the craft to altitudes above home.
    ///
    /// # Errors
    /// Returns an error if the reference is unknown.
    pub fn plan_of_craft(self, plan: &CraftPlan) -> Result<FlightPlan, AltitudeError> {
        let CraftPlan { mut records } = raised(plan.records.clone(), -to_cm(self.added_m()?));
        self.replace_durations(&mut records, |duration_ds| match duration_ds {
            LONGEST => NO_END,
            AT_ONCE => SHORTEST,
            other => other,
        });
        Ok(FlightPlan::from_records(&records))
    }

    fn replace_durations(self, records: &mut Records, replace: impl Fn(u16) -> u16) {
        if !matches!(self, Self::SeaLevel { .. }) {
            return;
        }
        for record in records.iter_mut().filter(|record| record.kind == WaypointType::Hold) {
            record.duration_ds = replace(record.duration_ds);
        }
    }
}

/// A plan as a craft stores it, with altitudes from the reference of the craft.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct CraftPlan {
    /// The waypoints, in the units of the craft.
    pub records: Records,
}

/// Raises every altitude that has a meaning.
fn raised(mut records: Records, by_cm: i32) -> CraftPlan {
    for record in &mut records {
        if record.kind.capability().altitude {
            record.alt_cm = record.alt_cm.saturating_add(by_cm);
        }
    }
    CraftPlan { records }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::quantity::Seconds;
    use crate::plan::{Altitude, Waypoint, WaypointRecord, WaypointType};

    #[test]
    fn a_hold_without_an_end_stays_one_on_firmware_that_ends_a_hold_of_0() {
        let hold = |seconds| Waypoint {
            kind: WaypointType::Hold,
            duration: Seconds::new(seconds),
            ..Waypoint::default()
        };
        let plan =
            FlightPlan { waypoints: [hold(0.0), hold(60.0), Waypoint::default()].into_iter().collect() };
        for (reference, duration_ds) in [
            (AltitudeReference::Home, [0, 600, 0]),
            (AltitudeReference::SeaLevel { home_m: Some(300.0) }, [u16::MAX, 600, 0]),
        ] {
            let held = reference.plan_for_craft(&plan).unwrap();
            let durations: Vec<u16> = held.records.iter().map(|record| record.duration_ds).collect();
            assert_eq!(durations, duration_ds);
            assert_eq!(reference.plan_of_craft(&held).unwrap(), plan);
        }
    }

    #[test]
    fn a_hold_that_ends_at_once_on_the_craft_is_not_shown_as_one_without_an_end() {
        let hold = WaypointRecord { kind: WaypointType::Hold, ..WaypointRecord::default() };
        let craft = CraftPlan { records: [hold].into_iter().collect() };
        let reference = AltitudeReference::SeaLevel { home_m: Some(0.0) };
        let plan = reference.plan_of_craft(&craft).unwrap();
        assert_eq!(plan.waypoints[0].duration, Seconds::AT_ONCE);
        assert_eq!(reference.plan_for_craft(&plan).unwrap(), craft);
    }

    #[test]
    fn altitudes_that_mean_something_are_converted_there_and_back() {
        use strum::IntoEnumIterator as _;
        let mut plan = FlightPlan::default();
        plan.waypoints.extend(WaypointType::iter().map(|kind| Waypoint {
            kind,
            altitude: Altitude::above_home(40.0),
            ..Waypoint::default()
        }));
        for (reference, there) in [
            (AltitudeReference::Home, 4000),
            (AltitudeReference::SeaLevel { home_m: Some(300.25) }, 34_025),
            (AltitudeReference::SeaLevel { home_m: Some(-20.0) }, 2000),
        ] {
            let converted = reference.plan_for_craft(&plan).unwrap();
            for waypoint in &converted.records {
                let unused = [WaypointType::Delay, WaypointType::YawRate].contains(&waypoint.kind);
                assert_eq!(waypoint.alt_cm, if unused { 4000 } else { there }, "{waypoint:?}");
            }
            assert_eq!(reference.plan_of_craft(&converted), Ok(plan.clone()));
        }
        let unknown = AltitudeReference::SeaLevel { home_m: None };
        assert_eq!(unknown.plan_for_craft(&plan), Err(AltitudeError::HomeUnknown));
        assert_eq!(
            AltitudeReference::default().plan_of_craft(&CraftPlan::default()),
            Err(AltitudeError::Unreported)
        );
    }
}
