//! Estimates the throttle that holds the craft, independently of the parameter.

use crate::geo::GRAVITY;
use crate::math;

/// The lower limit of the estimated hover throttle, µs.
pub const HOVER_MIN_US: f64 = 1050.0;
/// The upper limit of the estimated hover throttle, µs.
pub const HOVER_MAX_US: f64 = 1900.0;
/// The time constant of the filters on throttle and climb rate, s.
const FILTER_S: f64 = 0.15;
/// The time constant of the estimate while something else flies and right after engaging, s.
const FAST_S: f64 = 0.8;
/// The time of quiet flight after engaging in which the estimate is followed, s.
const FAST_FOR_S: f64 = 5.0;
/// The time constant with which the altitude integral becomes hover throttle, s.
const SLOW_S: f64 = 10.0;
/// The altitude error beyond which the altitude integral almost stops, m.
const FAR_M: f64 = 2.0;
/// The time constant, besides the fast one, with which the estimate is followed beyond that error, s: something has
/// changed.
const FAR_S: f64 = 1.0;
/// The throttle is the hover throttle while the craft is slower than this, m/s, accelerates less than this, m/s², and
/// tilts less than this, for this time, s. A steady climb has no acceleration either, but needs throttle against
/// inflow and drag.
const STILL_CLIMB_MPS: f64 = 0.3;
const STILL_ACCEL_MPS2: f64 = 0.5;
const STILL_TILT_RAD: f64 = 15.0 * std::f64::consts::PI / 180.0;
const STILL_S: f64 = 0.5;
/// The maximum throttle that drag and inflow are assumed to cost in a climb, and to give back in a descent, µs per
/// m/s.
const CLIMB_LOSS_US: f64 = 300.0;
/// The time that the craft must have been airborne before an estimate counts at engagement, s.
const SETTLED_S: f64 = 2.0;
/// The altitude above home from which the craft counts as airborne, m.
const AIRBORNE_M: f64 = 1.0;

/// Estimates the hover throttle from the vertical balance. Thrust grows about with the square of the throttle above
/// its zero, so a craft that accelerates upwards by `a` hovers at `zero + (throttle − zero)·√(cos tilt/(1 + a/g))`.
#[derive(Debug, Clone, PartialEq)]
pub struct HoverThrottleEstimator {
    /// Hover throttle in use, µs.
    hover_us: f64,
    /// Estimate from the balance while the craft hovers, µs, if there is one.
    estimate_us: Option<f64>,
    /// Balance at any speed, µs: more than the hover throttle in a climb, less in a descent.
    balance_us: Option<f64>,
    throttle_filter: f64,
    climb_filter: f64,
    /// Vertical acceleration, m/s².
    accel: f64,
    airborne_s: f64,
    /// The time that the throttle has been the hover throttle, s.
    still_s: f64,
    /// Hover throttle found at a lift-off, µs.
    found_us: Option<f64>,
    /// Quiet time in the air since engaging, s.
    followed_s: f64,
}

impl Default for HoverThrottleEstimator {
    fn default() -> Self {
        Self {
            hover_us: 1500.0,
            estimate_us: None,
            balance_us: None,
            throttle_filter: 0.0,
            climb_filter: 0.0,
            accel: 0.0,
            airborne_s: 0.0,
            still_s: 0.0,
            found_us: None,
            followed_s: 0.0,
        }
    }
}

/// The input of the estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HoverMeasurement {
    /// Throttle that the mixer used in the previous cycle, µs.
    pub throttle_us: f64,
    /// Throttle that gives zero thrust, µs.
    pub zero_us: f64,
    /// Climb rate, m/s.
    pub climb_mps: f64,
    /// Altitude above home, m.
    pub altitude_m: f64,
    /// Cosine of the tilt.
    pub cos_tilt: f64,
}

impl HoverThrottleEstimator {
    /// Returns the hover throttle in use, µs.
    pub fn hover_us(&self) -> f64 {
        self.hover_us
    }

    /// Returns the throttle that balances the weight, at any speed, µs. In a climb it also contains the share of
    /// inflow and drag.
    pub fn balance_us(&self) -> Option<f64> {
        self.balance_us
    }

    /// Returns the vertical acceleration of the last cycle, m/s².
    pub fn accel_mps2(&self) -> f64 {
        self.accel
    }

    /// Returns the hover throttle learned in this flight, µs, or `None` before.
    pub fn learned_us(&self) -> Option<f64> {
        self.held_us().or(self.found_us)
    }

