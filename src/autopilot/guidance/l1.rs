//! Follows a leg as a line with the carrot of the L1 law (S. Park, J. Deyst, J. How: "A new nonlinear guidance logic
//! for trajectory tracking", AIAA 2004-4900), with a minimum lookahead and a maximum cut-in angle.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_6, TAU};

use nalgebra::Vector2;

use super::corner::MIN_LEG_M;
use crate::autopilot::params::Params;
use crate::geo::wrap_pi;
use crate::math;
use crate::telemetry::L1Mode;

/// The steepest angle at which the craft cuts in to a line, rad.
const STEEPEST_CUT_IN: f64 = FRAC_PI_6;

/// Settings of the law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct L1Limits {
    /// Period, s. The lookahead is the distance flown in period/2π.
    pub period_s: f64,
    /// Minimum lookahead, m.
    pub min_lookahead_m: f64,
    /// Maximum lookahead, m. It takes precedence over the minimum.
    pub max_lookahead_m: f64,
    /// Cross-track error beyond which the leg is given up and starts again at the craft, m.
    pub max_cross_track_m: f64,
}

impl L1Limits {
    /// Returns the limits given by the parameters.
    pub fn from_params(params: &Params) -> Self {
        Self {
            period_s: f64::from(params.l1_period) / 10.0,
            min_lookahead_m: f64::from(params.l1_min_lookahead) / 100.0,
            max_lookahead_m: f64::from(params.l1_max_lookahead) / 100.0,
            max_cross_track_m: f64::from(params.l1_max_cross_track_error) / 100.0,
        }
    }

    fn lookahead_m(&self, ground_speed_mps: f64) -> f64 {
        (ground_speed_mps * self.period_s / TAU).max(self.min_lookahead_m).min(self.max_lookahead_m)
    }
}

/// The craft on its leg, and the point to steer for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct L1Result {
    /// Length of the leg, m.
    pub length_m: f64,
    /// Distance along the leg, m.
    pub along_m: f64,
    /// Cross-track error, m, positive right of the leg.
    pub xte_m: f64,
    /// Lookahead given by speed and limits, m.
    pub lookahead_m: f64,
    /// Lookahead after the limit of 30° on the cut-in angle, m.
    pub effective_lookahead_m: f64,
    /// The point to steer for (north, east, m).
    pub aim: Vector2<f64>,
    /// State of the aim: it moves along the leg or is pinned at its end.
    pub mode: L1Mode,
    /// `true` if the craft is too far beside the leg. The leg must start again at the craft.
    pub reanchor: bool,
    /// Angle from the ground course to the aim, rad, positive right; `None` if either has no direction.
    pub eta_rad: Option<f64>,
    /// Lateral acceleration of the law, m/s², positive right.
    pub a_lat_mps2: f64,
}

/// Steers along the leg from `start` to `end` (north, east, m) for a craft at `position` with ground `velocity` (m/s).
pub fn l1(
    start: Vector2<f64>,
    end: Vector2<f64>,
    position: Vector2<f64>,
    velocity: Vector2<f64>,
    limits: &L1Limits,
) -> L1Result {
    let leg = end - start;
    let length_m = leg.norm();
    let lookahead_m = limits.lookahead_m(velocity.norm());
    if length_m < MIN_LEG_M {
        let (eta_rad, a_lat_mps2) = steering(end - position, velocity);
        return L1Result {
            length_m,
            along_m: 0.0,
            xte_m: 0.0,
            lookahead_m,
            effective_lookahead_m: lookahead_m,
            aim: end,
            mode: L1Mode::Direct,
            reanchor: false,
            eta_rad,
            a_lat_mps2,
        };
    }
    let unit = leg / length_m;
    let relative = position - start;
    let along_m = unit.dot(&relative);
    let xte_m = unit.perp(&relative);
    let effective_lookahead_m = lookahead_m.max(xte_m.abs() / math::tan(STEEPEST_CUT_IN));
    let reanchor = xte_m.abs() > limits.max_cross_track_m;
    let carrot = (along_m + effective_lookahead_m).clamp(0.0, length_m);
    let pinned = reanchor || carrot >= length_m;
    let aim = if pinned { end } else { start + unit * carrot };
    let (eta_rad, a_lat_mps2) = steering(aim - position, velocity);
    L1Result {
        length_m,
        along_m,
        xte_m,
        lookahead_m,
        effective_lookahead_m,
        aim,
        mode: if pinned { L1Mode::Direct } else { L1Mode::Track },
        reanchor,
        eta_rad,
        a_lat_mps2,
    }
}

