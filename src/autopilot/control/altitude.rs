//! Altitude control: a setpoint that moves as fast as the craft can, and the throttle that follows it.

use super::bumpless::BumplessTransfer;
use super::hover_throttle::{HoverMeasurement, HoverThrottleEstimator};
use super::spool_up::SpoolUp;
use crate::autopilot::io::NavInputs;
use crate::autopilot::params::Params;
use crate::geo::GRAVITY;
use crate::math;

/// The maximum acceleration of the setpoint, m/s².
const SETPOINT_ACCEL: f64 = 2.0;
/// The deceleration with which the setpoint approaches its target, m/s².
const SETPOINT_BRAKE: f64 = 1.0;
/// Targets this close to the altitude of home are near the ground around home, m.
const LOW_TARGET_M: f64 = 3.0;
/// The share of the height above home that a descent to a low target covers in a second, 1/s.
const FLARE: f64 = 0.25;
/// The slowest descent to a low target, m/s.
const SLOWEST_FLARE_MPS: f64 = 0.3;
/// The limit of the integral, µs.
const INTEGRAL_LIMIT_US: f64 = 200.0;
/// The vertical speed, of the setpoint or the craft, at which the integral works at half its gain, m/s.
const HALF_INTEGRAL_MPS: f64 = 0.8;
/// The time constant of the throttle for an acceleration of the setpoint, s.
const ACCEL_FILTER_S: f64 = 0.1;
/// The fastest change of the throttle, µs/s.
pub const THROTTLE_SLEW_US_PER_S: f64 = 5000.0;
/// A target this far above a craft on the ground is a request to take off, m.
const CLIMB_M: f64 = 0.3;
/// Below its setpoint by this (m) and sinking faster than this (m/s) at full throttle, the craft has too little thrust.
const BELOW_M: f64 = 0.2;
const SINKING_MPS: f64 = 0.1;
/// The throttle is one to spare when it is this far below its limit, µs.
const SPARE_US: f64 = 20.0;
/// The minimum throttle carries a craft that climbs this much faster than commanded, m/s, and decelerates no more
/// than this, m/s², for this time, s.
const CARRIED_MPS: f64 = 0.5;
const CARRIED_MPS2: f64 = 1.0;
const CARRIED_S: f64 = 1.0;
/// The throttle holds a craft that is higher than this, m, slower than this, m/s, and has a greater cosine of its
/// tilt.
const HELD_M: f64 = 1.0;
const HELD_MPS: f64 = 0.3;
const HELD_COS_TILT: f64 = 0.966;
/// The throttle range below the hover throttle that a craft needs to descend, µs, and the lowest floor that the
/// parameters allow, µs.
const DESCENT_RESERVE_US: f64 = 100.0;
const MIN_FLOOR_US: f64 = 1050.0;
/// The fastest change of the throttle limits in use, µs/s.
const LIMIT_SLEW_US_PER_S: f64 = 500.0;

/// The vertical state of the craft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AltitudeMeasurement {
    /// Altitude above home, m.
    pub altitude_m: f64,
    /// Climb rate, m/s.
    pub climb_mps: f64,
    /// Cosine of the tilt from level.
    pub cos_tilt: f64,
    /// Throttle that the mixer used in the previous cycle, µs.
    pub throttle_us: f64,
}

impl From<&NavInputs> for AltitudeMeasurement {
    fn from(now: &NavInputs) -> Self {
        Self {
            altitude_m: now.alt_m,
            climb_mps: now.climb_mps,
            cos_tilt: now.cos_tilt,
            throttle_us: now.throttle_us,
        }
    }
}

/// The target of the altitude controller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AltitudeTarget {
    /// Go to this altitude (m) and stay, within the climb rate of the parameters.
    Altitude(f64),
    /// Climb (or, negative, sink) at this rate, m/s. The setpoint never runs more than a second ahead of the craft.
    Rate(f64),
    /// Follow a setpoint that a landing moves. The integral works at full gain.
    Landing {
        /// Current altitude, m.
        setpoint_m: f64,
        /// Rate of the setpoint, m/s.
        rate_mps: f64,
    },
}

