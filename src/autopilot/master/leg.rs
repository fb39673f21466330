//! A leg to a waypoint: straight to a point, or along a line.

use nalgebra::{Vector2, Vector3};

use super::altitude::Height;
use super::corner::Corner;
use super::line::{Followed, Line, Motion};
use super::position::Point;
use crate::autopilot::io::NavInputs;
use crate::autopilot::params::Params;
use crate::plan::WaypointType;

/// The speed towards a target, m/s per metre of distance.
const APPROACH_PER_S: f64 = 1.0;
/// The deceleration towards a point, m/s².
const BRAKE_MPS2: f64 = 0.3;
/// A point that was reached stays reached within this multiple of its radius.
const HYSTERESIS: f64 = 1.5;

/// A target for the controllers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Target {
    pub(super) point: Point,
    pub(super) height: Height,
}

impl Target {
    /// Returns the target at a place, approached with at most this speed. A craft that stops there brakes early.
    pub(super) fn towards(
        now: &NavInputs,
        ne: Vector2<f64>,
        altitude_m: f64,
        most_mps: f64,
        stops: bool,
    ) -> Self {
        let way = Vector3::new(ne.x - now.pos_ne.x, ne.y - now.pos_ne.y, altitude_m - now.alt_m);
        let distance_m = way.norm();
        let brake_mps = if stops { (2.0 * BRAKE_MPS2 * distance_m).sqrt() } else { f64::INFINITY };
        let speed_mps = most_mps.min(APPROACH_PER_S * distance_m).min(brake_mps);
        let velocity = way.try_normalize(1e-6).unwrap_or_default() * speed_mps;
        Self {
            point: Point { ne, vel_ne: velocity.xy() },
            height: Height { altitude_m, climb_mps: velocity.z },
        }
    }
}

/// The waypoint at the end of a leg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct End {
    pub(super) ne: Vector2<f64>,
    pub(super) altitude_m: f64,
    pub(super) kind: WaypointType,
    /// The next positional waypoint.
    pub(super) next: Option<Vector2<f64>>,
}

/// The state of a leg.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Leg {
    Point(PointLeg),
    Line(Line),
}

/// A leg straight to its end. Each condition that was met stays met within its hysteresis.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct PointLeg {
    is_near: bool,
    is_level: bool,
}

/// The result of an update of a leg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Flown {
    pub(super) target: Target,
    pub(super) is_reached: bool,
    /// The radius within which the waypoint is reached, m.
    pub(super) gate_m: f64,
    /// The corner and the carrot of a line.
    pub(super) line: Option<(Corner, Followed)>,
}

impl Leg {
    /// Begins a leg to `end`. A line begins at `from`, the last target, with the speed of the last carrot, m/s.
    pub(super) fn new(end: &End, from: Vector2<f64>, carrot_mps: f64, now: &NavInputs) -> Self {
        let stops = matches!(end.kind, WaypointType::Hold | WaypointType::Land | WaypointType::Takeoff);
        if stops || end.next.is_none() {
            return Self::Point(PointLeg::default());
        }
        Self::Line(Line::new(from, carrot_mps, end.ne, &motion(now)))
    }

    /// Flies the leg for `dt` seconds with at most `cruise_mps`.
    pub(super) fn fly(
        &mut self,
        now: &NavInputs,
        end: &End,
        cruise_mps: f64,
        params: &Params,
        dt: f64,
    ) -> Flown {
        match self {
            Self::Point(leg) => {
                let (is_reached, gate_m) = leg.reached(now, end, params);
                let target = Target::towards(now, end.ne, end.altitude_m, cruise_mps, true);
                Flown { target, is_reached, gate_m, line: None }
            }
            Self::Line(line) => {
                let corner = Corner::new([line.start(), end.ne], end.next, end.kind, cruise_mps, params);
                let next_rad = end.next.map(|next| bearing_rad(next - end.ne));
                let followed = line.follow(&motion(now), &corner, next_rad, cruise_mps, params, dt);
                let target = Target::towards(now, followed.carrot, end.altitude_m, cruise_mps, false);
                Flown {
                    target,
                    is_reached: followed.is_reached,
                    gate_m: corner.gate_m,
                    line: Some((corner, followed)),
                }
            }
        }
    }
}

