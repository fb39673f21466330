//! The reference of a craft for the altitudes of its waypoints. Plans in betadeck use home.

use super::{FlightPlan, WaypointType};

/// The reference of a craft for the altitudes of its waypoints.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum AltitudeReference {
    /// The craft has not reported it yet.
    #[default]
    Unreported,
    Home,
    /// Altitudes count from mean sea level.
    SeaLevel {
        /// The altitude of home above sea level, m; `None` while it is unknown.
        home_m: Option<f64>,
    },
}

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

    /// Converts a plan to the reference of the craft.
    ///
    /// # Errors
    /// Returns an error if the reference is unknown.
    pub fn plan_for_craft(self, plan: &FlightPlan) -> Result<FlightPlan, AltitudeError> {
        Ok(raised(plan, centimetres(self.added_m()?)))
    }

    /// Converts a plan of the craft to altitudes above home.
    ///
    /// # Errors
    /// Returns an error if the reference is unknown.
    pub fn plan_of_craft(self, plan: &FlightPlan) -> Result<FlightPlan, AltitudeError> {
        Ok(raised(plan, -centimetres(self.added_m()?)))
    }
}

fn centimetres(metres: f64) -> i32 {
    (metres * 100.0).round() as i32
}

/// Raises every altitude of the plan that has a meaning.
fn raised(plan: &FlightPlan, by_cm: i32) -> FlightPlan {
    let mut plan = plan.clone();
    for waypoint in &mut plan.waypoints {
        if waypoint.kind.is_positional() || waypoint.kind == WaypointType::AltChange {
            waypoint.alt_cm = waypoint.alt_cm.saturating_add(by_cm);
        }
    }
    plan
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Waypoint;

    #[test]
    fn altitudes_that_mean_something_are_converted_there_and_back() {
        use strum::IntoEnumIterator as _;
        let mut plan = FlightPlan::default();
        plan.waypoints.extend(WaypointType::iter().map(|kind| Waypoint {
            kind,
            alt_cm: 4000,
            ..Waypoint::default()
        }));
        for (reference, there) in [
            (AltitudeReference::Home, 4000),
            (AltitudeReference::SeaLevel { home_m: Some(300.25) }, 34_025),
            (AltitudeReference::SeaLevel { home_m: Some(-20.0) }, 2000),
        ] {
            let converted = reference.plan_for_craft(&plan).unwrap();
            for waypoint in &converted.waypoints {
                let unused = [WaypointType::Delay, WaypointType::YawRate].contains(&waypoint.kind);
                assert_eq!(waypoint.alt_cm, if unused { 4000 } else { there }, "{waypoint:?}");
            }
            assert_eq!(reference.plan_of_craft(&converted), Ok(plan.clone()));
        }
        let unknown = AltitudeReference::SeaLevel { home_m: None };
        assert_eq!(unknown.plan_for_craft(&plan), Err(AltitudeError::HomeUnknown));
        assert_eq!(AltitudeReference::default().plan_of_craft(&plan), Err(AltitudeError::Unreported));
    }
}
