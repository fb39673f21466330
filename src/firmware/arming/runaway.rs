//! Runaway take-off prevention. A craft with swapped motors or propellers spins faster the harder the controller works
//! against it. The motors are stopped before it hurts anyone.

use nalgebra::Vector3;

use crate::signals::SimTime;

/// The PID sum that means the controller is losing.
const PID_SUM_ALARM: f64 = 600.0;
/// The rates that confirm it, deg/s: roll, pitch, yaw.
const RATE_ALARM_DPS: [f64; 3] = [15.0, 15.0, 50.0];
/// The time for which it must last, s.
const ALARM_S: f64 = 0.075;
/// The PID sum below which the craft flies normally.
const PID_SUM_CALM: f64 = 100.0;
/// The stick deflection that counts as steering, % of full stick.
const MOVING_STICK_PERCENT: f64 = 15.0;
/// The throttle from which the craft is trusted in half the time, %.
const HIGH_THROTTLE_PERCENT: f64 = 75.0;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunawayConfig {
    /// Enables the prevention.
    pub enabled: bool,
    /// The time of normal flight that ends it for the rest of the power cycle, s.
    pub deactivate_delay_s: f64,
    /// The throttle that counts as flying, %.
    pub deactivate_throttle_percent: f64,
}

impl Default for RunawayConfig {
    fn default() -> Self {
        Self { enabled: true, deactivate_delay_s: 0.5, deactivate_throttle_percent: 20.0 }
    }
}

/// The inputs of the prevention.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunawayFacts {
    pub now: SimTime,
    /// The PID sum of each axis, before its limit.
    pub pid_sum: Vector3<f64>,
    /// The body rates, deg/s.
    pub rate_dps: Vector3<f64>,
    /// Throttle, %.
    pub throttle_percent: f64,
    /// The largest stick deflection, % of full stick.
    pub stick_percent: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Runaway {
    given_up: bool,
    alarm_since: Option<SimTime>,
    calm_since: Option<SimTime>,
}

impl Runaway {
    /// Checks the armed craft. Returns `true` if the motors must be stopped.
    pub fn update(&mut self, config: &RunawayConfig, facts: &RunawayFacts) -> bool {
        if !config.enabled || self.given_up {
            return false;
        }
        let losing = (0..3).any(|axis| {
            facts.pid_sum[axis].abs() >= PID_SUM_ALARM && facts.rate_dps[axis].abs() > RATE_ALARM_DPS[axis]
        });
        if losing {
            self.calm_since = None;
            let since = *self.alarm_since.get_or_insert(facts.now);
            return facts.now.seconds_since(since) >= ALARM_S;
        }
        self.alarm_since = None;

        let limit = config.deactivate_throttle_percent;
        let flying = (facts.throttle_percent >= limit && facts.stick_percent >= MOVING_STICK_PERCENT)
            || facts.throttle_percent >= 2.0 * limit;
        if flying && facts.pid_sum.amax() < PID_SUM_CALM {
            let since = *self.calm_since.get_or_insert(facts.now);
            let half = if facts.throttle_percent >= HIGH_THROTTLE_PERCENT { 0.5 } else { 1.0 };
            self.given_up = facts.now.seconds_since(since) >= config.deactivate_delay_s * half;
        } else {
            self.calm_since = None;
        }
        false
    }

    /// Forgets a running alarm. Called at the moment of arming.
    pub fn rearm(&mut self) {
        self.alarm_since = None;
        self.calm_since = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn facts(ms: u64, pid: f64, rate: f64, throttle: f64) -> RunawayFacts {
        RunawayFacts {
            now: SimTime(ms * 1000),
            pid_sum: Vector3::new(pid, 0.0, 0.0),
            rate_dps: Vector3::new(rate, 0.0, 0.0),
            throttle_percent: throttle,
            stick_percent: 0.0,
        }
    }

    /// Feeds the same facts each millisecond. Returns the time at which the motors are stopped, ms.
    fn stopped_after(pid: f64, rate: f64) -> Option<u64> {
        let mut runaway = Runaway::default();
        (0..1000).find(|&ms| runaway.update(&RunawayConfig::default(), &facts(ms, pid, rate, 10.0)))
    }

    #[test]
    fn losing_control_stops_the_motors_after_75_ms() {
        assert_eq!(stopped_after(600.0, 16.0), Some(75));
        assert_eq!(stopped_after(-700.0, -20.0), Some(75));
        assert_eq!(stopped_after(599.0, 16.0), None);
        assert_eq!(stopped_after(700.0, 15.0), None);
    }

    #[test]
    fn normal_flight_ends_it_for_good() {
        let mut runaway = Runaway::default();
        for ms in 0..=500 {
            assert!(!runaway.update(&RunawayConfig::default(), &facts(ms, 50.0, 5.0, 45.0)));
        }
        runaway.rearm();
        for ms in 501..800 {
            assert!(!runaway.update(&RunawayConfig::default(), &facts(ms, 900.0, 500.0, 45.0)));
        }
    }
}
