//! Detects weight on the legs of the craft.
//!
//! In the air the accelerometer measures the thrust; on the ground it measures gravity whatever the motors do. The
//! thrust of a motor command is learned in flight, so the force beyond it is weight on the legs. There, a craft that
//! its autopilot keeps in place would tilt against the ground until it falls over.

use super::GroundMeasurement;
use crate::geo::GRAVITY;
use crate::math;

/// The altitude above home from which the thrust is learned, m.
const AIRBORNE_M: f64 = 1.0;
/// A craft has lifted off when it measures more than this multiple of gravity, is above this altitude, m, or moves
/// vertically at this speed, m/s.
const LIFTING_LOAD: f64 = 1.06;
const LIFTED_M: f64 = 0.5;
const LIFTED_MPS: f64 = 0.3;
/// The time constants of learning and of the averages that are compared, s.
const LEARN_S: f64 = 2.0;
const AVERAGE_S: f64 = 0.05;
/// The shares of the weight on the legs at which contact begins and ends.
const LOADED_SHARE: f64 = 0.3;
const FREE_SHARE: f64 = 0.1;
/// The time that the load must last, s.
const LOADED_S: f64 = 0.3;
/// A craft is on the ground if it measures gravity, within this share, and does not move, m/s. In the air the flow
/// through the rotors changes the thrust, too. Above the second speed the craft is no longer on the ground.
const STEADY_SHARE: f64 = 0.2;
const STILL_MPS: f64 = 0.5;
const MOVING_MPS: f64 = 1.0;
/// The minimum push of the ground beyond the force of the motors, m/s².
const PUSH_MPS2: f64 = 0.5 * GRAVITY;
/// A craft reaches the ground from above. Its legs take load only this far below its greatest height, m.
const SUNK_M: f64 = 0.1;

/// Watches for weight on the legs.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct GroundContact {
    /// `true` once the craft has left the ground since arming.
    has_lifted_off: bool,
    /// Specific force per mean square of the motor commands, m/s².
    thrust: Option<f64>,
    force: f64,
    square: f64,
    loaded_s: f64,
    is_loaded: bool,
    /// Greatest altitude since the legs last carried the craft, m.
    peak_m: Option<f64>,
    /// Specific force of the last cycle that the motors cannot make, m/s².
    push_mps2: f64,
}

impl GroundContact {
    /// Returns `true` if the legs carry weight.
    pub(super) fn on_ground(&self) -> bool {
        !self.has_lifted_off || self.is_loaded
    }

    /// Returns `true` if the craft has left the ground since arming.
    pub(super) fn has_lifted_off(&self) -> bool {
        self.has_lifted_off
    }

    /// Returns `true` if something other than the motors pushes the craft: the ground, before the lift-off and at a
    /// bump.
    pub(super) fn is_pushed(&self) -> bool {
        !self.has_lifted_off || self.push_mps2 > PUSH_MPS2
    }

    /// Returns the specific force along the thrust in multiples of gravity.
    pub(super) fn load(&self) -> f64 {
        self.force / GRAVITY
    }

    /// Resets the detector when the craft is disarmed.
    pub(super) fn rest(&mut self) {
        self.has_lifted_off = false;
        (self.loaded_s, self.is_loaded) = (0.0, false);
        self.peak_m = None;
    }

    /// Returns the part of the specific force that the motors cannot make, m/s². A force between zero and their full
    /// thrust can come from the motors while they are throttled.
    fn push(&self, now: &GroundMeasurement) -> f64 {
        let thrust = self.thrust.unwrap_or(0.0) * self.square;
        let up = now.force_flu.z;
        math::hypot(now.force_flu.xy().norm(), (up - thrust).max(0.0) + up.min(0.0))
    }

