//! Touchdown by jerk: the bump of the ground on a landing craft.

use nalgebra::Vector3;

/// The cut-off of the filter on the jerk, Hz.
const FILTER_HZ: f64 = 10.0;
/// The factor on a bump near the ground in altitude hold.
const NEAR_GROUND_FACTOR: f64 = 1.5;
/// The unit of the setting: threshold × this = m/s³.
const THRESHOLD_UNIT: f64 = 10.0;
/// Sticks and throttle within this many % of rest count as hands off.
const HANDS_OFF_PERCENT: f64 = 5.0;

/// The facts that decide if a bump is a touchdown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImpactFacts {
    /// `true` if the throttle was raised since arming.
    pub raised: bool,
    /// Largest stick deflection, % of full stick.
    pub stick_percent: f64,
    /// Throttle, %.
    pub throttle_percent: f64,
    /// `true` if altitude hold is on.
    pub alt_hold: bool,
    /// `true` below the altitude under which a touchdown may be declared.
    pub near_ground: bool,
}

/// The low-passed magnitude of the jerk, updated a hundred times a second.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Impact {
    previous: Option<Vector3<f64>>,
    jerk: Vector3<f64>,
}

impl Impact {
    /// Takes the specific force (m/s², any frame) of this update, `dt` seconds after the last.
    pub(super) fn observe(&mut self, specific_force: Vector3<f64>, dt: f64) {
        let previous = self.previous.replace(specific_force).unwrap_or(specific_force);
        if dt > 0.0 {
            let omega_dt = std::f64::consts::TAU * FILTER_HZ * dt;
            self.jerk += ((specific_force - previous) / dt - self.jerk) * (omega_dt / (1.0 + omega_dt));
        }
    }

    /// Returns `true` if a bump above `threshold` (setting units, 0 = never) ended the flight.
    pub(super) fn is_touchdown(&self, threshold: f64, facts: &ImpactFacts) -> bool {
        let hands_off = facts.stick_percent < HANDS_OFF_PERCENT && facts.throttle_percent < HANDS_OFF_PERCENT;
        if threshold <= 0.0 || !facts.raised || !(hands_off || facts.alt_hold) {
            return false;
        }
        let factor = if facts.alt_hold && facts.near_ground { NEAR_GROUND_FACTOR } else { 1.0 };
        self.jerk.norm() * factor > threshold * THRESHOLD_UNIT
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LANDING: ImpactFacts = ImpactFacts {
        raised: true,
        stick_percent: 0.0,
        throttle_percent: 0.0,
        alt_hold: false,
        near_ground: false,
    };

    fn after_bump(size: f64) -> Impact {
        let mut impact = Impact::default();
        impact.observe(Vector3::new(0.0, 0.0, 9.8), 0.01);
        impact.observe(Vector3::new(0.0, 0.0, 9.8 + size), 0.01);
        impact
    }

    #[test]
    fn a_bump_ends_a_landing_but_not_a_flight() {
        let bump = after_bump(10.0);
        assert!(bump.is_touchdown(10.0, &LANDING));
        assert!(!bump.is_touchdown(0.0, &LANDING));
        assert!(!bump.is_touchdown(10.0, &ImpactFacts { raised: false, ..LANDING }));
        assert!(!bump.is_touchdown(10.0, &ImpactFacts { throttle_percent: 30.0, ..LANDING }));
        assert!(bump.is_touchdown(10.0, &ImpactFacts { throttle_percent: 30.0, alt_hold: true, ..LANDING }));
    }

    #[test]
    fn near_the_ground_a_smaller_bump_will_do() {
        let bump = after_bump(1.5);
        let held = ImpactFacts { alt_hold: true, ..LANDING };
        assert!(!bump.is_touchdown(6.0, &held));
        assert!(bump.is_touchdown(6.0, &ImpactFacts { near_ground: true, ..held }));
    }
}