impl PointLeg {
    /// Returns `true` if the end is reached, and the radius in use, m.
    fn reached(&mut self, now: &NavInputs, end: &End, params: &Params) -> (bool, f64) {
        let (radius_m, needs_level) = match end.kind {
            WaypointType::Hold | WaypointType::Land | WaypointType::Takeoff => (params.hold_radius_m(), true),
            _ => (params.arrival_radius_m(), false),
        };
        let within = |was: bool, error_m: f64| error_m <= if was { HYSTERESIS } else { 1.0 } * radius_m;
        self.is_near = within(self.is_near, (end.ne - now.pos_ne).norm());
        self.is_level = within(self.is_level, (end.altitude_m - now.alt_m).abs());
        (self.is_near && (self.is_level || !needs_level), radius_m)
    }
}

/// Returns the bearing of a way north and east, rad clockwise from north.
pub(super) fn bearing_rad(way: Vector2<f64>) -> f64 {
    crate::math::atan2(way.y, way.x)
}

fn motion(now: &NavInputs) -> Motion {
    Motion { ne: now.pos_ne, speed_mps: now.vel_ne.norm(), heading_rad: now.heading_rad }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn end(kind: WaypointType, next: Option<Vector2<f64>>) -> End {
        End { ne: Vector2::new(100.0, 0.0), altitude_m: 20.0, kind, next }
    }

    fn at(north_m: f64, alt_m: f64) -> NavInputs {
        NavInputs { pos_ne: Vector2::new(north_m, 0.0), alt_m, ..NavInputs::hovering() }
    }

    #[test]
    fn a_point_is_approached_with_a_braking_of_a_third_of_a_metre_per_second_squared() {
        let speed = |distance_m: f64| {
            let target =
                Target::towards(&at(100.0 - distance_m, 20.0), Vector2::new(100.0, 0.0), 20.0, 5.0, true);
            target.point.vel_ne.norm()
        };
        assert!((speed(30.0) - 18_f64.sqrt()).abs() < 1e-9);
        assert_eq!(speed(80.0), 5.0);
        assert!((speed(0.5) - 0.5).abs() < 1e-9, "the distance itself is slower below 0.6 m");
    }

    #[test]
    fn a_target_above_is_climbed_to_on_the_way() {
        let target = Target::towards(&at(97.0, 16.0), Vector2::new(100.0, 0.0), 20.0, 5.0, false);
        assert!((target.point.vel_ne.x - 3.0).abs() < 1e-9 && (target.height.climb_mps - 4.0).abs() < 1e-9);
    }

    #[test]
    fn a_hold_is_reached_in_place_and_height_and_stays_so_within_half_a_radius_more() {
        let (end, params) = (end(WaypointType::Hold, None), Params::default());
        let mut leg = Leg::new(&end, Vector2::zeros(), 0.0, &at(0.0, 20.0));
        let mut reached = |now: &NavInputs| leg.fly(now, &end, 5.0, &params, 0.01).is_reached;
        assert!(!reached(&at(97.9, 20.0)) && !reached(&at(98.1, 16.9)));
        assert!(reached(&at(98.1, 18.5)) && reached(&at(97.1, 17.5)));
        assert!(!reached(&at(96.9, 20.0)));
    }

    #[test]
    fn the_last_flyover_is_a_point_and_one_before_another_is_a_line() {
        let (params, now) = (Params::default(), at(0.0, 20.0));
        let next = Some(Vector2::new(100.0, 100.0));
        for (kind, next, is_line) in [
            (WaypointType::Flyover, None, false),
            (WaypointType::Flyover, next, true),
            (WaypointType::Flyby, next, true),
            (WaypointType::Hold, next, false),
        ] {
            let end = end(kind, next);
            let flown = Leg::new(&end, Vector2::zeros(), 0.0, &now).fly(&now, &end, 5.0, &params, 0.01);
            assert_eq!(flown.line.is_some(), is_line, "{kind}");
        }
    }
}
