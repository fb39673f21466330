//! Detects a craft that does not move although it is commanded to descend.

use super::GroundMeasurement;
use crate::geo::GRAVITY;
use crate::signals::SimTime;

/// The time without motion after which the craft counts as landed, s.
pub const STATIONARY_S: f64 = 5.0;
/// The limits of a craft without motion: vertical speed, m/s, turn rate, rad/s, and the deviation of the specific
/// force from gravity as a share.
const CLIMB_MPS: f64 = 0.1;
const RATE_RPS: f64 = 5.0 * std::f64::consts::PI / 180.0;
const FORCE_SHARE: f64 = 0.05;
/// The time constant of the averages, s. Sensor noise is no motion.
const AVERAGE_S: f64 = 0.5;

/// Averages of the motion, and the time without motion.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct StationaryTimer {
    force_mps2: f64,
    rate_rps: f64,
    climb_mps: f64,
    speed_mps: f64,
    since: Option<SimTime>,
    held_s: f64,
}

impl StationaryTimer {
    /// Takes the motion of one cycle.
    pub(super) fn observe(&mut self, now: &GroundMeasurement, dt: f64) {
        let share = dt / (AVERAGE_S + dt);
        let average = |value: &mut f64, sample: f64| {
            if sample.is_finite() {
                *value += share * (sample - *value);
            }
        };
        average(&mut self.force_mps2, now.force_flu.norm());
        average(&mut self.rate_rps, now.rate_rps);
        average(&mut self.climb_mps, now.climb_mps);
        // An unknown ground speed counts as zero: nothing else moves a craft that stays in the air at less and less
        // throttle.
        average(&mut self.speed_mps, now.ground_speed_mps.unwrap_or(0.0));
    }

    /// Runs while the throttle is reduced for a descent and no sensor shows motion. Ground speed counts from
    /// `max_speed_mps`.
    pub(super) fn update(&mut self, lowers_throttle: bool, max_speed_mps: f64, time: SimTime) {
        let is_still = (self.force_mps2 / GRAVITY - 1.0).abs() < FORCE_SHARE
            && self.rate_rps < RATE_RPS
            && self.climb_mps.abs() < CLIMB_MPS
            && self.speed_mps < max_speed_mps;
        if !(lowers_throttle && is_still) {
            return self.restart();
        }
        let since = *self.since.get_or_insert(time);
        self.held_s = time.seconds_since(since);
    }

    pub(super) fn restart(&mut self) {
        (self.since, self.held_s) = (None, 0.0);
    }

    /// Returns the time without motion, s.
    pub(super) fn held_s(&self) -> f64 {
        self.held_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    const STANDING: GroundMeasurement = GroundMeasurement {
        force_flu: Vector3::new(0.0, 0.0, GRAVITY),
        rate_rps: 0.0,
        motor_square: 0.01,
        altitude_m: Some(10.0),
        climb_mps: 0.0,
        ground_speed_mps: Some(0.0),
    };

    /// Returns the time without motion after `seconds` of this measurement, s.
    fn held(now: &GroundMeasurement, lowers_throttle: bool, seconds: u64) -> f64 {
        let mut timer = StationaryTimer::default();
        for cycle in 0..seconds * 100 {
            timer.observe(now, 0.01);
            timer.update(lowers_throttle, 0.5, SimTime::from_secs_f64(cycle as f64 / 100.0));
        }
        timer.held_s()
    }

    #[test]
    fn a_craft_at_rest_is_landed_whatever_the_barometer_says() {
        assert!(held(&STANDING, true, 10) > STATIONARY_S);
        assert_eq!(held(&STANDING, false, 10), 0.0);
    }

    #[test]
    fn any_motion_is_flight() {
        let moving = [
            GroundMeasurement { climb_mps: -0.11, ..STANDING },
            GroundMeasurement { ground_speed_mps: Some(0.51), ..STANDING },
            GroundMeasurement { rate_rps: 0.1, ..STANDING },
            GroundMeasurement { force_flu: Vector3::new(0.0, 0.0, 0.94 * GRAVITY), ..STANDING },
        ];
        for now in moving {
            assert_eq!(held(&now, true, 10), 0.0, "{now:?}");
        }
    }
}
