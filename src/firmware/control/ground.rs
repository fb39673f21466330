//! Whether the legs carry the craft.
//!
//! In the air the accelerometer feels the thrust; on the ground it feels gravity whatever the motors do. How much
//! thrust a motor command makes is learned in flight, so what the accelerometer feels beyond it is weight on the legs.
//! A craft that is kept in place by its autopilot there would lean against the ground until it falls over.

use crate::firmware::estimate::Estimate;
use crate::geo::GRAVITY;

/// Altitude above home from which the thrust is learned, m.
const AIRBORNE_M: f64 = 1.0;
/// Time constants of learning and of the averages that are compared, s.
const LEARN_S: f64 = 2.0;
const AVERAGE_S: f64 = 0.05;
/// Share of the weight on the legs that begins and that ends contact.
const LOADED_SHARE: f64 = 0.3;
const FREE_SHARE: f64 = 0.1;
/// How long the load must last, s.
const LOADED_S: f64 = 0.3;
/// Standing is feeling gravity, within this share, and not moving, m/s: in the air the flow through the rotors changes
/// the thrust, too. Faster than the second speed the craft does not stand any more.
const STEADY_SHARE: f64 = 0.2;
const STILL_MPS: f64 = 0.5;
const MOVING_MPS: f64 = 1.0;

/// Watches for weight on the legs.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Legs {
    /// Specific force per mean square of the motor commands, m/s².
    thrust: Option<f64>,
    force: f64,
    square: f64,
    loaded_s: f64,
    is_loaded: bool,
}

impl Legs {
    /// Whether the legs carry weight.
    pub(super) fn are_loaded(&self) -> bool {
        self.is_loaded
    }

    /// The motors stand: nothing is felt of them.
    pub(super) fn rest(&mut self) {
        (self.loaded_s, self.is_loaded) = (0.0, false);
    }

    /// One update, `dt` seconds after the last, with the motor commands (0…1) in force.
    pub(super) fn update(&mut self, motors: &[f64; 4], estimate: &Estimate, dt: f64) {
        let share = dt / (AVERAGE_S + dt);
        let square = motors.iter().map(|motor| motor * motor).sum::<f64>() / 4.0;
        self.square += share * (square - self.square);
        self.force += share * (estimate.force_flu.z - self.force);
        if self.square < 1e-4 {
            return self.rest();
        }
        let now = self.force / self.square;
        let is_airborne = estimate.altitude_valid && estimate.alt_m > AIRBORNE_M && !self.is_loaded;
        let thrust = self.thrust.get_or_insert(now);
        if is_airborne {
            *thrust += (dt / (LEARN_S + dt)) * (now - *thrust);
        }
        let on_legs = 1.0 - *thrust * self.square / GRAVITY;
        let is_steady = (self.force / GRAVITY - 1.0).abs() < STEADY_SHARE;
        let speed = estimate.climb_mps.hypot(estimate.vel_ne.norm());
        self.loaded_s =
            if on_legs > LOADED_SHARE && is_steady && speed < STILL_MPS { self.loaded_s + dt } else { 0.0 };
        self.is_loaded = if self.is_loaded {
            on_legs > FREE_SHARE && speed < MOVING_MPS
        } else {
            self.loaded_s >= LOADED_S
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(altitude_m: f64, force: f64) -> Estimate {
        let mut estimate = Estimate { altitude_valid: true, alt_m: altitude_m, ..Estimate::default() };
        estimate.force_flu.z = force;
        estimate
    }

    #[test]
    fn throttling_down_in_the_air_is_no_contact_but_on_the_ground_it_is() {
        let mut legs = Legs::default();
        for _ in 0..1000 {
            legs.update(&[0.5; 4], &at(10.0, GRAVITY), 0.01);
        }
        // In the air half the command is a quarter of the force.
        for _ in 0..50 {
            legs.update(&[0.25; 4], &at(10.0, GRAVITY / 4.0), 0.01);
            assert!(!legs.are_loaded());
        }
        for _ in 0..50 {
            legs.update(&[0.4; 4], &at(0.0, GRAVITY), 0.01);
        }
        assert!(legs.are_loaded());
        for _ in 0..50 {
            legs.update(&[0.52; 4], &at(0.0, GRAVITY), 0.01);
        }
        assert!(!legs.are_loaded());
    }
}
