//! The altitude setpoint on a leg: a simulation of the control law of the altitude controller.

use crate::math;

/// The limit for the change of the setpoint's speed, m/s².
const ACCEL: f64 = 2.0;
/// The deceleration before the target, m/s².
const BRAKE: f64 = 1.0;
/// A step, s.
const STEP_S: f64 = 0.05;
/// The setpoint is at its target if it is this near (m) and this slow (m/s).
const THERE_M: f64 = 0.05;
const THERE_MPS: f64 = 0.4;
/// Near a target within this distance of home's altitude, a lower craft descends more slowly. The constants are the
/// distance, m, the share of the height above home in a second, 1/s, and the slowest speed, m/s.
const LOW_TARGET_M: f64 = 3.0;
const FLARE: f64 = 0.25;
const SLOWEST_FLARE_MPS: f64 = 0.3;
/// No setpoint goes below this, m, unless the target is well below home.
const LOWEST_M: f64 = 1.0;
const BELOW_HOME_M: f64 = -2.0;

/// The settings that the control law uses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SetpointLimits {
    /// `alt_hold_climb_rate`, m/s.
    pub climb_mps: f64,
    /// `ap_landing_descent_rate`, m/s: the speed near the ground on the way to a target well below home.
    pub landing_mps: f64,
    /// `ap_landing_altitude_m`.
    pub landing_alt_m: f64,
}

/// The altitude that the autopilot demands, moved towards its target within limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AltitudeSetpoint {
    /// Above home, m.
    pub altitude_m: f64,
    /// The rate of change, m/s.
    pub rate_mps: f64,
}

impl AltitudeSetpoint {
    /// Returns a setpoint at rest.
    pub fn at(altitude_m: f64) -> Self {
        Self { altitude_m, rate_mps: 0.0 }
    }

    /// Moves for `seconds` towards a target, m above home.
    pub fn run(&mut self, target_m: f64, limits: &SetpointLimits, seconds: f64) {
        let _ = self.run_until(target_m, limits, seconds, None);
    }

    /// Moves until the setpoint is within `within_m` of the target, and returns the time, s. The time is infinite if
    /// the law never leads there.
    pub fn reach(&mut self, target_m: f64, limits: &SetpointLimits, within_m: f64) -> f64 {
        self.run_until(target_m, limits, f64::INFINITY, Some(within_m))
    }

    fn run_until(
        &mut self,
        target_m: f64,
        limits: &SetpointLimits,
        seconds: f64,
        within_m: Option<f64>,
    ) -> f64 {
        let mut elapsed = 0.0;
        while elapsed < seconds {
            let to_go_m = within_m.map(|within_m| (target_m - self.altitude_m).abs() - within_m);
            if to_go_m.is_some_and(|to_go_m| to_go_m <= 0.0) {
                return elapsed;
            }
            let target = self.target_now(target_m, limits);
            let left = target - self.altitude_m;
            if left.abs() < THERE_M && self.rate_mps.abs() < THERE_MPS {
                *self = Self::at(target);
                let is_near = within_m.is_some_and(|within_m| (target_m - target).abs() <= within_m);
                return if is_near { elapsed } else { seconds };
            }
            let steady = self.steady_s(target_m, limits, to_go_m.unwrap_or(f64::INFINITY));
            let step = steady.unwrap_or(STEP_S).min(seconds - elapsed);
            let wanted = self.wanted_mps(target, limits);
            let change = ACCEL * step;
            self.rate_mps += (wanted - self.rate_mps).clamp(-change, change);
            self.altitude_m += self.rate_mps * step;
            elapsed += step;
        }
        elapsed
    }

    /// Returns the target that the navigator sets, which is never in the ground.
    fn target_now(&self, target_m: f64, limits: &SetpointLimits) -> f64 {
        if target_m >= BELOW_HOME_M {
            target_m.max(LOWEST_M.min(self.altitude_m))
        } else if self.altitude_m >= limits.landing_alt_m {
            target_m
        } else {
            target_m.max(self.altitude_m - 0.5 * math::powi(limits.landing_mps, 2))
        }
    }

    fn wanted_mps(&self, target_m: f64, limits: &SetpointLimits) -> f64 {
        let left = target_m - self.altitude_m;
        let flares = target_m.abs() < LOW_TARGET_M && self.altitude_m >= 0.0 && target_m < self.altitude_m;
        let flare = if flares { (FLARE * self.altitude_m).max(SLOWEST_FLARE_MPS) } else { f64::INFINITY };
        limits.climb_mps.min((2.0 * BRAKE * left.abs()).sqrt()).min(flare).copysign(left)
    }

    /// Returns the time for which the current rate continues, s, if it is steady now. It ends when the setpoint
    /// brakes, sinks slowly near the ground, or has moved by `to_go_m`.
    fn steady_s(&self, target_m: f64, limits: &SetpointLimits, to_go_m: f64) -> Option<f64> {
        let rate = self.wanted_mps(self.target_now(target_m, limits), limits);
        if (rate - self.rate_mps).abs() > 1e-6 || rate == 0.0 {
            return None;
        }
        let is_low = target_m < BELOW_HOME_M && self.altitude_m < limits.landing_alt_m;
        let speed = if is_low { limits.landing_mps } else { limits.climb_mps };
        if (rate.abs() - speed).abs() > 1e-6 {
            return None;
        }
        let mut way_m =
            ((target_m - self.altitude_m).abs() - 0.5 * math::powi(speed, 2) / BRAKE).min(to_go_m);
        if target_m < BELOW_HOME_M && !is_low {
            way_m = way_m.min(self.altitude_m - limits.landing_alt_m);
        } else if target_m.abs() < LOW_TARGET_M && target_m < self.altitude_m {
            way_m = way_m.min(self.altitude_m - speed / FLARE);
        }
        Some(way_m / speed).filter(|&seconds| seconds > STEP_S)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: SetpointLimits = SetpointLimits { climb_mps: 5.0, landing_mps: 0.5, landing_alt_m: 4.0 };

    #[test]
    fn a_climb_takes_its_speed_up_and_its_braking() {
        let mut setpoint = AltitudeSetpoint::at(10.0);
        // 2.5 s to 5 m/s on 6.25 m, 31.25 m at 5 m/s, 5 s to a stop on the last 12.5 m.
        let seconds = setpoint.reach(60.0, &LIMITS, 0.1);
        assert!((13.0..14.0).contains(&seconds), "{seconds}");
        let mut short = AltitudeSetpoint::at(15.0);
        short.run(80.0, &LIMITS, 3.0);
        assert!((short.altitude_m - 23.75).abs() < 0.3 && (short.rate_mps - 5.0).abs() < 0.1, "{short:?}");
    }

    #[test]
    fn the_farthest_altitudes_take_few_steps_and_end() {
        for target_m in [21_000_000.0, -21_000_000.0, 0.0, 1.0, -2.5, -60.0] {
            for start_m in [0.0, 10.0, 500_000.0] {
                let mut setpoint = AltitudeSetpoint::at(start_m);
                setpoint.run(target_m, &LIMITS, 1e9);
                assert!(setpoint.altitude_m.is_finite(), "{start_m} to {target_m}: {setpoint:?}");
            }
        }
        let mut setpoint = AltitudeSetpoint::at(20.0);
        assert!(setpoint.reach(0.0, &LIMITS, 0.5).is_infinite(), "the lowest setpoint is 1 m");
    }
}
