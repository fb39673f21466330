//! The missing condition of a craft that never engaged.

use crate::telemetry::NavTelemetry;
use crate::vehicle::Vehicle;

/// The mean motor output from which the motors are at full power.
const FULL_OUTPUT: f64 = 0.95;

/// Returns the condition that the craft waits for before its mission, as half a sentence, or `None` if nothing is
/// known to be missing.
pub(super) fn sentence(vehicle: &Vehicle, takeoff_m: f64) -> Option<String> {
    let controller = vehicle.controller();
    if !controller.is_armed() {
        return arming(vehicle);
    }
    let climbs = vehicle.transmitter().pilot_doing() == Some("climbing");
    if climbs && let Some(firmware) = vehicle.embedded() {
        return Some(climb(firmware.altitude_m(), takeoff_m, controller.motors().mean()));
    }
    let refusal = controller.nav().and_then(|nav: &NavTelemetry| nav.refusal)?;
    Some(refusal.sentence().trim_end_matches('.').to_owned())
}

/// Returns the thrust over weight of a craft that does not leave the ground at full throttle.
pub(super) fn lift_share(vehicle: &Vehicle) -> Option<f64> {
    let thrust_to_weight = vehicle.thrust_to_weight()?;
    if !vehicle.embedded()?.is_too_heavy() {
        return None;
    }
    let square = vehicle.controller().motors().mean_square();
    Some(thrust_to_weight * square)
}

/// Returns the reason why the craft does not arm.
fn arming(vehicle: &Vehicle) -> Option<String> {
    let firmware = vehicle.embedded()?;
    if !firmware.gps_fix() {
        return Some("it waits for a GPS fix".to_owned());
    }
    let flags = firmware.arming_flags();
    let causes = if flags.causes().is_empty() { flags } else { flags.causes() };
    let reported: Vec<String> = causes.iter().map(|flag| format!("{flag} ({})", flag.hint())).collect();
    (!reported.is_empty()).then(|| format!("arming is blocked by {}", reported.join(", ")))
}

/// Describes a climb that does not reach its altitude.
fn climb(alt_m: f64, takeoff_m: f64, mean: f64) -> String {
    // Avoids `-0.0` for a craft on the ground.
    let alt_m = alt_m.max(0.0) + 0.0;
    let why = if mean >= FULL_OUTPUT { ", the thrust does not suffice" } else { "" };
    format!(
        "the climb stopped at {alt_m:.1} m of {takeoff_m:.1} m with the motors at {:.0} %{why}",
        100.0 * mean
    )
}
