//! What may hurt a craft when it flies the plan it has with the settings it has.

use crate::geo::LatLon;
use crate::plan::estimate::Assumptions;
use crate::plan::review::{Finding, review};
use crate::vehicle::FlightController;

/// A sentence for each hazard of the stored plan; none from a flight controller that does not tell its settings.
#[must_use]
pub fn hazards(controller: &FlightController) -> Vec<String> {
    let Some(firmware) = controller.embedded() else { return Vec::new() };
    let stored = &firmware.configuration().settings;
    let settings = Assumptions::SETTINGS.map(|name| format!("{name} = {}", stored.number(name)));
    // No hazard depends on where home is.
    let found = review(firmware.stored_plan(), LatLon::default(), &Assumptions::from_settings(&settings));
    let hazards = found.iter().filter(|finding| Finding::is_hazard(finding));
    hazards.map(|finding| format!("Beware: {finding}.")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware::config::Configuration;
    use crate::firmware::{Firmware, FirmwareOptions};
    use crate::plan::{FlightPlan, Waypoint, WaypointType};
    use crate::session::upload;

    #[test]
    fn an_upload_with_a_hazard_is_warned_of() {
        let firmware = Firmware::new(Configuration::default(), FirmwareOptions::default());
        let mut controller = FlightController::from(firmware);
        let mut plan = FlightPlan::default();
        let home = LatLon::new(404_635_000, -795_182_000);
        plan.waypoints.push(Waypoint {
            position: home,
            alt_cm: -300,
            kind: WaypointType::Land,
            ..Waypoint::default()
        });
        upload(&mut controller, &plan, &["ap_landing_throttle_threshold = 300".to_owned()]).unwrap();
        let told = hazards(&controller);
        assert!(told[0].starts_with("Beware: waypoint 0 is 3.0 m below home"), "{told:?}");
        assert!(
            told[1].starts_with("Beware: ap_landing_throttle_threshold = 300 can never be met"),
            "{told:?}"
        );
    }
}
