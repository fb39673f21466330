//! Estimate of the throttle that holds the craft, whatever the parameter says.

use crate::geo::GRAVITY;

/// Limits of the estimated hover throttle, µs.
pub const HOVER_MIN_US: f64 = 1050.0;
/// See [`HOVER_MIN_US`].
pub const HOVER_MAX_US: f64 = 1900.0;
/// Time constant of the filters on throttle and climb rate, s.
const FILTER_S: f64 = 0.15;
/// Time constant of the estimate while somebody else flies and right after engaging, s.
const FAST_S: f64 = 0.8;
/// How long the estimate is followed after engaging, s of quiet flight.
const FAST_FOR_S: f64 = 5.0;
/// Time constant with which the altitude integral becomes hover throttle, s.
const SLOW_S: f64 = 10.0;
/// Altitude error beyond which the integral of the altitude nearly rests, m.
const FAR_M: f64 = 2.0;
/// Time constant, beside the fast one, with which it is followed there, s: something has changed.
const FAR_S: f64 = 1.0;
/// Wanted climb rate at which the estimate follows half as fast, m/s: climbing and sinking take another throttle than hovering.
const HALF_CLIMB_MPS: f64 = 1.0;
/// How long the craft must have been airborne before an estimate counts at engaging, s.
const SETTLED_S: f64 = 2.0;
/// Altitude above home from which the craft counts as airborne, m.
const AIRBORNE_M: f64 = 1.0;

/// Estimates the hover throttle from the vertical balance: thrust grows about with the square of the throttle above its
/// zero, so a craft that accelerates upwards by `a` hovers at `zero + (throttle − zero)·√(cos tilt/(1 + a/g))`.
#[derive(Debug, Clone, PartialEq)]
pub struct HoverThrottleEstimator {
    /// Hover throttle in use, µs.
    hover_us: f64,
    /// Estimate from the balance, µs, when there is one.
    estimate_us: Option<f64>,
    throttle_filter: f64,
    climb_filter: f64,
    airborne_s: f64,
    /// The hover throttle in use was found at a lift-off.
    is_found: bool,
    /// Quiet time in the air since engaging, s.
    followed_s: f64,
}

impl Default for HoverThrottleEstimator {
    fn default() -> Self {
        Self {
            hover_us: 1500.0,
            estimate_us: None,
            throttle_filter: 0.0,
            climb_filter: 0.0,
            airborne_s: 0.0,
            is_found: false,
            followed_s: 0.0,
        }
    }
}

/// What the estimate is made from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HoverMeasurement {
    /// Throttle that drove the mixer in the previous cycle, µs.
    pub throttle_us: f64,
    /// Throttle that is zero thrust, µs.
    pub zero_us: f64,
    /// Climb rate, m/s.
    pub climb_mps: f64,
    /// Altitude above home, m.
    pub altitude_m: f64,
    /// Cosine of the tilt.
    pub cos_tilt: f64,
}

impl HoverThrottleEstimator {
    /// Hover throttle in use, µs.
    #[must_use]
    pub fn hover_us(&self) -> f64 {
        self.hover_us
    }

    /// The hover throttle that this flight has shown, µs; `None` before.
    #[must_use]
    pub fn learned_us(&self) -> Option<f64> {
        let held = self.estimate_us.filter(|_| self.airborne_s >= SETTLED_S);
        held.or(self.is_found.then_some(self.hover_us))
    }

