//! How far a plan uploaded in flight moves the waypoint that the craft flies to.

use crate::geo::distance_bearing;
use crate::plan::{FlightPlan, LegAltitude, Waypoint, leg_altitudes};
use crate::ui::model::action::Action;
use crate::ui::shared::Shared;

/// A waypoint that moves by more than this is asked about, m.
const FAR_M: f64 = 50.0;

/// Returns a sentence for the user if the open plan has the waypoint that the craft flies to far from its place, or lacks it.
pub(super) fn question(state: &Shared) -> Option<String> {
    // A return home and an emergency landing are plans of their own.
    if !state.flies_stored_plan() {
        return None;
    }
    let vehicle = &state.view.vehicle;
    let flown = vehicle.active_plan.as_ref().or(vehicle.stored_plan.as_ref())?;
    let wp = usize::from(vehicle.nav.as_ref()?.wp);
    let old = leg_from(flown, wp)?;
    // The craft keeps the plan that it flies until it is engaged again or sent on.
    let when = match state.view.remote {
        Some(_) => "at the next engagement".to_owned(),
        None => format!("at the next engagement, or with `{}`", state.key(Action::GoTo)),
    };
    let Some(new) = leg_from(state.plan(), wp) else {
        return Some(format!("The craft flies to WP{wp}, which this plan does not have: it counts {when}."));
    };
    let (from, to) = (&flown.waypoints[old.index], &state.plan().waypoints[new.index]);
    let has_place = |wp: &Waypoint| wp.kind.uses_position();
    let aside_m =
        if has_place(from) && has_place(to) { distance_bearing(from.position, to.position).0 } else { 0.0 };
    let up_m = new.alt_m - old.alt_m;
    let length = |metres: f64| state.units.length_text(metres, 0);
    let mut ways = Vec::new();
    if aside_m > FAR_M {
        ways.push(format!("{} to the side", length(aside_m)));
    }
    if up_m.abs() > FAR_M {
        let way = if up_m > 0.0 { "up" } else { "down" };
        ways.push(format!("{} {way}, to {}", length(up_m.abs()), length(new.alt_m)));
    }
    (!ways.is_empty()).then(|| {
        format!("The craft flies to WP{wp}. This plan moves it {}: it counts {when}.", ways.join(" and "))
    })
}

/// The leg that is flown when the craft is sent to a waypoint: to the first positional one from there.
fn leg_from(plan: &FlightPlan, wp: usize) -> Option<LegAltitude> {
    leg_altitudes(&plan.waypoints).find(|leg| leg.index >= wp)
}
