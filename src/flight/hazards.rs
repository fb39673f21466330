//! The hazards to a craft that flies its stored plan with its current settings.

use crate::firmware::Firmware;
use crate::geo::{LatLon, LocalFrame};
use crate::plan::estimate::Assumptions;
use crate::plan::review::{Finding, review};
use crate::vehicle::{FlightController, Vehicle};

/// Returns a sentence for each hazard of the stored plan. The mission begins `start_alt_m` above home and
/// must stay below `max_alt_m`, if given. Returns nothing for a flight controller with unknown settings.
pub fn hazards(vehicle: &Vehicle, start_alt_m: f64, max_alt_m: Option<f64>) -> Vec<String> {
    let place = |frame: &LocalFrame| LatLon::from_degrees(frame.lat_deg, frame.lon_deg);
    let armed_at = vehicle.controller().embedded().and_then(Firmware::home);
    let home = armed_at.or_else(|| vehicle.local_frame().map(place));
    hazards_from(vehicle.controller(), home, start_alt_m, max_alt_m)
}

/// Returns the hazards of a mission that begins above `home`.
fn hazards_from(
    controller: &FlightController,
    home: Option<LatLon>,
    start_alt_m: f64,
    max_alt_m: Option<f64>,
) -> Vec<String> {
    let Some(firmware) = controller.embedded() else { return Vec::new() };
    let assumptions = Assumptions { start_alt_m, max_alt_m, ..firmware.settings_view().assumptions() };
    let found = review(firmware.stored_plan(), home.unwrap_or_default(), &assumptions);
    let hazards = found.iter().filter(|finding| Finding::is_hazard(finding));
    // The steepness of a leg depends on the position of home.
    let known = hazards.filter(|finding| home.is_some() || !matches!(finding, Finding::SteepLeg(_)));
    known.map(|finding| format!("Caution: {finding}.")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware::FirmwareOptions;
    use crate::firmware::config::Configuration;
    use crate::plan::{Altitude, FlightPlan, Waypoint, WaypointType};

    #[test]
    fn an_upload_with_a_leg_that_is_too_steep_is_warned_of() {
        let mut firmware = Firmware::new(Configuration::default(), FirmwareOptions::default());
        let home = LatLon::new(404_635_000, -795_182_000);
        let mut plan = FlightPlan::default();
        for alt_m in [80.0, 20.0] {
            let kind = if alt_m > 50.0 { WaypointType::Flyover } else { WaypointType::Land };
            let position = LatLon::new(home.lat_e7 + 3000, home.lon_e7);
            plan.waypoints.push(Waypoint {
                position,
                altitude: Altitude::above_home(alt_m),
                kind,
                ..Waypoint::default()
            });
        }
        firmware.upload(&plan, &[]).unwrap();
        let controller = FlightController::from(firmware);
        let reported = hazards_from(&controller, Some(home), 10.0, None);
        assert!(
            reported.len() == 1 && reported[0].starts_with("Caution: waypoint 0 is passed about"),
            "{reported:?}"
        );
        assert!(hazards_from(&controller, Some(home), 75.0, None).is_empty(), "it is level there");
        assert!(hazards_from(&controller, None, 10.0, None).is_empty(), "without a home no leg is known");
    }

    #[test]
    fn an_upload_with_a_hazard_is_warned_of() {
        let mut firmware = Firmware::new(Configuration::default(), FirmwareOptions::default());
        let mut plan = FlightPlan::default();
        let home = LatLon::new(404_635_000, -795_182_000);
        plan.waypoints.push(Waypoint {
            position: home,
            altitude: Altitude::above_home(-3.0),
            kind: WaypointType::Land,
            ..Waypoint::default()
        });
        let settings = ["ap_landing_throttle_threshold = 300".to_owned()];
        firmware.upload(&plan, &settings).unwrap();
        let controller = FlightController::from(firmware);
        let reported = hazards_from(&controller, Some(home), 10.0, None);
        assert!(reported[0].starts_with("Caution: waypoint 0 is 3.0 m below home"), "{reported:?}");
        assert!(
            reported[1].starts_with("Caution: ap_landing_throttle_threshold = 300 can never be met"),
            "{reported:?}"
        );
    }
}