    /// Returns the throttle that held the craft in a hover of this flight, µs, or `None` before.
    pub fn held_us(&self) -> Option<f64> {
        self.estimate_us.filter(|_| self.airborne_s >= SETTLED_S)
    }

    /// Takes one cycle, whatever flew it. Ignores a cycle with a value that is not finite.
    pub fn update(&mut self, now: &HoverMeasurement, dt: f64) {
        if !(now.throttle_us + now.climb_mps + now.altitude_m + now.cos_tilt + dt).is_finite() {
            return;
        }
        let Some(balance_us) = self.balance_us else {
            self.balance_us = Some(now.throttle_us);
            self.throttle_filter = now.throttle_us;
            self.climb_filter = now.climb_mps;
            return;
        };
        let k = dt / (FILTER_S + dt);
        self.throttle_filter += (now.throttle_us - self.throttle_filter) * k;
        let climb_before = self.climb_filter;
        self.climb_filter += (now.climb_mps - self.climb_filter) * k;
        let accel = if dt > 0.0 { (self.climb_filter - climb_before) / dt } else { 0.0 };
        self.accel = accel;
        let load = (1.0 + accel / GRAVITY).clamp(0.3, 3.0);
        let balance = (now.cos_tilt.clamp(0.5, 1.0) / load).sqrt();
        let instant = now.zero_us + (self.throttle_filter - now.zero_us) * balance;
        let step = dt / (FAST_S + dt);
        self.balance_us = Some(balance_us + (instant - balance_us) * step);
        self.airborne_s = if now.altitude_m > AIRBORNE_M { self.airborne_s + dt } else { 0.0 };
        let is_still = now.climb_mps.abs() < STILL_CLIMB_MPS
            && accel.abs() < STILL_ACCEL_MPS2
            && now.cos_tilt > math::cos(STILL_TILT_RAD);
        self.still_s = if is_still { self.still_s + dt } else { 0.0 };
        if self.hovers() && self.airborne_s > 0.0 {
            let estimate = self.estimate_us.unwrap_or(instant);
            self.estimate_us = Some(estimate + (self.bounded(estimate, instant) - estimate) * step);
        }
    }

    /// Returns `true` if the throttle is the hover throttle.
    fn hovers(&self) -> bool {
        self.still_s >= STILL_S
    }

    /// Reports that the throttle above `zero_us` (µs) has just lifted the craft off the ground, at a load of `load`
    /// times gravity.
    pub fn lift_off(&mut self, load: f64, zero_us: f64) {
        // The filtered throttle lags just as the thrust and its measurement do.
        let hover_us = zero_us + (self.throttle_filter - zero_us) / load.clamp(1.0, 4.0).sqrt();
        self.hover_us =
            if hover_us.is_finite() { hover_us.clamp(HOVER_MIN_US, HOVER_MAX_US) } else { self.hover_us };
        self.estimate_us = None;
        self.followed_s = 0.0;
        self.found_us = Some(self.hover_us);
    }

    /// Chooses the hover throttle at engagement: the throttle that held the craft in a hover, else the one found at
    /// the lift-off or `configured_us`, within the limits of the balance.
    pub fn engage(&mut self, configured_us: f64) {
        let hover_us = self.held_us().unwrap_or_else(|| {
            // Near the ground a craft lifts off with less throttle than it hovers with.
            let guess_us = self.found_us.unwrap_or(configured_us);
            let balance_us = self.balance_us.filter(|_| self.airborne_s >= SETTLED_S);
            balance_us.map_or(guess_us, |balance_us| self.bounded(guess_us, balance_us))
        });
        self.hover_us = hover_us.clamp(HOVER_MIN_US, HOVER_MAX_US);
        // A throttle that held the craft needs no quick correction. A climb right after engaging would only mislead
        // it.
        self.followed_s = if self.learned_us().is_some() { FAST_FOR_S } else { 0.0 };
    }