/// Everything that the throttle depends on in one update.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThrottleTerms {
    /// Setpoint minus altitude, cm.
    pub error_cm: f64,
    /// Integral, µs.
    pub integral_us: f64,
    /// Rate of the setpoint, cm/s.
    pub setpoint_rate_cms: f64,
    /// Climb rate, cm/s.
    pub climb_rate_cms: f64,
    /// Hover throttle in use, µs.
    pub hover_us: f64,
    /// Cosine of the tilt.
    pub cos_tilt: f64,
}

impl ThrottleTerms {
    /// Returns the throttle before its limits, µs: P, I, D and F around the hover throttle, compensated for the tilt.
    pub fn throttle_us(&self, params: &Params) -> f64 {
        let p = 0.01 * f64::from(params.altitude_p) * self.error_cm;
        let q = self.climb_rate_cms.abs() / 500.0;
        let boost = if q <= 1.0 { 1.0 } else { (3.0 * q - 2.0) / q };
        let d = 0.01 * f64::from(params.altitude_d) * (self.setpoint_rate_cms - self.climb_rate_cms) * boost;
        let f = 0.0033 * f64::from(params.altitude_f) * self.setpoint_rate_cms;
        let offset = p + self.integral_us + d + f + (self.hover_us - 1000.0);
        1000.0 + offset / self.cos_tilt.max(0.5)
    }
}

/// Returns a throttle pulse as a share of the mixer's range, 0…1.
pub fn throttle_share(throttle_us: f64, params: &Params) -> f64 {
    let zero = params.throttle_zero_us();
    ((throttle_us - zero) / (2000.0 - zero)).clamp(0.0, 1.0)
}

/// The altitude controller of the autopilot, altitude hold and the failsafe descent.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AltitudeController {
    hover: HoverThrottleEstimator,
    /// Hover throttle when this controller took over, µs.
    captured_us: f64,
    setpoint_m: f64,
    setpoint_rate: f64,
    integral_us: f64,
    /// Acceleration of the setpoint, m/s².
    setpoint_accel: f64,
    /// Throttle of the last update, µs.
    throttle_us: f64,
    /// Throttle subtracted from the output of the control law, µs.
    relief_us: f64,
    limits_us: Option<(f64, f64)>,
    params: Option<Params>,
    transfer: BumplessTransfer,
    on_ground: bool,
    load: f64,
    spool_up: SpoolUp,
    /// The time that the minimum throttle has carried the craft up, s, and the minimum throttle that did so, µs.
    carried_s: f64,
    lifting_floor_us: Option<u16>,
}

impl AltitudeTarget {
    /// Returns `true` if the target makes a craft at this altitude (m) climb.
    fn climbs(self, altitude_m: f64) -> bool {
        match self {
            Self::Altitude(target_m) => target_m > altitude_m + CLIMB_M,
            Self::Rate(rate_mps) | Self::Landing { rate_mps, .. } => rate_mps > 0.0,
        }
    }
}

impl AltitudeController {
    /// Tracks a cycle that something else flies, so that the hover throttle is known when this controller takes over.
    pub fn track(&mut self, now: &AltitudeMeasurement, params: &Params, dt: f64) {
        self.hover.update(&hover_measurement(now, params), dt);
        self.spool_up = SpoolUp::default();
    }

    /// Takes over. The setpoint starts at the craft and the throttle where it was.
    pub fn engage(&mut self, now: &AltitudeMeasurement, params: &Params) {
        let is_held =
            now.altitude_m > HELD_M && now.climb_mps.abs() < HELD_MPS && now.cos_tilt > HELD_COS_TILT;
        let configured = match params.hover_throttle {
            0 => now.throttle_us.clamp(1100.0, 1700.0),
            // The throttle of a craft that holds its altitude, level and steady, is its hover throttle.
            _ if is_held => now.throttle_us,
            us => f64::from(us),
        };
        self.hover.engage(configured);
        self.captured_us = self.hover.hover_us();
        self.setpoint_m = now.altitude_m;
        let rate = params.climb_rate_mps();
        self.setpoint_rate = now.climb_mps.clamp(-rate, rate);
        self.setpoint_accel = 0.0;
        self.integral_us = 0.0;
        self.relief_us = 0.0;
        self.limits_us = None;
        self.params = Some(*params);
        if !self.on_ground {
            self.spool_up = SpoolUp::default();
        }
        let law = self.terms(now).throttle_us(params);
        self.throttle_us = now.throttle_us;
        self.transfer.start(now.throttle_us, law);
    }

