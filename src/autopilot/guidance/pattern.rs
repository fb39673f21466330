//! Hold patterns: a target that moves at a constant angular rate, and the remaining time of a hold.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use nalgebra::Vector2;

use crate::autopilot::params::Params;
use crate::geo::GRAVITY;
use crate::math;
use crate::plan::Seconds;

/// A point on a pattern, relative to the waypoint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PatternPoint {
    /// Offset from the waypoint (north, east), m.
    pub offset: Vector2<f64>,
    /// Direction of motion, rad clockwise from north.
    pub heading_rad: f64,
    /// Change of position per radian of phase (north, east), m. Multiplied by the phase rate it is the target's
    /// velocity.
    pub tangent: Vector2<f64>,
    /// Second derivative by phase, m. Multiplied by the square of the phase rate it is the target's acceleration.
    pub curvature: Vector2<f64>,
}

/// Returns a point on a circle that runs clockwise. Phase 0 is north of the waypoint.
pub fn orbit(radius_m: f64, phase_rad: f64) -> PatternPoint {
    let (sin, cos) = math::sin_cos(phase_rad);
    PatternPoint {
        offset: Vector2::new(cos, sin) * radius_m,
        heading_rad: (phase_rad + FRAC_PI_2).rem_euclid(TAU),
        tangent: Vector2::new(-sin, cos) * radius_m,
        curvature: Vector2::new(-cos, -sin) * radius_m,
    }
}

/// Returns a point on two circles that touch at the waypoint: first the western one clockwise, then the eastern one
/// counter-clockwise. `width_m` is the distance between their centres and the phase runs over 4π. The pattern passes
/// the waypoint heading south.
pub fn figure8(width_m: f64, phase_rad: f64) -> PatternPoint {
    let radius = width_m / 2.0;
    let phase = phase_rad.rem_euclid(2.0 * TAU);
    let (side, sense, compass) =
        if phase < TAU { (-1.0, 1.0, FRAC_PI_2 + phase) } else { (1.0, -1.0, 1.5 * PI - (phase - TAU)) };
    let (sin, cos) = math::sin_cos(compass);
    PatternPoint {
        offset: Vector2::new(0.0, side * radius) + Vector2::new(cos, sin) * radius,
        heading_rad: (compass + sense * FRAC_PI_2).rem_euclid(TAU),
        tangent: Vector2::new(-sin, cos) * (sense * radius),
        curvature: Vector2::new(-cos, -sin) * radius,
    }
}

/// Returns the angular rate along a circle of `radius_m`, rad/s: `ap_max_turn_rate`, limited by the speed of the leg
/// and by half the acceleration of the maximum tilt, so that the circle can be flown.
pub fn pattern_rate_rps(radius_m: f64, leg_speed_mps: f64, params: &Params) -> f64 {
    let radius = radius_m.max(0.1);
    let by_tilt = (0.5 * GRAVITY * math::tan(params.max_tilt_rad()) / radius).sqrt();
    f64::from(params.max_turn_rate).to_radians().min(leg_speed_mps / radius).min(by_tilt)
}

/// Returns the remaining time of a hold, s, rounded down to tenths. It is infinite if the hold is endless.
pub fn hold_remaining_s(duration: Seconds, elapsed_us: u64) -> f64 {
    if duration.is_zero() {
        return f64::INFINITY;
    }
    let left_us = duration.micros().saturating_sub(elapsed_us);
    (left_us / 100_000) as f64 / 10.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn figure8_has_no_jump_and_its_tangent_is_its_motion(phase in 0.0..(2.0 * TAU), width in 5.0..100.0_f64) {
            let step = 1e-4;
            let (a, b) = (figure8(width, phase), figure8(width, phase + step));
            let moved = b.offset - a.offset;
            prop_assert!(moved.norm() <= width / 2.0 * step * 1.001);
            prop_assert!((moved / step - a.tangent).norm() < width * 1e-3);
        }

        #[test]
        fn a_faster_turn_rate_is_never_slower(rate in 1_u8..89, radius in 3.0..50.0) {
            let slow = Params { max_turn_rate: rate, ..Params::default() };
            let fast = Params { max_turn_rate: rate + 1, ..Params::default() };
            prop_assert!(pattern_rate_rps(radius, 5.0, &fast) >= pattern_rate_rps(radius, 5.0, &slow));
        }
    }
}
