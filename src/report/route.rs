//! A flight plan in metres: the position and the altitude of each waypoint.

use nalgebra::{Vector2, Vector3};

use super::plot::{Mark, Point};
use crate::geo::LocalFrame;
use crate::math::acos;
use crate::plan::{FlightPlan, HoldPattern, WaypointType};
use crate::sim::Truth;
use crate::telemetry::snapshot::SettingsView;

/// The greatest distance, beyond the waypoint's own radius, at which a waypoint counts as flown, m.
const REACH_M: f64 = 20.0;
/// The same for a FLYBY, where the craft cuts the corner, m.
const CUT_M: f64 = 40.0;

/// The places of a plan to fly to, in their order.
#[derive(Debug, Clone, PartialEq)]
pub struct Route {
    pub(in crate::report) points: Vec<RoutePoint>,
}

/// The position of the craft at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackSample {
    /// Seconds after the engagement.
    pub time_s: f64,
    /// North and east of home, m.
    pub ne: Vector2<f64>,
    /// Height above the craft's position on the ground at home, m.
    pub alt_m: f64,
    /// Attitude; `None` in a log.
    pub attitude: Option<SampledAttitude>,
}

/// The attitude of the craft at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SampledAttitude {
    /// Direction of the nose, degrees clockwise from north.
    pub heading_deg: f64,
    /// Angle between the thrust axis and the vertical, degrees.
    pub tilt_deg: f64,
}

impl From<&Truth> for SampledAttitude {
    fn from(truth: &Truth) -> Self {
        let up = (truth.attitude * Vector3::z()).z;
        Self { heading_deg: truth.heading_deg(), tilt_deg: acos(up.clamp(-1.0, 1.0)).to_degrees() }
    }
}

impl TrackSample {
    /// Returns north, east and up from home, m.
    pub(in crate::report) fn position(&self) -> Vector3<f64> {
        Vector3::new(self.ne.x, self.ne.y, self.alt_m)
    }
}

/// A waypoint of the route.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::report) struct RoutePoint {
    /// Index in the plan.
    pub(in crate::report) wp: u8,
    pub(in crate::report) kind: WaypointType,
    /// North and east of home, m; `None` for a TAKEOFF, which climbs at its own place.
    pub(in crate::report) ne: Option<Vector2<f64>>,
    /// Altitude of the waypoint above home, m.
    pub(in crate::report) alt_m: f64,
    /// Radius of the pattern around the waypoint, m; 0 = none.
    pub(in crate::report) pattern_m: f64,
    /// `true` if the pattern is an ORBIT, a ring around the waypoint.
    pub(in crate::report) is_ring: bool,
    /// `true` if the craft stays there for a while.
    pub(in crate::report) holds: bool,
    /// The distance at which it counts as flown, m.
    pub(in crate::report) reach_m: f64,
}

impl Route {
    /// Returns the route of a plan; `frame` places it in the world.
    pub fn new(plan: &FlightPlan, frame: &LocalFrame, settings: &SettingsView) -> Self {
        let mut points = Vec::new();
        let mut alt_change_m = None;
        for (wp, waypoint) in (0_u8..).zip(&plan.waypoints) {
            let alt_m = waypoint.altitude.above_home_m();
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
                is_ring: is_hold && waypoint.pattern == HoldPattern::Orbit,
                holds: is_hold,
                reach_m,
            });
            if waypoint.kind == WaypointType::Land {
                break;
            }
        }
        Self { points }
    }

    /// Returns the horizontal distance from the nearest leg, of which the first begins at home, m.
    pub(in crate::report) fn distance_m(&self, ne: Vector2<f64>) -> f64 {
        let places = std::iter::once(Vector2::zeros()).chain(self.points.iter().filter_map(|point| point.ne));
        let places: Vec<Vector2<f64>> = places.collect();
        let legs = places.windows(2).map(|ends| match ends {
            [from, to] => distance_to_segment(ne, *from, *to),
            _ => f64::INFINITY,
        });
        legs.fold(ne.norm(), f64::min)
    }

    /// Returns the places of the waypoints in their order, for a map.
    pub(super) fn legs(&self) -> impl Iterator<Item = Point> + '_ {
        self.points.iter().filter_map(RoutePoint::place)
    }

    /// Returns the waypoints with their names, for a map.
    pub(super) fn marks(&self) -> Vec<Mark> {
        let mark = |point: &RoutePoint| {
            let kind = match point.kind {
                WaypointType::Flyover => String::new(),
                kind => format!(" {kind}"),
            };
            Some(Mark { place: point.place()?, name: format!("WP{}{kind}", point.wp) })
        };
        self.points.iter().filter_map(mark).collect()
    }

    /// Returns the hold patterns, for a map: centre and radius, m.
    pub(super) fn rings(&self) -> Vec<(Point, f64)> {
        let patterns = self.points.iter().filter(|point| point.pattern_m > 0.0);
        patterns.filter_map(|point| Some((point.place()?, point.pattern_m))).collect()
    }
}

impl RoutePoint {
    /// Returns the place on a map.
    fn place(&self) -> Option<Point> {
        self.ne.map(|ne| (ne.y, ne.x))
    }

    /// Returns the distance of the craft from the waypoint, m: from the ring of a pattern, or below the altitude of a
    /// TAKEOFF.
    pub(in crate::report) fn distance_m(&self, sample: &TrackSample) -> f64 {
        match self.ne {
            Some(ne) => ((sample.ne - ne).norm() - self.pattern_m).max(0.0),
            None => (self.alt_m - sample.alt_m).max(0.0),
        }
    }
}

/// Returns the distance from a point to the segment between two others.
pub(in crate::report) fn distance_to_segment<const D: usize>(
    point: nalgebra::SVector<f64, D>,
    from: nalgebra::SVector<f64, D>,
    to: nalgebra::SVector<f64, D>,
) -> f64 {
    let along = to - from;
    let length = along.norm_squared();
    let share = if length > 0.0 { ((point - from).dot(&along) / length).clamp(0.0, 1.0) } else { 0.0 };
    (point - (from + along * share)).norm()
}
