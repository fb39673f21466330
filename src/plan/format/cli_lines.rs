//! A plan as command lines of the firmware. `waypoint list` and `dump` print them, plan files in CLI text contain them,
//! and ground stations upload them.

use crate::plan::FlightPlan;
use crate::plan::record::Records;

/// The command that empties the stored plan.
const CLEAR: &str = "waypoint clear";

/// Returns the lines that rebuild a plan: `waypoint clear`, then `waypoint insert …` for each waypoint.
pub fn plan_lines(plan: &FlightPlan) -> impl Iterator<Item = String> {
    record_lines(plan.records())
}

/// Returns the lines that rebuild a plan from its records.
pub fn record_lines(records: Records) -> impl Iterator<Item = String> {
    let inserts = records
        .into_iter()
        .enumerate()
        .map(|(index, record)| format!("waypoint insert {index} {}", record.values(record.alt_cm)));
    std::iter::once(CLEAR.to_owned()).chain(inserts)
}

/// Returns the lines of an upload by a ground station: `set …` for each setting, then those of [`record_lines`].
pub fn upload_lines(records: Records, settings: &[String]) -> impl Iterator<Item = String> {
    settings.iter().map(|setting| format!("set {setting}")).chain(record_lines(records))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::LatLon;
    use crate::plan::{Altitude, HoldPattern, Seconds, Waypoint, WaypointType};

    #[test]
    fn lines_are_what_a_pilot_types() {
        let mut plan = FlightPlan::default();
        plan.waypoints.push(Waypoint {
            position: LatLon::new(404_640_000, -795_175_000),
            altitude: Altitude::above_home(50.0),
            duration: Seconds::new(30.0),
            kind: WaypointType::Hold,
            pattern: HoldPattern::Figure8,
            ..Waypoint::default()
        });
        let settings = ["ap_max_angle = 25".to_owned()];
        assert_eq!(
            upload_lines(plan.records(), &settings).collect::<Vec<_>>(),
            [
                "set ap_max_angle = 25",
                "waypoint clear",
                "waypoint insert 0 40.4640000 -79.5175000 5000 0 HOLD 300 FIGURE8"
            ]
        );
    }
}
