//! The conditions of a touchdown and the time they have held.

use super::LandDetector;
use crate::autopilot::control::AltitudeController;
use crate::autopilot::io::NavInputs;
use crate::autopilot::params::Params;
use crate::signals::SimTime;
use crate::telemetry::{Guard, GuardName, GuardOp};

/// Descent that makes a touchdown credible, m.
const DESCENT_M: f64 = 0.5;
/// How far the setpoint may be under the craft without counting as pressing on the ground, m.
const PRESSING_M: f64 = 1.5;
/// Most that the throttle must be below the learned hover throttle for a touchdown, µs.
const BELOW_HOVER_US: f64 = 50.0;

/// A craft on the ground moves vertically slower than this, m/s. A fast landing alone would call a craft landed that cannot sink
/// at a quarter of its rate.
pub const AT_REST_MPS: f64 = 0.125;

/// What decides a touchdown: four measured values and their limits, SI and µs.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TouchdownFacts {
    /// Altitude above home, m.
    pub altitude_m: f64,
    /// Below this altitude, m.
    pub landing_altitude_m: f64,
    /// Ground speed, m/s.
    pub ground_speed_mps: f64,
    /// Below this speed, m/s.
    pub max_speed_mps: f64,
    /// Commanded throttle, µs.
    pub throttle_us: f64,
    /// Below this throttle, µs.
    pub max_throttle_us: f64,
    /// Climb rate, m/s.
    pub climb_mps: f64,
    /// Above this (negative) climb rate, m/s: the craft does not descend any more.
    pub min_climb_mps: f64,
}

impl TouchdownFacts {
    /// The limits of the parameters around measured values; `hover_us` is the configured hover throttle, or the
    /// captured one where none is configured.
    pub fn new(
        params: &Params,
        hover_us: f64,
        altitude_m: f64,
        ground_speed_mps: f64,
        throttle_us: f64,
        climb_mps: f64,
    ) -> Self {
        Self {
            altitude_m,
            landing_altitude_m: f64::from(params.landing_altitude_m),
            ground_speed_mps,
            max_speed_mps: f64::from(params.landing_velocity_threshold) / 100.0,
            throttle_us,
            max_throttle_us: hover_us - f64::from(params.landing_throttle_threshold),
            climb_mps,
            min_climb_mps: -0.25 * params.descent_rate_mps(),
        }
    }
}

/// What tells the ground from a craft that hovers low with a wrongly configured hover throttle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundFacts {
    /// How far the landing has come down, or how far the setpoint is under the craft beyond 1.5 m: m.
    pub descent_m: f64,
    /// Commanded throttle below the hover throttle learned in flight, µs.
    pub below_hover_us: f64,
    /// How far below it must be, µs.
    pub needed_us: f64,
}

impl GroundFacts {
    /// What tells the ground from a craft that hovers low, whoever descends.
    pub fn new(now: &NavInputs, params: &Params, altitude: &AltitudeController, land: &LandDetector) -> Self {
        let pressing = now.alt_m - altitude.setpoint_m() - PRESSING_M;
        Self {
            descent_m: land.descended_m(now.alt_m).max(pressing),
            below_hover_us: altitude.hover_us() - altitude.throttle_us(),
            needed_us: (0.5 * f64::from(params.landing_throttle_threshold)).min(BELOW_HOVER_US),
        }
    }

    /// Evidence that needs no more.
    pub const CERTAIN: Self =
        Self { descent_m: f64::INFINITY, below_hover_us: f64::INFINITY, needed_us: 0.0 };
}

/// The conditions of a touchdown, evaluated once in an update: the timer runs while they hold, and the rule of LANDING
/// decides by them and shows them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TouchdownGuards([Guard; 6]);

impl TouchdownGuards {
    /// Low, slow, throttle low, not descending, come down, throttle below the learned hover throttle.
    pub fn new(touch: &TouchdownFacts, ground: &GroundFacts) -> Self {
        Self([
            Guard::new(
                GuardName::TouchdownAltitude,
                touch.altitude_m,
                GuardOp::Below,
                touch.landing_altitude_m,
            ),
            Guard::new(
                GuardName::TouchdownSpeed,
                touch.ground_speed_mps,
                GuardOp::Below,
                touch.max_speed_mps,
            ),
            Guard::new(
                GuardName::TouchdownThrottle,
                touch.throttle_us,
                GuardOp::Below,
                touch.max_throttle_us,
            ),
            Guard::new(GuardName::TouchdownSink, touch.climb_mps, GuardOp::Above, touch.min_climb_mps),
            Guard::new(GuardName::Descent, ground.descent_m, GuardOp::AtLeast, DESCENT_M),
            Guard::new(GuardName::BelowHover, ground.below_hover_us, GuardOp::AtLeast, ground.needed_us),
        ])
    }

    /// The guards in the order they are shown.
    pub fn iter(&self) -> impl Iterator<Item = Guard> {
        self.0.into_iter()
    }

    /// Whether the craft is on the ground as far as one update can tell.
    pub fn all_hold(&self) -> bool {
        self.0.iter().all(Guard::holds)
    }
}

/// How long the touchdown conditions have held without a break.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TouchdownTimer {
    since: Option<SimTime>,
}

impl TouchdownTimer {
    /// Takes whether all conditions hold in this update; returns the time they have held, µs, or `None` when they do not.
    pub fn update(&mut self, now: SimTime, all_hold: bool) -> Option<u64> {
        if !all_hold {
            self.since = None;
            return None;
        }
        let since = *self.since.get_or_insert(now);
        Some(now.0.saturating_sub(since.0))
    }
}
