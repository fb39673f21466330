//! How far an upload in flight would move the waypoint that is flown to.

use crate::geo::distance_bearing;
use crate::plan::{FlightPlan, Waypoint, WaypointType};
use crate::ui::app_state::AppState;

/// A waypoint that moves by more than this is asked about, m.
const FAR_M: f64 = 50.0;

/// Returns what the upload of the open plan would do to the waypoint that the armed craft flies to, as a sentence, when it
/// moves it far.
pub(super) fn told(state: &AppState) -> Option<String> {
    let vehicle = &state.view.vehicle;
    if vehicle.craft.armed != Some(true) && !vehicle.is_engaged() {
        return None;
    }
    let flown = vehicle.active_plan.as_ref().or(vehicle.stored_plan.as_ref())?;
    let wp = usize::from(vehicle.nav.as_ref()?.wp);
    let old = flown.waypoints.get(wp)?;
    let Some(new) = state.plan().waypoints.get(wp) else {
        return Some(format!("The craft flies to WP{wp}, which this plan does not have."));
    };
    let placed = |wp: &Waypoint| wp.kind.uses_position();
    let beside_m =
        if placed(old) && placed(new) { distance_bearing(old.position, new.position).0 } else { 0.0 };
    let old_alt_m = altitude_m(flown, wp);
    let new_alt_m = altitude_m(state.plan(), wp);
    let above_m = new_alt_m - old_alt_m;
    if beside_m <= FAR_M && above_m.abs() <= FAR_M {
        return None;
    }
    let length = |metres: f64| state.units.length_text(metres, 0);
    let mut ways = Vec::new();
    if beside_m > FAR_M {
        ways.push(format!("{} to the side", length(beside_m)));
    }
    if above_m.abs() > FAR_M {
        let way = if above_m > 0.0 { "up" } else { "down" };
        ways.push(format!("{} {way}, to {}", length(above_m.abs()), length(new_alt_m)));
    }
    Some(format!("The craft flies to WP{wp}: this plan moves it {}.", ways.join(" and ")))
}

/// Altitude above home of the leg to a waypoint, m; an ALT_CHANGE before it says another than its own.
fn altitude_m(plan: &FlightPlan, wp: usize) -> f64 {
    let mut before = plan.waypoints[..wp].iter().rev().take_while(|before| !before.kind.is_positional());
    let changed = before.find(|before| before.kind == WaypointType::AltChange);
    f64::from(changed.unwrap_or(&plan.waypoints[wp]).alt_cm) / 100.0
}
