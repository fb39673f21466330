//! Probing for the ground: less throttle for a craft that does not sink although it should.

use crate::autopilot::io::NavInputs;
use crate::autopilot::params::Params;

/// The landing altitude that is used if the parameter is lower, m.
const LOWEST_LANDING_M: f64 = 1.0;
/// The share of the landing rate below which a craft neither sinks nor climbs.
const STILL_SHARE: f64 = 0.25;
/// The time over which the climb rate of a bouncing craft is averaged, s.
const JOLT_S: f64 = 0.3;
/// The distance that the setpoint must be below a craft that does not sink, m.
const SETPOINT_BELOW_M: f64 = 0.3;
/// The minimum rest of a craft that is not known to be low, s, since the altitude may be wrong: after it
/// sank at this share of the wanted rate, and before.
const REST_AFTER_SINKING_S: f64 = 0.4;
const REST_S: f64 = 1.5;
const SANK_SHARE: f64 = 0.6;
/// The rates at which the throttle is reduced while a craft does not sink, and restored, µs/s.
const RELIEF_US_PER_S: f64 = 120.0;
const GIVE_BACK_US_PER_S: f64 = 300.0;
/// The maximum reduction of the throttle, µs. The reduced throttle is still limited by the throttle floor.
const RELIEF_LIMIT_US: f64 = 600.0;
/// The reduction of the throttle at which the craft is flown level, µs.
const LEVEL_US: f64 = 80.0;
/// The reduction of the throttle at which a craft that does not sink is certainly on the ground, µs.
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
    /// Wanted sink rate now, m/s.
    pub sink_mps: f64,
    /// `ap_landing_descent_rate`, or the wanted rate if that is slower, m/s.
    pub landing_rate_mps: f64,
    /// `true` if the ground is near according to the altitude.
    pub is_low: bool,
    /// `true` if the throttle is at its minimum.
    pub throttle_at_min: bool,
    /// Ground speed from which the craft counts as moving, m/s.
    pub max_speed_mps: f64,
}

impl DescentFacts {
    /// Returns the facts of a descent at `sink_mps` (m/s), flown by a controller with the setpoint `setpoint_m` (m)
    /// and the throttle `throttle_us` (µs).
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

    /// Returns the vertical speed below which the craft neither sinks nor climbs, m/s.
    pub fn still_mps(&self) -> f64 {
        STILL_SHARE * self.landing_rate_mps
    }
}

/// The reduction of the throttle.
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

    /// Takes one cycle. A low craft that does not sink although it should is on the ground, or the air carries it.
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

    /// Returns the climb rate without the jolts of the legs, m/s.
    pub(super) fn climb_mps(&self) -> f64 {
        self.climb_mps
    }

    /// Returns `true` while the throttle is being reduced.
    pub(super) fn is_rising(&self) -> bool {
        self.is_rising
    }

    /// Returns the throttle to subtract, µs.
    pub(super) fn relief_us(&self) -> f64 {
        self.relief_us
    }

    /// Returns the share of the tilt demand that is flown.
    pub(super) fn tilt_share(&self) -> f64 {
        1.0 - (self.relief_us / LEVEL_US).min(1.0)
    }

    /// Returns `true` if the craft is certainly on its legs.
    pub(super) fn stands(&self) -> bool {
        self.relief_us >= STANDS_US
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_craft_that_rests_on_the_ground_is_flown_level_step_by_step() {
        let params = Params::default();
        let now = NavInputs { alt_m: 0.5, ..NavInputs::hovering() };
        let facts = DescentFacts::new(&now, &params, (-5.0, 1300.0), params.descent_rate_mps());
        let mut relief = ThrottleRelief::default();
        relief.begin(0.0);
        assert_eq!(relief.tilt_share(), 1.0);
        let (mut before, mut steps) = (1.0, 0);
        while relief.tilt_share() > 0.0 {
            relief.update(&facts, 0.01);
            let share = relief.tilt_share();
            assert!((0.0..before).contains(&share), "{share} after {before}");
            (before, steps) = (share, steps + 1);
        }
        assert!((50..100).contains(&steps), "80 µs take two thirds of a second: {steps}");
        assert!(!relief.stands(), "level before it is certain");
    }
}
