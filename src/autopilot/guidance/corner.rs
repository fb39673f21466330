//! The arrival at a waypoint that is flown past.

use nalgebra::Vector2;

use crate::math;

/// Gravity of the turn radius, m/s²; the value that the radius has always been computed with.
const TURN_GRAVITY: f64 = 9.8;

/// Returns the distance before a FLYBY waypoint at which the turn begins, m: `R = V²/(g·tan θ)` for the ground speed
/// (m/s, at least 1) and the maximum tilt (rad), within 0.5…1000 m. It is the exact tangent distance of a 90° corner.
pub fn turn_radius_m(ground_speed_mps: f64, max_tilt_rad: f64) -> f64 {
    let tan = math::tan(max_tilt_rad);
    if tan < 0.1 {
        return 1000.0;
    }
    let speed = ground_speed_mps.max(1.0);
    (speed * speed / (TURN_GRAVITY * tan)).clamp(0.5, 1000.0)
}

/// The shortest leg (m) that has a direction.
pub(crate) const MIN_LEG_M: f64 = 0.1;

/// The position of a step of the craft relative to the vertical plane through a waypoint, perpendicular to the
/// inbound leg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PlaneCrossing {
    /// The leg is too short to have a direction. Only the distance decides.
    NoLeg,
    /// The craft is before the plane.
    Before {
        /// Distance to the plane, m.
        to_go_m: f64,
    },
    /// This step crossed the plane.
    Crossed {
        /// Distance from the waypoint to the point of the crossing, m.
        lateral_m: f64,
    },
    /// The craft was already behind the plane.
    Behind,
}

/// Returns the position of the step from `previous` to `position` relative to the plane of `waypoint`, for a leg from
/// `leg_start` (all north, east, m).
pub fn plane_crossing(
    leg_start: Vector2<f64>,
    waypoint: Vector2<f64>,
    previous: Vector2<f64>,
    position: Vector2<f64>,
) -> PlaneCrossing {
    let leg = waypoint - leg_start;
    let length = leg.norm();
    if length < MIN_LEG_M {
        return PlaneCrossing::NoLeg;
    }
    let along = leg / length;
    let before = (previous - waypoint).dot(&along);
    let now = (position - waypoint).dot(&along);
    if now < 0.0 {
        return PlaneCrossing::Before { to_go_m: -now };
    }
    if before >= 0.0 {
        return PlaneCrossing::Behind;
    }
    let crossing = previous + (position - previous) * (-before / (now - before));
    PlaneCrossing::Crossed { lateral_m: along.perp(&(crossing - waypoint)).abs() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn turn_radius_at_5_mps_and_25_deg() {
        assert!((turn_radius_m(5.0, 25_f64.to_radians()) - 5.47).abs() < 0.01);
    }

    #[test]
    fn the_plane_is_at_the_waypoint_wherever_that_is() {
        let (start, waypoint) = (Vector2::new(100.0, -50.0), Vector2::new(300.0, -50.0));
        let step = |from: f64, to: f64| {
            plane_crossing(start, waypoint, Vector2::new(from, -48.0), Vector2::new(to, -48.0))
        };
        assert_eq!(step(290.0, 295.0), PlaneCrossing::Before { to_go_m: 5.0 });
        assert_eq!(step(299.0, 303.0), PlaneCrossing::Crossed { lateral_m: 2.0 });
        assert_eq!(step(303.0, 307.0), PlaneCrossing::Behind);
    }

    proptest! {
        #[test]
        fn a_step_crosses_once_however_it_is_cut(
            start in (-500.0..500.0_f64, -500.0..500.0_f64), cut in 0.01..0.99_f64,
            lateral in -30.0..30.0_f64,
        ) {
            let start = Vector2::new(start.0, start.1);
            prop_assume!(start.norm() > 1.0);
            let along = -start.normalize();
            let side = Vector2::new(-along.y, along.x) * lateral;
            let (from, to) = (side - along * 3.0, side + along * 2.0);
            let middle = from + (to - from) * cut;
            let steps = [plane_crossing(start, Vector2::zeros(), from, middle),
                plane_crossing(start, Vector2::zeros(), middle, to)];
            let crossed: Vec<f64> = steps.iter().filter_map(|step| match step {
                PlaneCrossing::Crossed { lateral_m } => Some(*lateral_m),
                PlaneCrossing::NoLeg | PlaneCrossing::Before { .. } | PlaneCrossing::Behind => None,
            }).collect();
            prop_assert_eq!(crossed.len(), 1);
            prop_assert!((crossed[0] - lateral.abs()).abs() < 1e-6);
        }
    }
}
