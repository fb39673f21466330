//! Crash detection: a craft that hits something turns against its setpoint, faster than its motors can stop.

use crate::signals::SimTime;

/// The spread between the slowest and the fastest motor, as a share of their range, at which they have no reserve left.
const SATURATED_SHARE: f64 = 0.95;

/// The reaction to a crash.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CrashAction {
    #[default]
    Off,
    /// The sticks are ignored and the craft is levelled.
    Level,
    /// The motors are stopped.
    Disarm,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CrashConfig {
    pub action: CrashAction,
    /// The angular acceleration above which it looks like a crash, °/s².
    pub slope_dps2: f64,
    /// The rate error above which it looks like a crash, °/s.
    pub error_dps: f64,
    /// The setpoint from which nothing counts as a crash, °/s.
    pub setpoint_dps: f64,
    /// The time for which the signs must last, s.
    pub delay_s: f64,
    /// The longest time of levelling, s.
    pub time_s: f64,
    /// The tilt below which levelling ends, rad, if the rates are below `done_rate_dps` too.
    pub done_tilt_rad: f64,
    /// The rate below which levelling ends, °/s, if the tilt is below `done_tilt_rad` too.
    pub done_rate_dps: f64,
}

/// The inputs of the detection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrashFacts {
    pub now: SimTime,
    /// The filtered gyro rates, °/s.
    pub gyro_dps: [f64; 3],
    /// The rate setpoints, °/s.
    pub setpoint_dps: [f64; 3],
    /// The spread between the slowest and the fastest motor, as a share of their range.
    pub motor_spread: f64,
    /// The tilt from level, rad.
    pub tilt_rad: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CrashDetector {
    last: Option<(SimTime, [f64; 3])>,
    signs_since: Option<SimTime>,
    levelling_since: Option<SimTime>,
}

impl CrashDetector {
    /// Returns `true` while the craft is being levelled after a crash.
    pub fn is_levelling(&self) -> bool {
        self.levelling_since.is_some()
    }

    /// Forgets what was seen so far. Called while the detection is off or the craft is not flying.
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    /// Runs one step while the craft is flying and watched. Returns `true` if it has just recognised a crash.
    pub fn update(&mut self, config: &CrashConfig, facts: &CrashFacts) -> bool {
        let last = self.last.replace((facts.now, facts.gyro_dps));
        if let Some(since) = self.levelling_since {
            let slow = facts.gyro_dps.iter().all(|rate| rate.abs() < config.done_rate_dps);
            let expired = facts.now.seconds_since(since) >= config.time_s;
            if expired || slow && facts.tilt_rad < config.done_tilt_rad {
                self.levelling_since = None;
            }
            return false;
        }
        let Some((then, before)) = last else { return false };
        let dt = facts.now.seconds_since(then);
        let hit = (0..3).any(|axis| {
            let setpoint = facts.setpoint_dps[axis];
            let slope = (facts.gyro_dps[axis] - before[axis]) / dt.max(1e-6);
            slope.abs() > config.slope_dps2
                && (setpoint - facts.gyro_dps[axis]).abs() > config.error_dps
                && setpoint.abs() < config.setpoint_dps
        });
        if !hit || facts.motor_spread < SATURATED_SHARE {
            self.signs_since = None;
            return false;
        }
        let since = *self.signs_since.get_or_insert(facts.now);
        if facts.now.seconds_since(since) < config.delay_s {
            return false;
        }
        self.signs_since = None;
        self.levelling_since = (config.action == CrashAction::Level).then_some(facts.now);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CONFIG: CrashConfig = CrashConfig {
        action: CrashAction::Level,
        slope_dps2: 50_000.0,
        error_dps: 400.0,
        setpoint_dps: 350.0,
        delay_s: 0.0,
        time_s: 0.5,
        done_tilt_rad: 0.17,
        done_rate_dps: 100.0,
    };

    fn at(ms: u64, roll_dps: f64) -> CrashFacts {
        CrashFacts {
            now: SimTime(10_000_000 + ms * 1000),
            gyro_dps: [roll_dps, 0.0, 0.0],
            setpoint_dps: [0.0; 3],
            motor_spread: 1.0,
            tilt_rad: 1.0,
        }
    }

    /// Returns `true` if a jump of the roll rate within a millisecond counts as a crash.
    fn detects(config: &CrashConfig, facts: CrashFacts) -> bool {
        let mut detector = CrashDetector::default();
        detector.update(config, &at(0, 0.0));
        detector.update(config, &facts)
    }

    #[test]
    fn all_signs_together_are_a_crash() {
        assert!(detects(&CONFIG, at(1, 500.0)));
        assert!(detects(&CONFIG, CrashFacts { gyro_dps: [0.0, 0.0, -500.0], ..at(1, 0.0) }));
        for (what, facts) in [
            ("a small error", at(1, 390.0)),
            ("motors with something left", CrashFacts { motor_spread: 0.9, ..at(1, 500.0) }),
            ("a flip", CrashFacts { setpoint_dps: [-400.0, 0.0, 0.0], ..at(1, 500.0) }),
            ("a slow change", at(20, 500.0)),
        ] {
            assert!(!detects(&CONFIG, facts), "{what}");
        }
    }

    #[test]
    fn signs_must_last_for_the_delay() {
        let config = CrashConfig { delay_s: 0.003, ..CONFIG };
        let mut detector = CrashDetector::default();
        let seen: Vec<_> = (0..6).map(|ms| detector.update(&config, &at(ms, 500.0 * ms as f64))).collect();
        assert_eq!(seen, [false, false, false, false, true, false]);
    }

    #[test]
    fn levelling_ends_when_level_and_slow_or_in_time() {
        let crashed = || {
            let mut detector = CrashDetector::default();
            detector.update(&CONFIG, &at(0, 0.0));
            assert!(detector.update(&CONFIG, &at(1, 500.0)) && detector.is_levelling());
            detector
        };
        let mut detector = crashed();
        detector.update(&CONFIG, &CrashFacts { tilt_rad: 0.1, ..at(100, 101.0) });
        assert!(detector.is_levelling(), "still turning");
        detector.update(&CONFIG, &at(200, 50.0));
        assert!(detector.is_levelling(), "still tilted");
        detector.update(&CONFIG, &CrashFacts { tilt_rad: 0.1, ..at(300, 50.0) });
        assert!(!detector.is_levelling());

        let mut detector = crashed();
        detector.update(&CONFIG, &at(500, 300.0));
        assert!(detector.is_levelling());
        detector.update(&CONFIG, &at(501, 300.0));
        assert!(!detector.is_levelling());
    }

    #[test]
    fn disarming_levels_nothing() {
        let config = CrashConfig { action: CrashAction::Disarm, ..CONFIG };
        let mut detector = CrashDetector::default();
        detector.update(&config, &at(0, 0.0));
        assert!(detector.update(&config, &at(1, 500.0)));
        assert!(!detector.is_levelling());
    }
}
