//! The time of a leg: the craft gains speed, and slows down for a stop.

use nalgebra::Vector2;

use super::estimate::Assumptions;
use crate::geo::GRAVITY;
use crate::math;

/// A step, s.
const STEP_S: f64 = 0.05;
/// The rate at which the speed follows its setpoint, 1/s. It was fitted to the legs of 2 000 random missions.
const FOLLOW: f64 = 1.5;
/// Speeds with a smaller difference count as equal, m/s.
const SAME_MPS: f64 = 0.02;
/// The share of gravity along the maximum tilt that the craft uses to plan a stop.
const STOP_SHARE: f64 = 0.35;
/// The number of steps after which the rest of a leg is assumed to be flown at the last demanded speed.
const MAX_STEPS: usize = 10_000;
/// The slowest speed before a stop is complete, m/s.
const CREEP_MPS: f64 = 0.05;

/// The geometry and the speed of a leg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LegShape {
    /// Distance to the waypoint, m.
    pub(super) distance_m: f64,
    /// Distance from the waypoint at which it counts as reached, m.
    pub(super) reach_m: f64,
    /// Speed of the leg, m/s.
    pub(super) speed_mps: f64,
    /// `true` if the craft stops at the waypoint.
    pub(super) stops: bool,
}

/// The motion of the craft over the ground between two legs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Motion {
    /// The velocity north and east, m/s.
    pub(super) velocity: Vector2<f64>,
    /// The speed setpoint, m/s. A turn does not change it.
    pub(super) setpoint_mps: f64,
}

impl Motion {
    pub(super) const REST: Self = Self { velocity: Vector2::new(0.0, 0.0), setpoint_mps: 0.0 };

    /// Flies the leg in the direction of a unit vector and returns its time, s.
    pub(super) fn fly(&mut self, leg: &LegShape, along: Vector2<f64>, assumptions: &Assumptions) -> f64 {
        let tilt = GRAVITY * math::sin(assumptions.max_angle_deg.clamp(5.0, 80.0).to_radians());
        let speed_up = match assumptions.buildup_deg {
            deg if deg > 0.0 => GRAVITY * math::tan(deg.min(45.0).to_radians()),
            _ => 0.5 * tilt,
        };
        let gain = 0.025 * assumptions.position_p;
        let mut speed = self.velocity.dot(&along);
        let mut setpoint = self.setpoint_mps;
        let mut left = leg.distance_m;
        let mut elapsed = 0.0;
        let mut demand = leg.speed_mps;
        for _ in 0..MAX_STEPS {
            if left <= leg.reach_m {
                break;
            }
            if leg.stops {
                let stop = (gain * left).min((2.0 * STOP_SHARE * tilt * left).sqrt()).max(CREEP_MPS);
                demand = leg.speed_mps.min(stop);
            }
            let before = setpoint;
            setpoint += (demand - setpoint).clamp(-tilt * STEP_S, speed_up * STEP_S);
            let is_steady = (speed - leg.speed_mps).abs() < SAME_MPS
                && (setpoint - leg.speed_mps).abs() < SAME_MPS
                && (demand - leg.speed_mps).abs() < SAME_MPS;
            let step = if is_steady { steady_s(leg, left, tilt, gain) } else { STEP_S };
            let wanted = (setpoint - before) / STEP_S + FOLLOW * (setpoint - speed);
            speed += wanted.clamp(-tilt, tilt) * STEP_S;
            left -= speed * step;
            elapsed += step;
        }
        elapsed += (left - leg.reach_m).max(0.0) / demand.max(CREEP_MPS);
        *self = if leg.stops { Self::REST } else { Self { velocity: along * speed, setpoint_mps: setpoint } };
        elapsed
    }
}

/// Returns the time until a craft at steady speed slows down or arrives, s.
fn steady_s(leg: &LegShape, left_m: f64, tilt: f64, gain: f64) -> f64 {
    let until_m = if leg.stops {
        (leg.speed_mps / gain.max(0.01))
            .max(math::powi(leg.speed_mps, 2) / (2.0 * STOP_SHARE * tilt.max(0.1)))
    } else {
        leg.reach_m
    };
    ((left_m - until_m) / leg.speed_mps).max(STEP_S)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn time_s(motion: &mut Motion, distance_m: f64, stops: bool) -> f64 {
        let leg = LegShape { distance_m, reach_m: 0.0, speed_mps: 10.0, stops };
        let leg = LegShape { reach_m: if stops { 2.0 } else { 0.0 }, ..leg };
        motion.fly(&leg, Vector2::new(1.0, 0.0), &Assumptions::default())
    }

    #[test]
    fn a_leg_takes_its_speed_up_and_its_stop() {
        let mut motion = Motion::REST;
        // 7.3 s to 10 m/s on 36 m, then 6.4 s.
        let first = time_s(&mut motion, 100.0, false);
        assert!((13.0..14.5).contains(&first), "{first}");
        let second = time_s(&mut motion, 100.0, false);
        assert!((9.9..10.1).contains(&second), "{second}");
        let last = time_s(&mut motion, 100.0, true);
        assert!((10.5..13.5).contains(&last) && motion == Motion::REST, "{last}");
    }

    #[test]
    fn a_way_back_begins_with_a_stop() {
        let mut back = Motion { velocity: Vector2::new(-10.0, 0.0), setpoint_mps: 10.0 };
        let time = time_s(&mut back, 50.0, false);
        assert!((7.0..12.0).contains(&time), "{time}");
    }

    #[test]
    fn the_longest_leg_takes_few_steps() {
        let leg = LegShape { distance_m: 2e7, reach_m: 5.0, speed_mps: 0.1, stops: true };
        let mut motion = Motion::REST;
        let time = motion.fly(&leg, Vector2::new(0.0, 1.0), &Assumptions::default());
        assert!(time > 1e6, "{time}");
    }
}
