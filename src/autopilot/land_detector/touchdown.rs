//! The conditions of a touchdown and the time that they have held.

use super::LandDetector;
use crate::autopilot::control::AltitudeController;
use crate::autopilot::io::NavInputs;
use crate::autopilot::params::Params;
use crate::signals::SimTime;
use crate::telemetry::{Guard, GuardName, GuardOp};

/// The descent that makes a touchdown credible, m.
const DESCENT_M: f64 = 0.5;
/// The distance that the setpoint may be below the craft without counting as pressing on the ground, m.
const PRESSING_M: f64 = 1.5;
/// The upper limit of the required distance of the throttle below the learned hover throttle, µs.
const BELOW_HOVER_US: f64 = 50.0;

/// A craft on the ground moves vertically slower than this, m/s. With a fast landing rate, a quarter of that rate
/// alone would accept a craft that cannot sink as landed.
pub const AT_REST_MPS: f64 = 0.125;

/// The inputs of a touchdown decision: four measured values and their limits, SI and µs.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TouchdownFacts {
    /// Altitude above home, m.
    pub altitude_m: f64,
    /// Upper limit of the altitude, m.
    pub landing_altitude_m: f64,
    /// Ground speed, m/s.
    pub ground_speed_mps: f64,
    /// Upper limit of the ground speed, m/s.
    pub max_speed_mps: f64,
    /// Commanded throttle, µs.
    pub throttle_us: f64,
    /// Upper limit of the throttle, µs.
    pub max_throttle_us: f64,
    /// Climb rate, m/s.
    pub climb_mps: f64,
    /// Lower limit of the climb rate (negative), m/s: above it the craft does not descend any more.
    pub min_climb_mps: f64,
}

impl TouchdownFacts {
    /// Combines measured values with the limits of the parameters. `hover_us` is the configured hover throttle, or
    /// the captured one if none is configured.
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

/// The facts that distinguish the ground from a low hover with a wrongly configured hover throttle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundFacts {
    /// Height lost in the landing, or the distance of the setpoint below the craft beyond 1.5 m, whichever is
    /// greater, m.
    pub descent_m: f64,
    /// Distance of the commanded throttle below the hover throttle learned in flight, µs.
    pub below_hover_us: f64,
    /// Required distance below the hover throttle, µs.
    pub needed_us: f64,
}

impl GroundFacts {
    /// Returns the facts for a craft in descent, whatever flies it.
    pub fn new(now: &NavInputs, params: &Params, altitude: &AltitudeController, land: &LandDetector) -> Self {
        let pressing = now.alt_m - altitude.setpoint_m() - PRESSING_M;
        Self {
            descent_m: land.descended_m(now.alt_m).max(pressing),
            below_hover_us: altitude.hover_us() - altitude.throttle_us(),
            needed_us: (0.5 * f64::from(params.landing_throttle_threshold)).min(BELOW_HOVER_US),
        }
    }

    /// Facts that need no further evidence.
    pub const CERTAIN: Self =
        Self { descent_m: f64::INFINITY, below_hover_us: f64::INFINITY, needed_us: 0.0 };
}

/// The conditions of a touchdown, evaluated once per update. The timer runs while they hold, and the rule of LANDING
/// uses and displays them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TouchdownGuards([Guard; 6]);

impl TouchdownGuards {
    /// Returns the guards: low, slow, throttle low, not descending, height lost, throttle below the learned hover
    /// throttle.
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

    /// Returns the guards in the order in which they are shown.
    pub fn iter(&self) -> impl Iterator<Item = Guard> {
        self.0.into_iter()
    }

    /// Returns `true` if the craft is on the ground as far as one update can tell.
    pub fn all_hold(&self) -> bool {
        self.0.iter().all(Guard::holds)
    }
}

/// The time that the touchdown conditions have held without a break.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TouchdownTimer {
    since: Option<SimTime>,
}

impl TouchdownTimer {
    /// Takes the result of this update, `true` if all conditions hold. Returns the time that they have held, µs, or
    /// `None` if they do not hold.
    pub fn update(&mut self, now: SimTime, all_hold: bool) -> Option<u64> {
        if !all_hold {
            self.since = None;
            return None;
        }
        let since = *self.since.get_or_insert(now);
        Some(now.0.saturating_sub(since.0))
    }
}
