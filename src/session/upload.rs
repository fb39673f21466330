//! A plan as the command lines with which a ground station uploads it.

use crate::geo::Degrees7;
use crate::plan::FlightPlan;

/// `set …` for each setting, `waypoint clear`, `waypoint insert …` for each waypoint.
pub fn lines<'a>(plan: &'a FlightPlan, settings: &'a [String]) -> impl Iterator<Item = String> + 'a {
    let sets = settings.iter().map(|setting| format!("set {setting}"));
    let inserts = plan.waypoints.iter().enumerate().map(|(index, waypoint)| {
        format!(
            "waypoint insert {index} {} {} {} {} {} {} {}",
            Degrees7(waypoint.position.lat_e7),
            Degrees7(waypoint.position.lon_e7),
            waypoint.alt_cm,
            waypoint.speed_cms,
            waypoint.kind,
            waypoint.duration_ds,
            waypoint.pattern
        )
    });
    sets.chain(std::iter::once("waypoint clear".to_owned())).chain(inserts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::LatLon;
    use crate::plan::{HoldPattern, Waypoint, WaypointType};

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
            lines(&plan, &settings).collect::<Vec<_>>(),
            [
                "set ap_max_angle = 25",
                "waypoint clear",
                "waypoint insert 0 40.4640000 -79.5175000 5000 0 HOLD 300 FIGURE8"
            ]
        );
    }
}