    /// Takes one cycle, flown by anyone; one that is not finite is left out.
    pub fn update(&mut self, now: &HoverMeasurement, dt: f64) {
        if !(now.throttle_us + now.climb_mps + now.altitude_m + now.cos_tilt + dt).is_finite() {
            return;
        }
        let Some(estimate) = self.estimate_us else {
            self.estimate_us = Some(now.throttle_us);
            self.throttle_filter = now.throttle_us;
            self.climb_filter = now.climb_mps;
            return;
        };
        let k = dt / (FILTER_S + dt);
        self.throttle_filter += (now.throttle_us - self.throttle_filter) * k;
        let climb_before = self.climb_filter;
        self.climb_filter += (now.climb_mps - self.climb_filter) * k;
        let accel = if dt > 0.0 { (self.climb_filter - climb_before) / dt } else { 0.0 };
        let load = (1.0 + accel / GRAVITY).clamp(0.3, 3.0);
        let balance = (now.cos_tilt.clamp(0.5, 1.0) / load).sqrt();
        let instant = now.zero_us + (self.throttle_filter - now.zero_us) * balance;
        self.estimate_us = Some(estimate + (instant - estimate) * dt / (FAST_S + dt));
        self.airborne_s = if now.altitude_m > AIRBORNE_M { self.airborne_s + dt } else { 0.0 };
    }

    /// The craft has just been lifted off the ground by the throttle above `zero_us` (µs), feeling `load` times gravity.
    pub fn lift_off(&mut self, load: f64, zero_us: f64) {
        // The filtered throttle lags behind as the thrust and what is felt of it do.
        let hover_us = zero_us + (self.throttle_filter - zero_us) / load.clamp(1.0, 4.0).sqrt();
        self.hover_us =
            if hover_us.is_finite() { hover_us.clamp(HOVER_MIN_US, HOVER_MAX_US) } else { self.hover_us };
        self.estimate_us = Some(self.hover_us);
        self.followed_s = 0.0;
        self.is_found = true;
    }

    /// Chooses the hover throttle at engaging: what held the craft when it has been airborne for a while, else what was found
    /// at the lift-off, else `configured_us`.
    pub fn engage(&mut self, configured_us: f64) {
        let known = self.learned_us();
        self.hover_us = known.unwrap_or(configured_us).clamp(HOVER_MIN_US, HOVER_MAX_US);
        // What held the craft needs no quick correction: a climb right after engaging would only mislead it.
        self.followed_s = if known.is_some() { FAST_FOR_S } else { 0.0 };
    }

    /// Follows the estimate in the first quiet seconds in the air, and whenever the altitude error is so large that the
    /// integral rests; otherwise takes over the altitude `integral_us` bit by bit. Returns what the integral has to give
    /// up. Learns little while a climb is wanted.
    pub fn learn(&mut self, integral_us: f64, error_m: f64, wanted_climb_mps: f64, dt: f64) -> f64 {
        let before = self.hover_us;
        let quiet = 1.0 / (1.0 + (wanted_climb_mps / HALF_CLIMB_MPS).powi(2));
        let is_new = self.followed_s < FAST_FOR_S;
        if is_new || error_m.abs() > FAR_M {
            // An average over the quiet time since engaging, never faster than the estimate itself; a climb tells
            // nothing.
            // But one that runs ahead of its setpoint has the wrong hover throttle.
            let runs_ahead = error_m.abs() > FAR_M && error_m * wanted_climb_mps < 0.0;
            let quiet = if runs_ahead { 1.0 } else { quiet * quiet };
            let followed_s = if error_m.abs() > FAR_M { self.followed_s.min(FAR_S) } else { self.followed_s };
            let step = quiet * dt / (FAST_S + followed_s);
            let estimate = self.estimate_us.unwrap_or(before);
            // A craft that stands on the ground needs at least the throttle that did not lift it.
            let estimate = if self.airborne_s > 0.0 { estimate } else { estimate.max(before) };
            self.hover_us += (estimate - before) * step;
            self.hover_us = self.hover_us.clamp(HOVER_MIN_US, HOVER_MAX_US);
            if is_new && self.airborne_s > 0.0 {
                self.followed_s += quiet * dt;
            }
            return 0.0;
        }
        self.hover_us = (before + integral_us * quiet * dt / SLOW_S).clamp(HOVER_MIN_US, HOVER_MAX_US);
        self.hover_us - before
    }
}
