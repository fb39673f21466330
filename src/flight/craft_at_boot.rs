//! The craft of a vehicle at boot again, with a plan to fly.

use super::forecast::{self, NO_WAYPOINTS};
use crate::plan::FlightPlan;
use crate::sim::WorldConfig;
use crate::vehicle::{Vehicle, VehicleCommand};

/// Returns the craft of `vehicle` at boot: with its present settings, `plan` and the `settings` of the plan, in the present
/// air and without faults. `change` may change the seed and the air before. A flight of it is the one that `fly` flies
/// with the same options.
///
/// # Errors
/// Fails with the reason why nothing can be flown, as a sentence.
pub fn craft_at_boot(
    vehicle: &Vehicle,
    plan: &FlightPlan,
    settings: &[String],
    change: impl FnOnce(&mut WorldConfig),
) -> Result<Vehicle, String> {
    if plan.waypoints.is_empty() {
        return Err(NO_WAYPOINTS.to_owned());
    }
    forecast::check_possible(vehicle)?;
    let again = vehicle.again(change).map_err(|error| error.to_string())?;
    let mut again = again.ok_or(forecast::CONTROLLER_IS_REMOTE)?;
    let upload = VehicleCommand::upload(plan.clone(), settings.to_vec());
    again.apply(&upload).accepted().map_err(|refused| refused.sentence())?;
    Ok(again)
}