    /// Follows the estimate in the first quiet seconds in the air, and whenever the altitude error is so large that
    /// the integral rests. Otherwise takes over the altitude `integral_us` bit by bit. Returns the amount that the
    /// integral must give up.
    ///
    /// Learns only while the craft hovers. Before its first hover, the estimate stays within the limits of the
    /// balance, since waiting could let the craft sink.
    pub fn learn(&mut self, integral_us: f64, error_m: f64, dt: f64) -> f64 {
        let is_new = self.followed_s < FAST_FOR_S;
        let before = self.hover_us;
        if !self.hovers() {
            if self.learned_us().is_some() {
                return 0.0;
            }
            // The integral may already contain a part of it, so the sum of both changes only as far as the limit
            // requires.
            let share = dt / (FAST_S + self.followed_s);
            let bounded = |us: f64| self.balance_us.map_or(us, |balance_us| self.bounded(us, balance_us));
            let sum_us = before + integral_us;
            let sum_change_us = (bounded(sum_us) - sum_us) * share;
            self.follow(Some(bounded(before)), share);
            return self.hover_us - before - sum_change_us;
        }
        let is_far = error_m.abs() > FAR_M;
        if is_new || is_far {
            let followed_s = if is_far { self.followed_s.min(FAR_S) } else { self.followed_s };
            self.follow(self.estimate_us, dt / (FAST_S + followed_s));
            if is_new && self.airborne_s > 0.0 {
                self.followed_s += dt;
            }
            return 0.0;
        }
        self.hover_us = (before + integral_us * dt / SLOW_S).clamp(HOVER_MIN_US, HOVER_MAX_US);
        self.hover_us - before
    }

    /// Returns the hover throttle nearest to a guess that the balance allows, µs. Drag and inflow cost throttle in a
    /// climb and give some back in a descent: a climbing craft hovers with at most its balance, a sinking one with at
    /// least that. A value learned in a climb must not prolong the climb, so the guess is kept as far as the climb
    /// can explain it.
    fn bounded(&self, guess_us: f64, balance_us: f64) -> f64 {
        let loss_us = CLIMB_LOSS_US * self.climb_filter;
        guess_us.max(balance_us - loss_us.max(0.0)).min(balance_us - loss_us.min(0.0))
    }

    fn follow(&mut self, estimate_us: Option<f64>, share: f64) {
        let before = self.hover_us;
        let estimate = estimate_us.unwrap_or(before);
        // A craft on the ground needs at least the throttle that did not lift it.
        let estimate = if self.airborne_s > 0.0 { estimate } else { estimate.max(before) };
        self.hover_us = (before + (estimate - before) * share).clamp(HOVER_MIN_US, HOVER_MAX_US);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f64 = 0.01;

    /// Returns a craft at rest on level ground at this throttle, µs.
    fn on_ground(throttle_us: f64) -> HoverMeasurement {
        HoverMeasurement { throttle_us, zero_us: 1050.0, climb_mps: 0.0, altitude_m: 0.0, cos_tilt: 1.0 }
    }

    /// Returns the estimator of a craft that was expected to hover at 1500 µs and did this for ten seconds.
    fn after_10_s(now: &HoverMeasurement) -> HoverThrottleEstimator {
        let mut estimator = HoverThrottleEstimator::default();
        estimator.engage(1500.0);
        for _ in 0..1000 {
            estimator.update(now, DT);
            estimator.learn(0.0, 0.0, DT);
        }
        estimator
    }

    #[test]
    fn the_throttle_of_a_hover_is_learned() {
        let estimator = after_10_s(&HoverMeasurement { altitude_m: 5.0, ..on_ground(1350.0) });
        assert!(estimator.learned_us().is_some_and(|us| (us - 1350.0).abs() < 1.0));
        assert!((estimator.hover_us() - 1350.0).abs() < 20.0, "{}", estimator.hover_us());
    }

    #[test]
    fn the_throttle_of_a_craft_on_the_ground_is_not_learned() {
        let mut estimator = after_10_s(&on_ground(1150.0));
        assert_eq!(estimator.learned_us(), None);
        assert!((estimator.hover_us() - 1500.0).abs() < 1.0, "{}", estimator.hover_us());
        // A craft that climbs away without a hover has not shown its hover throttle either.
        for step in 0..300 {
            let altitude_m = 1.1 + 0.02 * f64::from(step);
            estimator.update(&HoverMeasurement { altitude_m, climb_mps: 2.0, ..on_ground(1600.0) }, DT);
        }
        assert_eq!(estimator.learned_us(), None);
        estimator.engage(1500.0);
        assert!((estimator.hover_us() - 1500.0).abs() < 1.0, "{}", estimator.hover_us());
    }

    #[test]
    fn a_throttle_that_does_not_lift_a_craft_off_a_slope_is_less_than_its_hover_throttle() {
        let cos_tilt = 20_f64.to_radians().cos();
        let estimator = after_10_s(&HoverMeasurement { cos_tilt, ..on_ground(1200.0) });
        assert_eq!(estimator.learned_us(), None);
        assert!(estimator.hover_us() > 1499.0, "{}", estimator.hover_us());
    }
}