/// Returns the angle η from the course to the aim, and the lateral acceleration `2·V²·sin η / distance`, for which η
/// is clamped to ±90°. Returns `None` and 0 if the craft does not move or is at the aim.
fn steering(to_aim: Vector2<f64>, velocity: Vector2<f64>) -> (Option<f64>, f64) {
    let distance = to_aim.norm();
    let speed = velocity.norm();
    if distance < 1e-6 || speed < 1e-6 {
        return (None, 0.0);
    }
    // An aim directly behind the craft gives a left turn, always the same one of the two.
    let eta = -wrap_pi(bearing(velocity) - bearing(to_aim));
    (Some(eta), 2.0 * speed * speed * math::sin(eta.clamp(-FRAC_PI_2, FRAC_PI_2)) / distance)
}

fn bearing(vector: Vector2<f64>) -> f64 {
    math::atan2(vector.y, vector.x)
}

/// An arc at the start of a leg. The aim turns from the course of the corner to the line at a fixed rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CornerArc {
    /// Bearing of the aim, rad.
    pub bearing_rad: f64,
    /// Turn rate with its sign, rad/s, clockwise positive.
    rate_rps: f64,
    /// The angle that may still be turned, rad.
    left_rad: f64,
}

impl CornerArc {
    /// Returns the arc from `course_rad` to a leg on `leg_bearing_rad`, or `None` if `turn_rate_rps` is zero or the
    /// corner is no more than 20°.
    pub fn begin(course_rad: f64, leg_bearing_rad: f64, turn_rate_rps: f64) -> Option<Self> {
        let change = wrap_pi(leg_bearing_rad - course_rad);
        // Slightly above 20°, so that rounding does not start an arc at a corner of exactly 20°.
        let wanted = turn_rate_rps > 0.0 && change.abs() > 20_f64.to_radians() + 1e-9;
        wanted.then(|| Self {
            bearing_rad: course_rad,
            rate_rps: turn_rate_rps.copysign(change),
            left_rad: change.abs() + STEEPEST_CUT_IN,
        })
    }

    /// Returns the turn rate without its sign, rad/s.
    pub fn turn_rate_rps(&self) -> f64 {
        self.rate_rps.abs()
    }

    /// Turns for `dt` seconds towards `normal_bearing_rad`, the bearing of the aim on the line. Returns `false` when
    /// the arc is over: within 5° of that bearing or past it, or when the arc has turned by the corner plus the
    /// steepest cut-in to the line. Without the last limit, the craft would circle a waypoint inside the circle for
    /// ever.
    pub fn advance(&mut self, dt: f64, normal_bearing_rad: f64) -> bool {
        let left_before = wrap_pi(normal_bearing_rad - self.bearing_rad);
        self.bearing_rad = (self.bearing_rad + self.rate_rps * dt).rem_euclid(TAU);
        let left = wrap_pi(normal_bearing_rad - self.bearing_rad);
        let passed = left * left_before < 0.0 && left.abs() < FRAC_PI_2;
        self.left_rad -= (self.rate_rps * dt).abs();
        left.abs() > 5_f64.to_radians() && !passed && self.left_rad > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const LIMITS: L1Limits =
        L1Limits { period_s: 2.0, min_lookahead_m: 10.0, max_lookahead_m: 100.0, max_cross_track_m: 100.0 };

    #[test]
    fn an_arc_ends_at_the_line() {
        let mut arc = CornerArc::begin(0.0, FRAC_PI_2, 0.5).unwrap();
        let mut steps = 0;
        while arc.advance(0.1, FRAC_PI_2) {
            steps += 1;
            assert!(steps < 100);
        }
        assert!((arc.bearing_rad - 85_f64.to_radians()).abs() < 0.06);
    }

    proptest! {
        #[test]
        fn never_cuts_in_steeper_than_30_degrees(n in 0.0..300.0, e in -99.0..99.0) {
            let position = Vector2::new(n, e);
            let end = Vector2::new(2000.0, 0.0);
            let result = l1(Vector2::zeros(), end, position, Vector2::new(5.0, 0.0), &LIMITS);
            let angle = bearing(result.aim - position).abs();
            prop_assert!(angle <= FRAC_PI_6 + 1e-9);
            prop_assert!((result.xte_m - e).abs() < 1e-9 && (result.along_m - n).abs() < 1e-9);
        }

        #[test]
        fn a_longer_period_never_shortens_the_lookahead(v in 0.0..60.0, t in 0.5..9.0) {
            let longer = L1Limits { period_s: t + 1.0, ..LIMITS };
            let shorter = L1Limits { period_s: t, ..LIMITS };
            prop_assert!(longer.lookahead_m(v) >= shorter.lookahead_m(v));
        }
    }
}
