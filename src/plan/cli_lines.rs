//! A plan as command lines of the firmware. `waypoint list` and `dump` print them, plan files in CLI text contain them,
//! and ground stations upload them.

use std::fmt::Display;

use super::{FlightPlan, Waypoint};
use crate::geo::Degrees7;

/// The command that empties the stored plan.
const CLEAR: &str = "waypoint clear";

/// Returns the values of a waypoint in the order of `waypoint insert`, after the index. The caller gives the altitude
/// as text: whole centimetres in lines for typing, metres in replies of the firmware.
pub(crate) fn waypoint_values(waypoint: &Waypoint, altitude: impl Display) -> String {
    let Waypoint { position, alt_cm: _, speed_cms, duration_ds, kind, pattern } = waypoint;
    let (lat, lon) = (Degrees7(position.lat_e7), Degrees7(position.lon_e7));
    format!("{lat} {lon} {altitude} {speed_cms} {kind} {duration_ds} {pattern}")
}

/// Returns the lines that rebuild a plan: `waypoint clear`, then `waypoint insert …` for each waypoint.
pub fn plan_lines(plan: &FlightPlan) -> impl Iterator<Item = String> + '_ {
    let inserts = plan.waypoints.iter().enumerate().map(|(index, waypoint)| {
        format!("waypoint insert {index} {}", waypoint_values(waypoint, waypoint.alt_cm))
    });
    std::iter::once(CLEAR.to_owned()).chain(inserts)
}

/// Returns the lines of an upload by a ground station: `set …` for each setting, then those of [`plan_lines`].
pub fn upload_lines<'a>(plan: &'a FlightPlan, settings: &'a [String]) -> impl Iterator<Item = String> + 'a {
    settings.iter().map(|setting| format!("set {setting}")).chain(plan_lines(plan))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::LatLon;
    use crate::plan::{HoldPattern, WaypointType};

    #[test]
    fn lines_are_what_a_pilot_types() {
        let mut plan = FlightPlan::default();
        plan.waypoints.push(Waypoint {
            position: LatLon::new(404_640_000, -795_175_000),
            alt_cm: 5000,
            duration_ds: 300,
            kind: WaypointType::Hold,
            pattern: HoldPattern::Figure8,
            ..Waypoint::default()
        });
        let settings = ["ap_max_angle = 25".to_owned()];
        assert_eq!(
            upload_lines(&plan, &settings).collect::<Vec<_>>(),
            [
                "set ap_max_angle = 25",
                "waypoint clear",
                "waypoint insert 0 40.4640000 -79.5175000 5000 0 HOLD 300 FIGURE8"
            ]
        );
    }
}
