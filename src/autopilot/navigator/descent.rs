//! A landing under way: its path down, feeling for the ground, and the land detector's timer.

use super::entry::Rescue;
use crate::autopilot::guidance::landing_setpoint_m;
use crate::autopilot::io::NavInputs;
use crate::autopilot::machine::{TouchdownGuards, TouchdownTimer};
use crate::autopilot::params::Params;
use crate::signals::SimTime;

/// Below this altitude a landing waits while the craft is faster over ground than the speed, m and m/s; not longer than
/// the time, s.
const LAST_METRES_M: f64 = 5.0;
const TOUCHDOWN_MPS: f64 = 2.0;
const FAST_PATIENCE_S: f64 = 30.0;
/// Below this altitude a rescue sinks at the landing rate, m.
const SLOW_LANDING_M: f64 = 4.0;
/// The landing altitude that counts when the parameter is lower, m.
const LOWEST_LANDING_M: f64 = 1.0;
/// Share of the descent rate below which a landing neither sinks nor climbs.
const STILL_SHARE: f64 = 0.25;
/// Time over which the climb rate of a craft that bounces is averaged, s.
const JOLT_S: f64 = 0.3;
/// Rate at which the setpoint of a landing comes down to a craft that stopped below it, m/s.
const CATCH_UP_MPS: f64 = 2.0;
/// How far the setpoint must be below a craft that does not sink, m.
const SETPOINT_BELOW_M: f64 = 0.3;
/// Rates at which the throttle is taken off while a craft does not sink, and given back, µs/s.
const RELIEF_US_PER_S: f64 = 120.0;
const GIVE_BACK_US_PER_S: f64 = 300.0;
/// Most throttle taken off, µs: the floor of the parameters is reached in any case.
const RELIEF_LIMIT_US: f64 = 600.0;
/// Throttle taken off at which the craft is flown level, µs.
const LEVEL_US: f64 = 80.0;
/// Throttle taken off at which a craft that does not sink is sure to stand, µs.
const STANDS_US: f64 = 120.0;

/// The path down.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Path {
    began: SimTime,
    /// Highest altitude of this landing, m.
    highest_m: f64,
    /// Start of the part at the present rate.
    rate_since: SimTime,
    rate_start_m: f64,
    rate_mps: f64,
    /// When it was first too fast over ground for the last metres.
    fast_since: Option<SimTime>,
    /// Climb rate without the jolts of the legs, m/s.
    climb_mps: f64,
    /// Throttle taken off to feel for the ground, µs.
    relief_us: f64,
}

impl Path {
    fn begin(now: &NavInputs, rate_mps: f64) -> Self {
        Self {
            began: now.time,
            highest_m: now.alt_m,
            rate_since: now.time,
            rate_start_m: now.alt_m,
            rate_mps,
            fast_since: None,
            climb_mps: now.climb_mps,
            relief_us: 0.0,
        }
    }

    fn setpoint_m(&self, now: &NavInputs, params: &Params) -> f64 {
        let elapsed_s = now.time.seconds_since(self.rate_since);
        let landing_altitude_m = f64::from(params.landing_altitude_m);
        landing_setpoint_m(self.rate_start_m, self.rate_mps, elapsed_s, now.alt_m, landing_altitude_m)
    }

    /// A craft that still flies back to its place does not sink into the ground on the way. It waits once for a while:
    /// one that the wind carries off must come down, too.
    fn waits_for_slow_ground(&mut self, now: &NavInputs) -> bool {
        let is_low = (1.0..LAST_METRES_M).contains(&now.alt_m);
        if !is_low || now.vel_ne.norm() <= TOUCHDOWN_MPS {
            return false;
        }
        let since = *self.fast_since.get_or_insert(now.time);
        now.time.seconds_since(since) < FAST_PATIENCE_S
    }
}

/// Setpoint of the altitude and its rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DescentSetpoint {
    /// Altitude, m.
    pub altitude_m: f64,
    /// Climb rate, m/s.
    pub climb_mps: f64,
}

/// The landing, from the first update in LANDING on.
#[derive(Debug, Clone, Default)]
pub(super) struct Descent {
    path: Option<Path>,
    timer: TouchdownTimer,
    held_us: Option<u64>,
}