    /// Returns the altitude setpoint, m above home.
    pub fn setpoint_m(&self) -> f64 {
        self.setpoint_m
    }

    /// Returns the hover throttle in use, µs.
    pub fn hover_us(&self) -> f64 {
        self.hover.hover_us()
    }

    /// Returns `true` if the craft has hovered in this flight, so that its hover throttle is known.
    pub fn has_hovered(&self) -> bool {
        self.hover.held_us().is_some()
    }

    /// Returns the hover throttle learned in this flight, µs, or `None` before. If the minimum throttle carried the
    /// craft up, the hover throttle is lower than that, even before the craft has hovered.
    pub fn learned_hover_us(&self) -> Option<f64> {
        self.hover.learned_us().or_else(|| {
            let lifting_us = f64::from(self.lifting_floor_us?) - 1.0;
            Some(self.hover.balance_us().map_or(lifting_us, |balance_us| balance_us.min(lifting_us)))
        })
    }

    /// Returns the position of the throttle stick that means no climb, µs: the hover throttle learned in this flight,
    /// else the parameter, else `centre_us`.
    pub fn hover_stick_us(&self, params: &Params, centre_us: f64) -> f64 {
        let configured_us = match params.hover_throttle {
            0 => centre_us,
            us => f64::from(us),
        };
        self.hover.learned_us().unwrap_or(configured_us)
    }

    /// Returns the hover throttle that a touchdown is measured against, µs: the parameter or, if there is none, the
    /// throttle that held the craft when this controller took over.
    pub fn reference_hover_us(&self, params: &Params) -> f64 {
        match params.hover_throttle {
            0 => self.captured_us,
            us => f64::from(us),
        }
    }

    /// Subtracts this much (µs) from the throttle of the control law from now on, in a landing that does not sink any
    /// more.
    pub fn set_relief_us(&mut self, relief_us: f64) {
        self.relief_us = relief_us;
    }

    /// Returns the throttle of the last update, µs.
    pub fn throttle_us(&self) -> f64 {
        self.throttle_us
    }

    /// Returns the integral of the last update, µs.
    pub fn integral_us(&self) -> f64 {
        self.integral_us
    }

    /// Sets `on_ground`, `true` while the craft is on the ground and has not lifted off yet, and `load`, the specific
    /// force along its thrust in multiples of gravity.
    pub fn set_on_ground(&mut self, on_ground: bool, load: f64) {
        (self.on_ground, self.load) = (on_ground, load);
    }

    /// Returns `true` if the throttle is at its upper limit.
    pub fn is_at_full_throttle(&self) -> bool {
        self.limits_us.is_some_and(|(_, max)| self.throttle_us >= max)
    }

    /// Returns `true` if the craft loses altitude at full throttle.
    pub(super) fn sinks_at_full_throttle(&self, now: &NavInputs) -> bool {
        self.is_at_full_throttle() && self.setpoint_m > now.alt_m + BELOW_M && now.climb_mps < -SINKING_MPS
    }

    /// Returns `true` if there is throttle left.
    pub(super) fn has_throttle_to_spare(&self) -> bool {
        self.limits_us.is_none_or(|(_, max)| self.throttle_us < max - SPARE_US)
    }

    /// Returns the throttle (µs) towards `target` after `dt` seconds, inside the limits of the parameters.
    pub fn update(
        &mut self,
        now: &AltitudeMeasurement,
        target: AltitudeTarget,
        params: &Params,
        dt: f64,
    ) -> f64 {
        if !(now.altitude_m + now.climb_mps + now.cos_tilt + now.throttle_us).is_finite() {
            return self.throttle_us;
        }
        self.hover.update(&hover_measurement(now, params), dt);
        if self.on_ground {
            return self.wait_for_lift_off(now, target, params, dt);
        }
        if self.spool_up.lift_off() {
            self.hover.lift_off(self.load, params.throttle_zero_us());
            self.setpoint_rate = now.climb_mps;
            self.transfer = BumplessTransfer::default();
        }
        self.watch_floor(now, params, dt);
        let rate_before = self.setpoint_rate;
        let landing = self.move_setpoint(now, target, params, dt);
        let change = self.setpoint_rate - rate_before;
        // The filter avoids a step of the throttle, which would jolt a light craft.
        let accel = if dt > 0.0 { change / dt } else { 0.0 };
        self.setpoint_accel += (accel - self.setpoint_accel) * (dt / (ACCEL_FILTER_S + dt));
        self.integrate(now, landing, params, dt);
        if let Some(old) = self.params.filter(|old| old != params) {
            // A changed parameter must not cause a step of the throttle.
            let terms = self.terms(now);
            let before = terms.throttle_us(&old) + self.transfer.remaining();
            self.transfer.start(before, terms.throttle_us(params));
            self.params = Some(*params);
        }
        let law_us = self.terms(now).throttle_us(params) + self.accel_throttle_us(params);
        let wanted = self.transfer.apply(law_us, dt) - self.relief_us;
        let (min, max) = self.slew_limits(params, dt);
        let step = THROTTLE_SLEW_US_PER_S * dt;
        let slewed = wanted.clamp(self.throttle_us - step, self.throttle_us + step);
        self.throttle_us = if slewed.is_finite() { slewed.clamp(min, max) } else { min };
        self.throttle_us
    }

