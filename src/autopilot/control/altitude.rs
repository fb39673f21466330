//! Altitude control: a setpoint that moves as the craft can, and the throttle that follows it.

use super::bumpless::BumplessTransfer;
use super::hover_throttle::{HoverMeasurement, HoverThrottleEstimator};
use super::spool_up::SpoolUp;
use crate::autopilot::io::NavInputs;
use crate::autopilot::params::Params;
use crate::geo::GRAVITY;

/// How fast the setpoint's speed may change, m/s².
const SETPOINT_ACCEL: f64 = 2.0;
/// Deceleration with which the setpoint approaches its target, m/s².
const SETPOINT_BRAKE: f64 = 1.0;
/// Targets this near to home's altitude lie close above the ground that home stands on, m.
const LOW_TARGET_M: f64 = 3.0;
/// Share of the height above home that a descent to a low target takes in a second, 1/s.
const FLARE: f64 = 0.25;
/// Slowest descent to a low target, m/s.
const SLOWEST_FLARE_MPS: f64 = 0.3;
/// Limit of the integral, µs.
const INTEGRAL_LIMIT_US: f64 = 200.0;
/// Vertical speed, of the setpoint or the craft, at which the integral works at half its gain, m/s.
const HALF_INTEGRAL_MPS: f64 = 0.8;
/// Time constant with which the throttle for an acceleration of the setpoint comes and goes, s.
const ACCEL_FILTER_S: f64 = 0.1;
/// Fastest change of the throttle, µs/s.
pub const THROTTLE_SLEW_US_PER_S: f64 = 5000.0;
/// A target this far above a craft on the ground asks it to take off, m.
const CLIMB_M: f64 = 0.3;
/// Below its setpoint by this (m) and sinking faster than this (m/s) at full throttle, the craft has too little thrust.
const BELOW_M: f64 = 0.2;
const SINKING_MPS: f64 = 0.1;
/// Throttle below its limit that is one to spare, µs.
const SPARE_US: f64 = 20.0;
/// A craft is carried by its least throttle when it climbs this much faster than asked, m/s, and slows down no more than
/// this, m/s², for so long, s.
const CARRIED_MPS: f64 = 0.5;
const CARRIED_MPS2: f64 = 1.0;
const CARRIED_S: f64 = 1.0;
/// A craft higher than this, m, slower than this, m/s, and with a greater cosine of its tilt is held by its throttle.
const HELD_M: f64 = 1.0;
const HELD_MPS: f64 = 0.3;
const HELD_COS_TILT: f64 = 0.966;
/// Room below the hover throttle that a craft needs to come down, µs, and the least floor of the parameters, µs.
const DESCENT_RESERVE_US: f64 = 100.0;
const LEAST_FLOOR_US: f64 = 1050.0;
/// Fastest change of the throttle limits in use, µs/s.
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
    /// Throttle that drove the mixer in the previous cycle, µs.
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

/// What the altitude controller is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AltitudeTarget {
    /// Go to this altitude (m) and stay, within the climb rate of the parameters.
    Altitude(f64),
    /// Climb (or, negative, sink) at this rate, m/s; the setpoint never runs more than a second ahead of the craft.
    Rate(f64),
    /// Follow a setpoint that somebody else moves: a landing. The integral works at full gain.
    Landing {
        /// Altitude now, m.
        setpoint_m: f64,
        /// Its rate, m/s.
        rate_mps: f64,
    },
}

/// Everything the throttle depends on in one update.
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
    /// Throttle before its limits, µs: P, I, D and F about the hover throttle, compensated for the tilt.
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

/// A throttle pulse as a share of the mixer's range, 0…1.
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
    /// Throttle taken off the law's, µs.
    relief_us: f64,
    limits_us: Option<(f64, f64)>,
    params: Option<Params>,
    transfer: BumplessTransfer,
    on_ground: bool,
    load: f64,
    spool_up: SpoolUp,
    /// How long the least throttle has carried the craft up, s, and the least throttle that did, µs.
    carried_s: f64,
    lifting_floor_us: Option<u16>,
}

