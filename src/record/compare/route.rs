//! A flight plan in metres: where each waypoint is, and how high.

use nalgebra::Vector2;

use super::TrackSample;
use crate::geo::LocalFrame;
use crate::plan::{FlightPlan, HoldPattern, WaypointType};
use crate::telemetry::snapshot::SettingsView;

/// How far a waypoint may be passed and still count as flown, beyond its own radius, m.
const REACH_M: f64 = 20.0;
/// The same of a FLYBY, whose corner is cut, m.
const CUT_M: f64 = 40.0;

/// The places of a plan that are flown, in their order.
#[derive(Debug, Clone, PartialEq)]
pub struct Route {
    pub(super) points: Vec<RoutePoint>,
}

/// A waypoint of the route.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RoutePoint {
    /// Index in the plan.
    pub(super) wp: u8,
    pub(super) kind: WaypointType,
    /// North and east of home, m; `None` of a TAKEOFF, which climbs where it stands.
    pub(super) ne: Option<Vector2<f64>>,
    /// Altitude above home at which it is flown, m.
    pub(super) alt_m: f64,
    /// Radius of the pattern that is flown around it, m; 0 = none.
    pub(super) pattern_m: f64,
    /// The craft stays there for a while.
    pub(super) holds: bool,
    /// From which distance it counts as flown, m.
    pub(super) reach_m: f64,
}

impl Route {
    /// The route of a plan; `frame` places it in the world.
    pub fn new(plan: &FlightPlan, frame: &LocalFrame, settings: &SettingsView) -> Self {
        let mut points = Vec::new();
        let mut alt_change_m = None;
        for (wp, waypoint) in (0_u8..).zip(&plan.waypoints) {
            let alt_m = f64::from(waypoint.alt_cm) / 100.0;
            if waypoint.kind == WaypointType::AltChange {
                alt_change_m = Some(alt_m);
            }
            if !waypoint.kind.is_positional() {
                continue;
            }
            let place = || {
                let enu =
                    frame.to_enu(waypoint.position.lat_deg(), waypoint.position.lon_deg(), frame.alt_amsl_m);
                Vector2::new(enu.y, enu.x)
            };
            let is_hold = waypoint.kind == WaypointType::Hold;
            let pattern_m = match waypoint.pattern {
                HoldPattern::Orbit if is_hold => settings.orbit_radius_m,
                HoldPattern::Figure8 if is_hold => settings.figure8_width_m / 2.0,
                _ => 0.0,
            };
            let reach_m = match waypoint.kind {
                WaypointType::Flyby => settings.arrival_radius_m + CUT_M,
                WaypointType::Hold => settings.hold_radius_m.max(settings.arrival_radius_m) + REACH_M,
                WaypointType::Takeoff => REACH_M,
                _ => settings.arrival_radius_m + REACH_M,
            };
            points.push(RoutePoint {
                wp,
                kind: waypoint.kind,
                ne: waypoint.kind.uses_position().then(place),
                alt_m: alt_change_m.take().unwrap_or(alt_m),
                pattern_m,
                holds: is_hold,
                reach_m,
            });
            if waypoint.kind == WaypointType::Land {
                break;
            }
        }
        Self { points }
    }
}

impl RoutePoint {
    /// How far the craft is from having passed it, m: of a pattern from its ring, of a TAKEOFF below its altitude.
    pub(super) fn distance_m(&self, sample: &TrackSample) -> f64 {
        match self.ne {
            Some(ne) => ((sample.ne - ne).norm() - self.pattern_m).max(0.0),
            None => (self.alt_m - sample.alt_m).max(0.0),
        }
    }
}