    /// Raises the throttle until the craft leaves the ground. Nothing else is controlled on the ground.
    fn wait_for_lift_off(
        &mut self,
        now: &AltitudeMeasurement,
        target: AltitudeTarget,
        params: &Params,
        dt: f64,
    ) -> f64 {
        (self.setpoint_m, self.setpoint_rate, self.integral_us) = (now.altitude_m, 0.0, 0.0);
        let limits = self.slew_limits(params, dt);
        let thrust = (self.reference_hover_us(params), params.throttle_zero_us());
        self.throttle_us = self.spool_up.update(target.climbs(now.altitude_m), thrust, limits, dt);
        self.throttle_us
    }

    /// Returns the throttle for the acceleration of the setpoint, µs. Thrust grows with the square of the throttle
    /// above its zero.
    fn accel_throttle_us(&self, params: &Params) -> f64 {
        let load = 1.0 + (self.setpoint_accel / GRAVITY).clamp(-0.5, 0.5);
        (self.hover.hover_us() - params.throttle_zero_us()) * (load.sqrt() - 1.0)
    }

    fn terms(&self, now: &AltitudeMeasurement) -> ThrottleTerms {
        ThrottleTerms {
            error_cm: (self.setpoint_m - now.altitude_m) * 100.0,
            integral_us: self.integral_us,
            setpoint_rate_cms: self.setpoint_rate * 100.0,
            climb_rate_cms: now.climb_mps * 100.0,
            hover_us: self.hover.hover_us(),
            cos_tilt: now.cos_tilt,
        }
    }

    /// Moves the setpoint. Returns `true` if this is a landing.
    fn move_setpoint(
        &mut self,
        now: &AltitudeMeasurement,
        target: AltitudeTarget,
        params: &Params,
        dt: f64,
    ) -> bool {
        let climb_rate = params.climb_rate_mps();
        let change = SETPOINT_ACCEL * dt;
        match target {
            AltitudeTarget::Altitude(altitude_m) => {
                let left = altitude_m - self.setpoint_m;
                let speed = climb_rate
                    .min((2.0 * SETPOINT_BRAKE * left.abs()).sqrt())
                    .min(flare_mps(self.setpoint_m, altitude_m));
                let wanted = speed.copysign(left);
                self.setpoint_rate += (wanted - self.setpoint_rate).clamp(-change, change);
                let step = self.setpoint_rate * dt;
                // The last step ends on the target instead of oscillating around it.
                if left.abs() < 0.02 && step.abs() >= left.abs() {
                    self.setpoint_m = altitude_m;
                    self.setpoint_rate = 0.0;
                } else {
                    self.setpoint_m += step;
                }
                false
            }
            AltitudeTarget::Rate(rate) => {
                let wanted = rate.clamp(-2.0 * climb_rate, 2.0 * climb_rate);
                self.setpoint_rate += (wanted - self.setpoint_rate).clamp(-change, change);
                let leash = wanted.abs().max(0.5);
                self.setpoint_m = (self.setpoint_m + self.setpoint_rate * dt)
                    .clamp(now.altitude_m - leash, now.altitude_m + leash);
                false
            }
            AltitudeTarget::Landing { setpoint_m, rate_mps } => {
                self.setpoint_m = setpoint_m;
                self.setpoint_rate += (rate_mps - self.setpoint_rate).clamp(-change, change);
                true
            }
        }
    }