impl AltitudeTarget {
    /// Whether it asks a craft at this altitude (m) to climb.
    fn climbs(self, altitude_m: f64) -> bool {
        match self {
            Self::Altitude(target_m) => target_m > altitude_m + CLIMB_M,
            Self::Rate(rate_mps) | Self::Landing { rate_mps, .. } => rate_mps > 0.0,
        }
    }
}

impl AltitudeController {
    /// Tracks a cycle that somebody else flies, so that the hover throttle is known when this controller takes over.
    pub fn track(&mut self, now: &AltitudeMeasurement, params: &Params, dt: f64) {
        self.hover.update(&hover_measurement(now, params), dt);
        self.spool_up = SpoolUp::default();
    }

    /// Takes over: the setpoint starts at the craft, the throttle where it was.
    pub fn engage(&mut self, now: &AltitudeMeasurement, params: &Params) {
        let is_held =
            now.altitude_m > HELD_M && now.climb_mps.abs() < HELD_MPS && now.cos_tilt > HELD_COS_TILT;
        let configured = match params.hover_throttle {
            0 => now.throttle_us.clamp(1100.0, 1700.0),
            // A craft that is held in the air, level and steady, shows its hover throttle at once.
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

    /// Altitude setpoint now, m above home.
    pub fn setpoint_m(&self) -> f64 {
        self.setpoint_m
    }

    /// Hover throttle in use, µs.
    pub fn hover_us(&self) -> f64 {
        self.hover.hover_us()
    }

    /// Returns whether the craft has hovered in this flight, so that its hover throttle is known.
    pub fn has_hovered(&self) -> bool {
        self.hover.held_us().is_some()
    }

    /// The hover throttle that this flight has shown, µs; `None` before. Of a craft that its least throttle carried up it is
    /// less than that, even before it hovered.
    pub fn learned_hover_us(&self) -> Option<f64> {
        self.hover.learned_us().or_else(|| {
            let lifting_us = f64::from(self.lifting_floor_us?) - 1.0;
            Some(self.hover.balance_us().map_or(lifting_us, |balance_us| balance_us.min(lifting_us)))
        })
    }

    /// Where a throttle stick means no climb, µs: the hover throttle that this flight has shown, before that the parameter,
    /// and without one `centre_us`.
    pub fn hover_stick_us(&self, params: &Params, centre_us: f64) -> f64 {
        let configured_us = match params.hover_throttle {
            0 => centre_us,
            us => f64::from(us),
        };
        self.hover.learned_us().unwrap_or(configured_us)
    }

    /// The hover throttle that a touchdown is measured against, µs: the parameter, or what held the craft when this
    /// controller took over if there is none.
    pub fn reference_hover_us(&self, params: &Params) -> f64 {
        match params.hover_throttle {
            0 => self.captured_us,
            us => f64::from(us),
        }
    }

    /// Takes this much (µs) off the throttle of the law from now on: a landing that does not sink any more.
    pub fn set_relief_us(&mut self, relief_us: f64) {
        self.relief_us = relief_us;
    }

    /// Throttle of the last update, µs.
    pub fn throttle_us(&self) -> f64 {
        self.throttle_us
    }

    /// Says whether the craft stands on the ground and has not lifted off yet, and the specific force along its thrust in
    /// multiples of gravity.
    pub fn set_on_ground(&mut self, on_ground: bool, load: f64) {
        (self.on_ground, self.load) = (on_ground, load);
    }

    /// Whether the throttle is all there is.
    pub fn is_at_full_throttle(&self) -> bool {
        self.limits_us.is_some_and(|(_, max)| self.throttle_us >= max)
    }

    /// Whether the craft loses altitude although it has all the throttle there is.
    pub(super) fn sinks_at_full_throttle(&self, now: &NavInputs) -> bool {
        self.is_at_full_throttle() && self.setpoint_m > now.alt_m + BELOW_M && now.climb_mps < -SINKING_MPS
    }

    /// Whether there is throttle left.
    pub(super) fn has_throttle_to_spare(&self) -> bool {
        self.limits_us.is_none_or(|(_, max)| self.throttle_us < max - SPARE_US)
    }

    /// Throttle (µs) towards `target` after `dt` seconds; inside the limits of the parameters.
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
        // A step of the throttle would jolt a light craft.
        let accel = if dt > 0.0 { change / dt } else { 0.0 };
        self.setpoint_accel += (accel - self.setpoint_accel) * (dt / (ACCEL_FILTER_S + dt));
        self.integrate(now, landing, params, dt);
        if let Some(old) = self.params.filter(|old| old != params) {
            // A changed parameter must not step the throttle.
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

    /// On the ground nothing is controlled: the throttle rises until the craft leaves it.
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

    /// Throttle for the acceleration of the setpoint, µs: thrust grows with the square of the throttle above its zero.
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

    /// Moves the setpoint; returns whether this is a landing.
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
                // The last step lands on the target instead of swinging about it.
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
        // The lag of a climb is not an error to remember: it would carry the craft past its altitude.
        let speed = self.setpoint_rate.abs().max(now.climb_mps.abs());
        let steady = 1.0 / (1.0 + (speed / HALF_INTEGRAL_MPS).powi(2));
        let share = match (landing, error_cm.abs() > 200.0) {
            (true, _) => 1.0,
            (false, true) => 0.1 * steady,
            (false, false) => steady,
        };
        self.integral_us += 0.003 * f64::from(params.altitude_i) * error_cm * share * dt;
        // What holds a craft that stands is no throttle to hover with.
        let stands = self.relief_us > 0.0;
        let taken = if stands { 0.0 } else { self.hover.learn(self.integral_us, error_cm / 100.0, dt) };
        self.integral_us = (self.integral_us - taken).clamp(-INTEGRAL_LIMIT_US, INTEGRAL_LIMIT_US);
    }

    /// Least throttle, µs. A floor above the hover throttle that this flight has shown would carry the craft away; it is
    /// refused at the engagement, but engaging on the ground comes before anything is known.
    fn floor_us(&self, params: &Params) -> f64 {
        let floor_us = f64::from(params.throttle_min);
        match self.hover.learned_us() {
            Some(hover_us) if hover_us < floor_us => (hover_us - DESCENT_RESERVE_US).max(LEAST_FLOOR_US),
            None if self.lifting_floor_us.is_some_and(|lifts| params.throttle_min >= lifts) => LEAST_FLOOR_US,
            Some(_) | None => floor_us,
        }
    }

    /// Notices a craft that goes on climbing, faster than it is asked to, with the least throttle: it never comes to the
    /// hover in which its hover throttle would be learned.
    fn watch_floor(&mut self, now: &AltitudeMeasurement, params: &Params, dt: f64) {
        let is_least = now.throttle_us <= f64::from(params.throttle_min) + 1.0;
        let is_carried = now.climb_mps > self.setpoint_rate + CARRIED_MPS && now.climb_mps > CARRIED_MPS;
        // One that was thrown up slows down.
        let goes_on = self.hover.accel_mps2() > -CARRIED_MPS2;
        self.carried_s = if is_least && is_carried && goes_on { self.carried_s + dt } else { 0.0 };
        if self.carried_s >= CARRIED_S {
            self.lifting_floor_us = Some(params.throttle_min);
        }
    }

    /// The throttle limits, led to the parameters' at a limited rate.
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

/// Greatest speed of the setpoint towards a target, m/s. A craft lags behind its setpoint and swings below it by a metre
/// or two after a quick descent, which close above the ground is too much: there it comes down the slower the lower it is.
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
mod tests {
    use super::*;

    #[test]
    fn only_a_descent_to_a_low_target_is_slowed() {
        let rows = [
            // setpoint, target, greatest speed
            (20.0, 1.0, 5.0),
            (4.0, 1.0, 1.0),
            (1.0, 0.5, 0.3),
            (0.0, -1.0, 0.3),
            (-0.1, -1.0, f64::INFINITY),
            (4.0, -60.0, f64::INFINITY),
            (4.0, 3.0, f64::INFINITY),
            (1.0, 2.0, f64::INFINITY),
        ];
        for (setpoint_m, target_m, speed_mps) in rows {
            assert_eq!(flare_mps(setpoint_m, target_m), speed_mps, "{setpoint_m} m to {target_m} m");
        }
    }
}
