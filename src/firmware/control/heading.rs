//! Heading hold (MAG) and headless flight (HEADFREE).

use crate::geo::wrap_pi;
use crate::math;

/// The yaw stick deflection (RC units) at which the pilot takes over the heading.
const STICK: f64 = 15.0;
/// The rate per error, 1/s, and the largest rate, °/s.
const GAIN: f64 = 2.0;
const LIMIT_DPS: f64 = 90.0;
/// The yaw rate below which the heading is captured, °/s.
const STILL_DPS: f64 = 15.0;

/// Holds the heading while the yaw stick is centred.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct HeadingHold {
    held_rad: Option<f64>,
}

impl HeadingHold {
    /// Returns the yaw rate (°/s, clockwise) that holds the heading; `None` while the pilot turns or the mode is off.
    pub(super) fn rate_dps(
        &mut self,
        is_on: bool,
        stick: f64,
        heading_rad: f64,
        yaw_dps: f64,
    ) -> Option<f64> {
        if !is_on || stick.abs() > STICK {
            self.held_rad = None;
            return None;
        }
        if self.held_rad.is_none() && yaw_dps.abs() < STILL_DPS {
            self.held_rad = Some(heading_rad);
        }
        let error = wrap_pi(self.held_rad? - heading_rad);
        Some((GAIN * error.to_degrees()).clamp(-LIMIT_DPS, LIMIT_DPS))
    }

    /// Changes the held heading. Does nothing while no heading is held, because the pilot's stick decides then.
    pub(super) fn turn_to(&mut self, heading_rad: f64) {
        if let Some(held) = &mut self.held_rad {
            *held = heading_rad;
        }
    }
}

/// Converts roll and pitch sticks, given relative to `reference_rad`, for a craft that heads to `heading_rad`.
pub(super) fn headless(roll: f64, pitch: f64, reference_rad: f64, heading_rad: f64) -> (f64, f64) {
    let (sin, cos) = math::sin_cos(heading_rad - reference_rad);
    (roll * cos - pitch * sin, pitch * cos + roll * sin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn holds_what_it_found_and_lets_the_pilot_turn() {
        let mut hold = HeadingHold::default();
        assert_eq!(hold.rate_dps(true, 0.0, 1.0, 0.0), Some(0.0));
        assert!(hold.rate_dps(true, 0.0, 1.1, 0.0).unwrap() < -10.0);
        assert_eq!(hold.rate_dps(true, 100.0, 1.1, 0.0), None);
        assert_eq!(hold.rate_dps(true, 0.0, 2.0, 50.0), None);
        assert_eq!(hold.rate_dps(true, 0.0, 2.2, 5.0), Some(0.0));
    }

    #[test]
    fn a_held_heading_can_be_changed() {
        let mut hold = HeadingHold::default();
        hold.turn_to(2.0);
        assert_eq!(hold.rate_dps(true, 0.0, 1.0, 0.0), Some(0.0), "none was held");
        hold.turn_to(1.1);
        assert!(hold.rate_dps(true, 0.0, 1.0, 0.0).unwrap() > 10.0);
        hold.turn_to(1.0 + std::f64::consts::TAU);
        assert!(hold.rate_dps(true, 0.0, 1.0, 0.0).unwrap().abs() < 1e-6);
    }

    #[test]
    fn forward_stays_where_it_was_at_arming() {
        // Armed facing north, now facing east: forward stick must fly north, which is to the left.
        let (roll, pitch) = headless(0.0, 500.0, 0.0, FRAC_PI_2);
        assert!((roll + 500.0).abs() < 1e-9 && pitch.abs() < 1e-9);
        // Right stick must fly east, which is ahead.
        let (roll, pitch) = headless(500.0, 0.0, 0.0, FRAC_PI_2);
        assert!(roll.abs() < 1e-9 && (pitch - 500.0).abs() < 1e-9);
    }
}