    fn integrate(&mut self, now: &AltitudeMeasurement, landing: bool, params: &Params, dt: f64) {
        let error_cm = (self.setpoint_m - now.altitude_m) * 100.0;
        // The integral must not learn the lag of a climb. It would carry the craft past its altitude.
        let speed = self.setpoint_rate.abs().max(now.climb_mps.abs());
        let steady = 1.0 / (1.0 + math::powi(speed / HALF_INTEGRAL_MPS, 2));
        let share = match (landing, error_cm.abs() > 200.0) {
            (true, _) => 1.0,
            (false, true) => 0.1 * steady,
            (false, false) => steady,
        };
        self.integral_us += 0.003 * f64::from(params.altitude_i) * error_cm * share * dt;
        // The throttle of a craft that is on the ground is not its hover throttle.
        let stands = self.relief_us > 0.0;
        let taken = if stands { 0.0 } else { self.hover.learn(self.integral_us, error_cm / 100.0, dt) };
        self.integral_us = (self.integral_us - taken).clamp(-INTEGRAL_LIMIT_US, INTEGRAL_LIMIT_US);
    }

    /// Returns the minimum throttle, µs. A floor above the hover throttle learned in this flight would carry the
    /// craft away. The check at engagement refuses it, but a craft that engages on the ground has not learned
    /// anything yet.
    fn floor_us(&self, params: &Params) -> f64 {
        let floor_us = f64::from(params.throttle_min);
        match self.hover.learned_us() {
            Some(hover_us) if hover_us < floor_us => (hover_us - DESCENT_RESERVE_US).max(MIN_FLOOR_US),
            None if self.lifting_floor_us.is_some_and(|lifts| params.throttle_min >= lifts) => MIN_FLOOR_US,
            Some(_) | None => floor_us,
        }
    }

    /// Detects a craft that keeps climbing faster than commanded at the minimum throttle. It never reaches the hover
    /// in which its hover throttle would be learned.
    fn watch_floor(&mut self, now: &AltitudeMeasurement, params: &Params, dt: f64) {
        let is_least = now.throttle_us <= f64::from(params.throttle_min) + 1.0;
        let is_carried = now.climb_mps > self.setpoint_rate + CARRIED_MPS && now.climb_mps > CARRIED_MPS;
        // A craft that was thrown up slows down.
        let goes_on = self.hover.accel_mps2() > -CARRIED_MPS2;
        self.carried_s = if is_least && is_carried && goes_on { self.carried_s + dt } else { 0.0 };
        if self.carried_s >= CARRIED_S {
            self.lifting_floor_us = Some(params.throttle_min);
        }
    }

    /// Returns the throttle limits, which follow those of the parameters at a limited rate.
    fn slew_limits(&mut self, params: &Params, dt: f64) -> (f64, f64) {
        let wanted = (self.floor_us(params), f64::from(params.throttle_max));
        let step = LIMIT_SLEW_US_PER_S * dt;
        let slew = |old: f64, new: f64| old + (new - old).clamp(-step, step);
        let limits = match self.limits_us {
            Some((min, max)) => (slew(min, wanted.0), slew(max, wanted.1)),
            None => wanted,
        };
        self.limits_us = Some(limits);
        (limits.0, limits.1.max(limits.0))
    }
}

/// Returns the maximum speed of the setpoint towards a target, m/s. After a quick descent, a craft lags its setpoint
/// and overshoots it downwards by a metre or two. That is too much close above the ground, so the craft descends more
/// slowly the lower it is.
fn flare_mps(setpoint_m: f64, target_m: f64) -> f64 {
    let flares = target_m.abs() < LOW_TARGET_M && (0.0..).contains(&setpoint_m) && target_m < setpoint_m;
    if flares { (FLARE * setpoint_m).max(SLOWEST_FLARE_MPS) } else { f64::INFINITY }
}

fn hover_measurement(now: &AltitudeMeasurement, params: &Params) -> HoverMeasurement {
    HoverMeasurement {
        throttle_us: now.throttle_us,
        zero_us: params.throttle_zero_us(),
        climb_mps: now.climb_mps,
        altitude_m: now.altitude_m,
        cos_tilt: now.cos_tilt,
    }
}

#[cfg(test)]
mod tests;
