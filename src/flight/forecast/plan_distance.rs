//! The distance of a craft along its plan.

use nalgebra::Vector2;

use crate::geo::LocalFrame;
use crate::plan::{FlightPlan, WaypointType};
use crate::telemetry::{NavState, NavTelemetry, PlanSource};

/// The distance from home along the legs at each waypoint of a plan, m. Modifiers have that of the previous waypoint.
#[derive(Debug, Clone)]
pub(super) struct PlanDistance {
    at_waypoint_m: Vec<f64>,
    along_m: f64,
}

impl PlanDistance {
    /// Returns the distances of a plan that begins at the origin of `frame`.
    pub(super) fn new(plan: &FlightPlan, frame: &LocalFrame) -> Self {
        let mut from = Vector2::zeros();
        let mut sum_m = 0.0;
        let at_waypoint_m = plan
            .waypoints
            .iter()
            .map(|waypoint| {
                // A TAKEOFF takes place where it begins.
                if waypoint.kind.uses_position() && waypoint.kind != WaypointType::Takeoff {
                    let place = waypoint.position;
                    let enu = frame.to_enu(place.lat_deg(), place.lon_deg(), frame.alt_amsl_m);
                    sum_m += (enu.xy() - from).norm();
                    from = enu.xy();
                }
                sum_m
            })
            .collect();
        Self { at_waypoint_m, along_m: 0.0 }
    }

    /// Takes an update of the navigator. Returns the present distance, m, which never decreases.
    pub(super) fn follow(&mut self, nav: &NavTelemetry) -> f64 {
        let reached = self.at_waypoint_m.get(usize::from(nav.wp));
        if let Some(&reached_m) = reached.filter(|_| nav.engaged && nav.source == PlanSource::Stored) {
            let left_m = match nav.state {
                NavState::Approaching => nav.distance_m.unwrap_or(0.0),
                _ => 0.0,
            };
            self.along_m = self.along_m.max(reached_m - left_m);
        }
        self.along_m
    }
}
