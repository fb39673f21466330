//! The leg that a remote flight controller flies, from the plan that it stores and its position.

use crate::geo::{LatLon, local_offset};
use crate::plan::FlightPlan;
use crate::telemetry::{NavState, NavTelemetry};

/// The legs of a mission.
#[derive(Debug, Clone, Default)]
pub(super) struct LegObserver {
    /// The place of the craft when the mission began, and the first waypoint.
    begun: Option<(LatLon, u8)>,
}

impl LegObserver {
    /// Adds the leg and the cross-track error to a report, as far as they are known.
    pub(super) fn follow(
        &mut self,
        nav: &mut NavTelemetry,
        plan: Option<&FlightPlan>,
        position: Option<LatLon>,
    ) {
        if matches!(nav.state, NavState::Idle | NavState::Complete) {
            self.begun = None;
            return;
        }
        if self.begun.is_none() {
            self.begun = position.map(|position| (position, nav.wp));
        }
        if nav.state != NavState::Approaching {
            return;
        }
        let (Some(plan), Some(position), Some((place, first))) = (plan, position, self.begun) else { return };
        let Some(to) = plan.waypoints.get(usize::from(nav.wp)).map(|waypoint| waypoint.position) else {
            return;
        };
        let before =
            plan.waypoints.iter().take(usize::from(nav.wp)).rfind(|before| before.kind.is_positional());
        let from = before.filter(|_| nav.wp != first).map_or(place, |before| before.position);
        let (leg, craft) = (local_offset(from, to), local_offset(from, position));
        let Some(along) = leg.try_normalize(1.0) else { return };
        nav.leg_start = Some(from);
        nav.along_m = Some(along.dot(&craft));
        nav.xte_m = Some(along.x * craft.y - along.y * craft.x);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::offset_to_latlon;
    use crate::plan::builtin::BuiltinPlan;

    #[test]
    fn the_error_is_across_the_leg_that_is_flown_and_positive_on_its_right() {
        let plan = BuiltinPlan::find("square").unwrap().read().unwrap().plan;
        let place = |wp: usize, north_m: f64, east_m: f64| {
            Some(offset_to_latlon(plan.waypoints[wp].position, nalgebra::Vector2::new(north_m, east_m)))
        };
        let mut legs = LegObserver::default();
        let mut report = |state, wp, position| {
            let mut nav = NavTelemetry { state, wp, ..NavTelemetry::default() };
            legs.follow(&mut nav, Some(&plan), position);
            nav
        };
        let near =
            |value: Option<f64>, expected: f64| value.is_some_and(|value| (value - expected).abs() < 0.1);
        use NavState::{Approaching, Holding, Idle};
        assert_eq!(report(Idle, 0, place(0, -100.0, 0.0)).xte_m, None);
        assert!(near(report(Approaching, 0, place(0, -100.0, 0.0)).xte_m, 0.0), "the leg begins here");
        let nav = report(Approaching, 0, place(0, -50.0, 3.0));
        assert!(near(nav.xte_m, 3.0) && near(nav.along_m, 50.0), "{nav:?}");
        // From waypoint 0 to the south: west is on the right.
        let nav = report(Approaching, 1, place(0, -20.0, -4.0));
        assert!(near(nav.xte_m, 4.0) && nav.leg_start == Some(plan.waypoints[0].position), "{nav:?}");
        assert_eq!(report(Holding, 2, place(2, 1.0, 1.0)).xte_m, None);
        assert_eq!(report(Approaching, 3, None).xte_m, None, "its place is unknown");
    }
}
