//! Feeling for the ground: less throttle for a craft that does not sink although it should.

use crate::autopilot::io::NavInputs;
use crate::autopilot::params::Params;

/// The landing altitude that counts when the parameter is lower, m.
const LOWEST_LANDING_M: f64 = 1.0;
/// Share of the landing rate below which a descent neither sinks nor climbs.
const STILL_SHARE: f64 = 0.25;
/// Time over which the climb rate of a craft that bounces is averaged, s.
const JOLT_S: f64 = 0.3;
/// How far the setpoint must be below a craft that does not sink, m.
const SETPOINT_BELOW_M: f64 = 0.3;
/// How long a craft that is not known to be low must have rested, s, for the altitude may be wrong: after it sank at this
/// share of the wanted rate, and before.
const REST_AFTER_SINKING_S: f64 = 0.4;
const REST_S: f64 = 1.5;
const SANK_SHARE: f64 = 0.6;
/// Rates at which the throttle is taken off while a craft does not sink, and given back, µs/s.
const RELIEF_US_PER_S: f64 = 120.0;
const GIVE_BACK_US_PER_S: f64 = 300.0;
/// Most throttle taken off, µs: the floor of the parameters is reached in any case.
const RELIEF_LIMIT_US: f64 = 600.0;
/// Throttle taken off at which the craft is flown level, µs.
const LEVEL_US: f64 = 80.0;
/// Throttle taken off at which a craft that does not sink is sure to stand, µs.
const STANDS_US: f64 = 120.0;

/// One cycle of a descent to the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DescentFacts {
    /// Altitude, m.
    pub altitude_m: f64,
    /// Climb rate, m/s.
    pub climb_mps: f64,
    /// Altitude setpoint of the controller, m.
    pub setpoint_m: f64,
    /// Sink rate that is wanted now, m/s.
    pub sink_mps: f64,
    /// `ap_landing_descent_rate`, or the wanted rate where that is slower, m/s.
    pub landing_rate_mps: f64,
    /// The altitude says that the ground is near.
    pub is_low: bool,
    /// The throttle is at its least.
    pub throttle_at_min: bool,
    /// Ground speed from which the craft moves, m/s.
    pub max_speed_mps: f64,
}

impl DescentFacts {
    /// A descent at `sink_mps` (m/s), by a controller whose setpoint is `setpoint_m` (m) and whose throttle is
    /// `throttle_us` (µs).
    pub fn new(
        now: &NavInputs,
        params: &Params,
        (setpoint_m, throttle_us): (f64, f64),
        sink_mps: f64,
    ) -> Self {
        let landing_mps = params.descent_rate_mps();
        let measured_mps =
            if now.fix { f64::from(params.landing_velocity_threshold) / 100.0 } else { f64::INFINITY };
        Self {
            altitude_m: now.alt_m,
            climb_mps: now.climb_mps,
            setpoint_m,
            sink_mps,
            landing_rate_mps: if sink_mps > 0.0 { landing_mps.min(sink_mps) } else { landing_mps },
            is_low: now.alt_m < f64::from(params.landing_altitude_m).max(LOWEST_LANDING_M),
            throttle_at_min: throttle_us <= f64::from(params.throttle_min),
            max_speed_mps: measured_mps,
        }
    }

    /// Vertical speed below which the descent neither sinks nor climbs, m/s.
    pub fn still_mps(&self) -> f64 {
        STILL_SHARE * self.landing_rate_mps
    }
}

/// The throttle taken off.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct ThrottleRelief {
    climb_mps: f64,
    has_sunk: bool,
    rest_s: f64,
    is_rising: bool,
    relief_us: f64,
}

impl ThrottleRelief {
    /// Begins with the climb rate of the craft, m/s.
    pub(super) fn begin(&mut self, climb_mps: f64) {
        *self = Self { climb_mps, ..Self::default() };
    }

    /// One cycle. Low and still although it should sink, the craft stands, or the air carries it.
    pub(super) fn update(&mut self, facts: &DescentFacts, dt: f64) {
        self.climb_mps += (facts.climb_mps - self.climb_mps) * (dt / (JOLT_S + dt));
        self.has_sunk |= facts.sink_mps > 0.0 && self.climb_mps < -SANK_SHARE * facts.sink_mps;
        let rests = facts.sink_mps > 0.0
            && self.climb_mps.abs() < facts.still_mps()
            && facts.altitude_m - facts.setpoint_m > SETPOINT_BELOW_M;
        self.rest_s = if rests { self.rest_s + dt } else { 0.0 };
        let needed_s = if self.has_sunk { REST_AFTER_SINKING_S } else { REST_S };
        self.is_rising = rests && (facts.is_low || self.rest_s > needed_s);
        let rate = if self.is_rising { RELIEF_US_PER_S } else { -GIVE_BACK_US_PER_S };
        self.relief_us = (self.relief_us + rate * dt).clamp(0.0, RELIEF_LIMIT_US);
    }

    /// Climb rate without the jolts of the legs, m/s.
    pub(super) fn climb_mps(&self) -> f64 {
        self.climb_mps
    }

    /// Whether throttle is being taken off.
    pub(super) fn is_rising(&self) -> bool {
        self.is_rising
    }

    /// Throttle to take off, µs.
    pub(super) fn relief_us(&self) -> f64 {
        self.relief_us
    }

    /// Share of the lean demand that is flown.
    pub(super) fn lean_share(&self) -> f64 {
        1.0 - (self.relief_us / LEVEL_US).min(1.0)
    }

    /// Whether the craft is sure to stand on its legs.
    pub(super) fn stands(&self) -> bool {
        self.relief_us >= STANDS_US
    }
}
