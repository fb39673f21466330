//! Stick positions from channel values.

use super::channels::{PITCH, ROLL, THROTTLE, YAW};
use crate::signals::RC_CHANNELS;

/// The conversion of pulses to stick positions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StickConfig {
    /// The stick centre, µs.
    pub mid_us: u16,
    /// The dead band of roll and pitch, µs.
    pub deadband: u16,
    /// The dead band of yaw, µs.
    pub yaw_deadband: u16,
}

impl Default for StickConfig {
    fn default() -> Self {
        Self { mid_us: 1500, deadband: 0, yaw_deadband: 0 }
    }
}

/// Stick positions in RC command units: ±500, right and forward positive, dead bands removed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sticks {
    /// Roll, right positive.
    pub roll: f64,
    /// Pitch, forward positive.
    pub pitch: f64,
    /// Yaw, right (clockwise) positive.
    pub yaw: f64,
    /// The throttle pulse, µs.
    pub throttle_us: f64,
}

impl Sticks {
    /// Computes the stick positions for these channel values (roll, pitch, yaw, throttle, …; µs).
    pub fn from_channels(config: &StickConfig, values: &[u16; RC_CHANNELS]) -> Self {
        let deflection = |index: usize, deadband: u16| {
            let raw = (f64::from(values[index]) - f64::from(config.mid_us)).clamp(-500.0, 500.0);
            raw.signum() * (raw.abs() - f64::from(deadband)).max(0.0)
        };
        Self {
            roll: deflection(ROLL, config.deadband),
            pitch: deflection(PITCH, config.deadband),
            yaw: deflection(YAW, config.yaw_deadband),
            throttle_us: f64::from(values[THROTTLE]),
        }
    }

    /// Returns the largest deflection of roll, pitch and yaw, % of full stick.
    pub fn deflection_percent(&self) -> f64 {
        self.roll.abs().max(self.pitch.abs()).max(self.yaw.abs()) / 5.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deadband_is_removed_from_both_sides() {
        let config = StickConfig { deadband: 20, yaw_deadband: 50, ..StickConfig::default() };
        let mut values = [1500; RC_CHANNELS];
        values[..4].copy_from_slice(&[1515, 1400, 2200, 1234]);
        let sticks = Sticks::from_channels(&config, &values);
        assert_eq!((sticks.roll, sticks.pitch, sticks.yaw), (0.0, -80.0, 450.0));
        assert_eq!(sticks.throttle_us, 1234.0);
        assert_eq!(sticks.deflection_percent(), 90.0);
    }
}
