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
/// Throttle is hover throttle while the craft is slower than this, m/s, accelerates less than this, m/s², and leans less
/// than this, for so long, s. A steady climb has no acceleration either, but needs throttle against inflow and drag.
const STILL_CLIMB_MPS: f64 = 0.3;
const STILL_ACCEL_MPS2: f64 = 0.5;
const STILL_LEAN_RAD: f64 = 15.0 * std::f64::consts::PI / 180.0;
const STILL_S: f64 = 0.5;
/// Most throttle that a climb is assumed to take from drag and inflow, and that a descent gives back, µs per m/s.
const CLIMB_LOSS_US: f64 = 300.0;
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
    /// Estimate from the balance while the craft hovers, µs, when there is one.
    estimate_us: Option<f64>,
    /// Balance at any speed, µs: more than the hover throttle in a climb, less in a descent.
    balance_us: Option<f64>,
    throttle_filter: f64,
    climb_filter: f64,
    /// Vertical acceleration, m/s².
    accel: f64,
    airborne_s: f64,
    /// How long the throttle has been hover throttle, s.
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
    pub fn hover_us(&self) -> f64 {
        self.hover_us
    }

    /// Throttle that balances the weight, at any speed, µs; in a climb it holds what inflow and drag take, too.
    pub fn balance_us(&self) -> Option<f64> {
        self.balance_us
    }

    /// Vertical acceleration of the last cycle, m/s².
    pub fn accel_mps2(&self) -> f64 {
        self.accel
    }

    /// The hover throttle that this flight has shown, µs; `None` before.
    pub fn learned_us(&self) -> Option<f64> {
        self.held_us().or(self.found_us)
    }

    /// The throttle that held the craft in a hover of this flight, µs; `None` before.
    pub fn held_us(&self) -> Option<f64> {
        self.estimate_us.filter(|_| self.airborne_s >= SETTLED_S)
    }

    /// Takes one cycle, flown by anyone; one that is not finite is left out.
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
            && now.cos_tilt > STILL_LEAN_RAD.cos();
        self.still_s = if is_still { self.still_s + dt } else { 0.0 };
        if self.hovers() && self.airborne_s > 0.0 {
            let estimate = self.estimate_us.unwrap_or(instant);
            self.estimate_us = Some(estimate + (self.bounded(estimate, instant) - estimate) * step);
        }
    }

    /// Returns whether the throttle is hover throttle.
    fn hovers(&self) -> bool {
        self.still_s >= STILL_S
    }

    /// The craft has just been lifted off the ground by the throttle above `zero_us` (µs), feeling `load` times gravity.
    pub fn lift_off(&mut self, load: f64, zero_us: f64) {
        // The filtered throttle lags behind as the thrust and what is felt of it do.
        let hover_us = zero_us + (self.throttle_filter - zero_us) / load.clamp(1.0, 4.0).sqrt();
        self.hover_us =
            if hover_us.is_finite() { hover_us.clamp(HOVER_MIN_US, HOVER_MAX_US) } else { self.hover_us };
        self.estimate_us = None;
        self.followed_s = 0.0;
        self.found_us = Some(self.hover_us);
    }

    /// Chooses the hover throttle at engaging: what held the craft in a hover, else what was found at the lift-off or
    /// `configured_us`, as far as the balance allows it.
    pub fn engage(&mut self, configured_us: f64) {
        let hover_us = self.held_us().unwrap_or_else(|| {
            // Near the ground a craft lifts off with less than it hovers with.
            let guess_us = self.found_us.unwrap_or(configured_us);
            let balance_us = self.balance_us.filter(|_| self.airborne_s >= SETTLED_S);
            balance_us.map_or(guess_us, |balance_us| self.bounded(guess_us, balance_us))
        });
        self.hover_us = hover_us.clamp(HOVER_MIN_US, HOVER_MAX_US);
        // What held the craft needs no quick correction: a climb right after engaging would only mislead it.
        self.followed_s = if self.learned_us().is_some() { FAST_FOR_S } else { 0.0 };
    }

    /// Follows the estimate in the first quiet seconds in the air, and whenever the altitude error is so large that the
    /// integral rests; otherwise takes over the altitude `integral_us` bit by bit. Returns what the integral has to give
    /// up. Learns only while the craft hovers; before its first hover it keeps within the limit of the balance, since waiting
    /// could take the craft down.
    pub fn learn(&mut self, integral_us: f64, error_m: f64, dt: f64) -> f64 {
        let is_new = self.followed_s < FAST_FOR_S;
        let before = self.hover_us;
        if !self.hovers() {
            if self.learned_us().is_some() {
                return 0.0;
            }
            // The integral may hold a part of it already: the sum of both changes only as far as the limit asks.
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

    /// Returns the hover throttle nearest to a guess that the balance allows, µs. Drag and inflow take throttle in a climb and
    /// give some in a descent: a climbing craft hovers with at most its balance, a sinking one with at least that. What is
    /// learned in a climb must not carry it on, so the guess is kept as far as the climb can explain it.
    fn bounded(&self, guess_us: f64, balance_us: f64) -> f64 {
        let loss_us = CLIMB_LOSS_US * self.climb_filter;
        guess_us.max(balance_us - loss_us.max(0.0)).min(balance_us - loss_us.min(0.0))
    }

    fn follow(&mut self, estimate_us: Option<f64>, share: f64) {
        let before = self.hover_us;
        let estimate = estimate_us.unwrap_or(before);
        // A craft that stands on the ground needs at least the throttle that did not lift it.
        let estimate = if self.airborne_s > 0.0 { estimate } else { estimate.max(before) };
        self.hover_us = (before + (estimate - before) * share).clamp(HOVER_MIN_US, HOVER_MAX_US);
    }
}
