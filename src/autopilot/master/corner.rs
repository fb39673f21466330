//! The speed through a corner, and the distance from it at which its waypoint is reached.

use nalgebra::Vector2;

use crate::autopilot::params::Params;
use crate::plan::WaypointType;

/// Legs that are shorter have no direction, m.
const SHORT_M: f64 = 1.0;
/// A corner that takes less than this share of the speed is none.
const STRAIGHT: f64 = 0.05;
/// The gate of a FLYBY is the way of this time at the speed of the corner, s, within limits.
const GATE_S: f64 = 1.5;
const MAX_GATE_M: f64 = 12.0;

/// A waypoint between two legs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Corner {
    /// The speed at the waypoint, m/s.
    pub(super) speed_mps: f64,
    /// The distance at which it is reached, m.
    pub(super) gate_m: f64,
}

impl Corner {
    /// Returns the corner between the leg from `from` to `at` and the one to `next`, m north and east. `cruise_mps` is the
    /// speed of the leg.
    pub(super) fn new(
        [from, at]: [Vector2<f64>; 2],
        next: Option<Vector2<f64>>,
        kind: WaypointType,
        cruise_mps: f64,
        params: &Params,
    ) -> Self {
        let legs = next.map(|next| [at - from, next - at]);
        let speed_mps = legs.and_then(|legs| through(legs, params)).unwrap_or(f64::INFINITY).min(cruise_mps);
        let radius_m = params.arrival_radius_m().min(MAX_GATE_M);
        let gate_m = match kind {
            WaypointType::Flyby => (GATE_S * speed_mps).clamp(radius_m, MAX_GATE_M),
            _ => radius_m,
        };
        Self { speed_mps, gate_m }
    }
}

/// Returns the speed at which the turn between two legs takes `ap_nav_corner_delta_v`; `None` if they go straight on.
fn through([leg, next]: [Vector2<f64>; 2], params: &Params) -> Option<f64> {
    let (length_m, next_m) = (leg.norm(), next.norm());
    if length_m <= SHORT_M || next_m <= SHORT_M {
        return None;
    }
    // 2 sin(θ/2) is the distance between the two directions.
    let shed = (leg / length_m - next / next_m).norm();
    let speed_mps = 0.01 * f64::from(params.nav_corner_delta_v) / shed;
    (shed > STRAIGHT).then(|| speed_mps.max(0.01 * f64::from(params.nav_corner_speed)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(degrees: f64, kind: WaypointType, cruise_mps: f64) -> Corner {
        let at = Vector2::new(50.0, 0.0);
        let (sin, cos) = degrees.to_radians().sin_cos();
        let next = at + 50.0 * Vector2::new(cos, sin);
        Corner::new([Vector2::zeros(), at], Some(next), kind, cruise_mps, &Params::default())
    }

    #[test]
    fn a_sharp_corner_is_flown_slowly_but_never_below_the_corner_speed() {
        let speed = |degrees| corner(degrees, WaypointType::Flyover, 10.0).speed_mps;
        assert!((speed(90.0) - 4.4 / 2_f64.sqrt()).abs() < 1e-9);
        assert!((speed(180.0) - 2.2).abs() < 1e-9);
        assert_eq!(speed(2.0), 10.0);
        assert_eq!(corner(90.0, WaypointType::Flyover, 1.0).speed_mps, 1.0, "not faster than the leg");
    }

    #[test]
    fn the_gate_of_a_flyby_grows_with_its_speed() {
        assert_eq!(corner(90.0, WaypointType::Flyover, 10.0).gate_m, 5.0);
        assert_eq!(corner(180.0, WaypointType::Flyby, 10.0).gate_m, 5.0);
        assert!(
            (corner(45.0, WaypointType::Flyby, 10.0).gate_m
                - 1.5 * 4.4 / (2.0 * 22.5_f64.to_radians().sin()))
            .abs()
                < 1e-9
        );
        assert_eq!(corner(0.0, WaypointType::Flyby, 10.0).gate_m, 12.0);
    }

    #[test]
    fn the_last_waypoint_and_one_in_the_same_place_are_no_corner() {
        let at = Vector2::new(50.0, 0.0);
        for next in [None, Some(at)] {
            let corner =
                Corner::new([Vector2::zeros(), at], next, WaypointType::Flyover, 10.0, &Params::default());
            assert_eq!(corner, Corner { speed_mps: 10.0, gate_m: 5.0 });
        }
    }
}