impl Descent {
    /// Takes the altitude of this update, m.
    pub(super) fn follow_altitude(&mut self, altitude_m: f64) {
        if let Some(path) = &mut self.path {
            path.highest_m = path.highest_m.max(altitude_m);
        }
    }

    /// How far the craft has come down from the highest point of the landing, m.
    pub(super) fn descended_m(&self, altitude_m: f64) -> f64 {
        self.path.map_or(0.0, |path| path.highest_m - altitude_m)
    }

    /// Runs the land detector's timer on the conditions of this update, once the descent has begun.
    pub(super) fn time_touchdown(&mut self, guards: &TouchdownGuards, time: SimTime) -> Option<u64> {
        if self.path.is_some() {
            self.held_us = self.timer.update(time, guards.all_hold());
        }
        self.held_us
    }

    /// Time the conditions of the touchdown have held, µs.
    pub(super) fn held_us(&self) -> Option<u64> {
        self.held_us
    }

    /// Moves the path on; returns the time since it began, s. A rescue sinks at its own rate down to the last metres.
    pub(super) fn advance(&mut self, now: &NavInputs, params: &Params, rescue: Option<Rescue>) -> f64 {
        let slow = params.descent_rate_mps();
        let sinking = match rescue {
            Some(rescue) if now.alt_m > SLOW_LANDING_M => rescue.descend_mps.max(slow),
            Some(_) | None => slow,
        };
        let path = self.path.get_or_insert_with(|| Path::begin(now, sinking));
        let rate = if path.waits_for_slow_ground(now) { 0.0 } else { sinking };
        #[expect(clippy::float_cmp, reason = "the rate is copied, not computed")]
        if path.rate_mps != rate {
            path.rate_start_m = path.setpoint_m(now, params);
            path.rate_since = now.time;
            path.rate_mps = rate;
        }
        now.time.seconds_since(path.began)
    }

    /// The altitude setpoint of this update, for a controller whose setpoint is `setpoint_m` now.
    ///
    /// Low and still although it should sink, the craft stands, or the air carries it. Below the landing altitude it
    /// does not climb back to a setpoint above it but goes on down from where it is, and it takes the throttle off bit
    /// by bit: on the ground until it stands firmly, in the air until it sinks again.
    pub(super) fn setpoint(
        &mut self,
        now: &NavInputs,
        params: &Params,
        setpoint_m: f64,
    ) -> Option<DescentSetpoint> {
        let path = self.path.as_mut()?;
        let is_low = now.alt_m < f64::from(params.landing_altitude_m).max(LOWEST_LANDING_M);
        path.climb_mps += (now.climb_mps - path.climb_mps) * (now.dt / (JOLT_S + now.dt));
        let still = STILL_SHARE * params.descent_rate_mps();
        let is_down = path.rate_mps > 0.0 && is_low;
        let below = now.alt_m - setpoint_m;
        if is_down && path.climb_mps > -still && below < 0.0 {
            path.rate_start_m -= CATCH_UP_MPS * now.dt;
        }
        let rests = is_down && path.climb_mps.abs() < still && below > SETPOINT_BELOW_M;
        let rate = if rests { RELIEF_US_PER_S } else { -GIVE_BACK_US_PER_S };
        path.relief_us = (path.relief_us + rate * now.dt).clamp(0.0, RELIEF_LIMIT_US);
        Some(DescentSetpoint { altitude_m: path.setpoint_m(now, params), climb_mps: -path.rate_mps })
    }

    /// Throttle to take off, µs.
    pub(super) fn relief_us(&self) -> f64 {
        self.path.map_or(0.0, |path| path.relief_us)
    }

    /// Share of the lean demand that is flown: a craft that stands is not tilted on its legs.
    pub(super) fn lean_share(&self) -> f64 {
        1.0 - (self.relief_us() / LEVEL_US).min(1.0)
    }

    /// Whether the craft is sure to stand on its legs.
    pub(super) fn stands(&self) -> bool {
        self.relief_us() >= STANDS_US
    }
}