    /// Takes one cycle of an armed craft, `dt` seconds after the last.
    pub(super) fn update(&mut self, now: &GroundMeasurement, dt: f64) {
        let share = dt / (AVERAGE_S + dt);
        self.square += share * (now.motor_square - self.square);
        self.force += share * (now.force_flu.z - self.force);
        self.push_mps2 = self.push(now);
        let altitude_m = now.altitude_m.unwrap_or(f64::NEG_INFINITY);
        // Without an altitude nothing shows the lift-off, so the craft counts as lifted off.
        self.has_lifted_off |= now.altitude_m.is_none()
            || altitude_m.abs() > LIFTED_M
            || now.climb_mps.abs() > LIFTED_MPS
            || self.load() > LIFTING_LOAD;
        if !self.has_lifted_off || self.square < 1e-4 {
            (self.loaded_s, self.is_loaded) = (0.0, false);
            self.peak_m = now.altitude_m;
            return;
        }
        if self.is_loaded {
            self.peak_m = now.altitude_m;
        }
        let peak_m = self.peak_m.get_or_insert(altitude_m);
        *peak_m = peak_m.max(altitude_m);
        // After a climb against drag, the hover thrust looks like too little.
        let has_sunk = now.altitude_m.is_none() || altitude_m < *peak_m - SUNK_M;
        let felt = self.force / self.square;
        let thrust = self.thrust.get_or_insert(felt);
        if altitude_m > AIRBORNE_M && !self.is_loaded {
            *thrust += (dt / (LEARN_S + dt)) * (felt - *thrust);
        }
        let on_legs = 1.0 - *thrust * self.square / GRAVITY;
        let is_steady = (self.force / GRAVITY - 1.0).abs() < STEADY_SHARE;
        // An unknown speed is no evidence that the craft is on the ground.
        let speed = math::hypot(now.climb_mps, now.ground_speed_mps.unwrap_or(0.0));
        let is_still = now.ground_speed_mps.is_some() && speed < STILL_MPS;
        let is_pressed = on_legs > LOADED_SHARE && is_steady && is_still && has_sunk;
        self.loaded_s = if is_pressed { self.loaded_s + dt } else { 0.0 };
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
    use nalgebra::Vector3;

    fn at(altitude_m: f64, force: f64, motor: f64) -> GroundMeasurement {
        GroundMeasurement {
            force_flu: Vector3::new(0.0, 0.0, force),
            rate_rps: 0.0,
            motor_square: motor * motor,
            altitude_m: Some(altitude_m),
            climb_mps: 0.0,
            ground_speed_mps: Some(0.0),
        }
    }

    #[test]
    fn throttling_down_in_the_air_is_no_contact_but_on_the_ground_it_is() {
        let mut contact = GroundContact::default();
        for _ in 0..1000 {
            contact.update(&at(10.0, GRAVITY, 0.5), 0.01);
        }
        // In the air half the command is a quarter of the force.
        for _ in 0..50 {
            contact.update(&at(10.0, GRAVITY / 4.0, 0.25), 0.01);
            assert!(!contact.on_ground());
        }
        for _ in 0..50 {
            contact.update(&at(0.0, GRAVITY, 0.4), 0.01);
        }
        assert!(contact.on_ground());
        for _ in 0..50 {
            contact.update(&at(0.0, GRAVITY, 0.52), 0.01);
        }
        assert!(!contact.on_ground());
    }

    #[test]
    fn a_bump_counts_from_every_side_and_with_stopped_motors_but_no_change_of_the_throttle_does() {
        let mut flying = GroundContact::default();
        for _ in 0..1000 {
            flying.update(&at(10.0, GRAVITY, 0.5), 0.01);
        }
        let is_pushed = |motor: f64, x: f64, z: f64| {
            let mut contact = flying.clone();
            let mut now = at(5.0, 4.0 * GRAVITY * motor * motor, motor);
            for _ in 0..100 {
                contact.update(&now, 0.01);
            }
            now.force_flu += Vector3::new(x, 0.0, z);
            contact.update(&now, 0.01);
            contact.is_pushed()
        };
        for motor in [0.0, 0.3, 0.5] {
            let thrust = 4.0 * GRAVITY * motor * motor;
            assert!(!is_pushed(motor, 0.0, 0.0) && !is_pushed(motor, 0.0, -thrust), "{motor}");
            assert!(!is_pushed(motor, 2.0, 2.0), "drag, {motor}");
            for (x, z) in [(0.0, 10.0), (10.0, 0.0), (-10.0, 0.0), (0.0, -thrust - 10.0)] {
                assert!(is_pushed(motor, x, z), "{motor}: {x}, {z}");
            }
        }
    }

    #[test]
    fn a_ground_speed_that_is_not_known_is_no_sign_of_the_ground() {
        for (speed, stands) in [(Some(0.0), true), (Some(2.0), false), (None, false)] {
            let mut contact = GroundContact::default();
            for _ in 0..1000 {
                contact
                    .update(&GroundMeasurement { ground_speed_mps: speed, ..at(10.0, GRAVITY, 0.5) }, 0.01);
            }
            // A craft that the air slows down sinks steadily at less thrust than its weight.
            for _ in 0..50 {
                contact.update(&GroundMeasurement { ground_speed_mps: speed, ..at(9.0, GRAVITY, 0.4) }, 0.01);
            }
            assert_eq!(contact.on_ground(), stands, "{speed:?}");
        }
    }

    #[test]
    fn a_climb_against_drag_that_ends_in_a_hover_does_not_end_on_the_legs() {
        let mut contact = GroundContact::default();
        let mut altitude_m = 0.0;
        let mut fly = |seconds: f64, climb_mps: f64, motor: f64| {
            for _ in 0..(seconds / 0.01) as u32 {
                altitude_m += climb_mps * 0.01;
                contact.update(&GroundMeasurement { climb_mps, ..at(altitude_m, GRAVITY, motor) }, 0.01);
                assert!(altitude_m < 1.0 || !contact.on_ground(), "at {altitude_m:.1} m");
            }
        };
        fly(6.0, 1.2, 0.9);
        fly(3.0, 0.3, 0.62);
        fly(10.0, 0.0, 0.6);
        fly(20.0, -0.1, 0.58);
    }

    #[test]
    fn the_legs_carry_the_craft_until_it_rises() {
        let mut contact = GroundContact::default();
        for motor in [0.05, 0.3, 0.7, 0.9] {
            for _ in 0..100 {
                contact.update(&at(0.05, GRAVITY, motor), 0.01);
            }
            assert!(contact.on_ground(), "{motor}");
        }
        contact.update(&GroundMeasurement { climb_mps: 0.31, ..at(0.1, 1.1 * GRAVITY, 0.95) }, 0.01);
        assert!(!contact.on_ground());
    }
}
