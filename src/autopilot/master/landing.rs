//! The descent of a landing, and its touchdown.

use super::altitude::Height;
use super::leg::Target;
use crate::autopilot::io::NavInputs;
use crate::autopilot::params::Params;
use nalgebra::Vector2;

/// The target lies this far below the craft at the begin, m.
const BELOW_M: f64 = 200.0;
/// The slowest descent that is commanded, m/s.
const SLOWEST_MPS: f64 = 0.3;
/// A touchdown is watched for once the descent has reached this share of its rate, or below `ap_landing_altitude_m` after
/// this time, s. A descent slower than this share is a sign of the ground.
const SHARE: f64 = 0.25;
const LOW_AFTER_S: f64 = 5.0;

/// The state of a descent.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Descent {
    ne: Vector2<f64>,
    bottom_m: f64,
    since_s: f64,
    has_descended: bool,
    /// The time for which the signs of the ground have lasted, s.
    grounded_s: f64,
}

impl Descent {
    /// Begins a descent to a place.
    pub(super) fn new(ne: Vector2<f64>, now: &NavInputs) -> Self {
        let bottom_m = now.alt_m - BELOW_M;
        Self { ne, bottom_m, since_s: 0.0, has_descended: false, grounded_s: 0.0 }
    }

    /// Returns the time for which the signs of the ground have lasted, s.
    pub(super) fn grounded_s(&self) -> f64 {
        self.grounded_s
    }

    /// Returns the target after `dt` seconds of a descent at this rate, and `true` once the craft has touched down.
    pub(super) fn follow(
        &mut self,
        now: &NavInputs,
        rate_mps: f64,
        params: &Params,
        dt: f64,
    ) -> (Target, bool) {
        let sink_mps = -now.climb_mps;
        self.since_s += dt;
        self.has_descended |= sink_mps >= SHARE * rate_mps;
        let is_low = now.alt_m < f64::from(params.landing_altitude_m) && self.since_s >= LOW_AFTER_S;
        let is_still = sink_mps < SHARE * rate_mps
            && now.climb_mps.abs() < 0.01 * f64::from(params.landing_velocity_threshold);
        let is_grounded = is_still && (self.has_descended || is_low);
        self.grounded_s = if is_grounded { self.grounded_s + dt } else { 0.0 };
        let speed_mps = rate_mps.max(SLOWEST_MPS);
        let target = Target::towards(now, self.ne, self.bottom_m, speed_mps, false);
        let height = Height { altitude_m: self.bottom_m, ..target.height };
        let needed_s = 0.1 * f64::from(params.landing_detection_time);
        (Target { height, ..target }, self.grounded_s >= needed_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn falling(alt_m: f64, climb_mps: f64) -> NavInputs {
        NavInputs { alt_m, climb_mps, ..NavInputs::hovering() }
    }

    #[test]
    fn the_descent_is_nearly_vertical_at_its_rate_towards_a_point_far_below() {
        let params = Params::default();
        let mut descent = Descent::new(Vector2::new(2.0, 0.0), &falling(20.0, 0.0));
        let (target, _) = descent.follow(&falling(20.0, 0.0), 2.0, &params, 0.01);
        assert_eq!(target.height.altitude_m, -180.0);
        assert!((target.height.climb_mps + 2.0).abs() < 1e-3, "{target:?}");
        assert!((target.point.vel_ne.norm() - 0.02).abs() < 1e-3);
    }

    #[test]
    fn a_craft_that_stops_sinking_for_a_second_has_touched_down() {
        let params = Params::default();
        let mut descent = Descent::new(Vector2::zeros(), &falling(20.0, 0.0));
        let mut lands = |now: &NavInputs, seconds: f64| {
            (0..(seconds / 0.01) as usize).any(|_| descent.follow(now, 1.0, &params, 0.01).1)
        };
        assert!(!lands(&falling(20.0, 0.0), 3.0), "it has not descended yet");
        assert!(!lands(&falling(10.0, -1.0), 10.0));
        assert!(!lands(&falling(0.0, -0.1), 0.98) && lands(&falling(0.0, -0.1), 0.1));
    }

    #[test]
    fn a_craft_that_never_sinks_is_down_if_it_is_low() {
        let params = Params::default();
        let lands = |alt_m: f64| {
            let mut descent = Descent::new(Vector2::zeros(), &falling(alt_m, 0.0));
            (0..1000).position(|_| descent.follow(&falling(alt_m, 0.0), 1.0, &params, 0.01).1)
        };
        assert_eq!(lands(5.0), None);
        assert!((595..=605).contains(&lands(0.2).unwrap()), "{:?}", lands(0.2));
    }
}
