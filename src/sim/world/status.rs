//! The settings that the World panel shows.

use crate::sim::config::{Noise, Wind};
use crate::sim::switches::Switches;
use crate::telemetry::Turbulence;

use super::World;

/// The settings of a world at one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct WorldStatus {
    /// Mean wind: that of a fault, or the one that was set.
    pub wind: Wind,
    /// Strength of random gusts, m/s.
    pub gust_mps: f64,
    /// `true` while a gust is active.
    pub gust_blowing: bool,
    pub turbulence: Turbulence,
    pub noise: Noise,
    pub switches: Switches,
    /// Number of motor commands refused because they were not numbers.
    pub refused_commands: u64,
}

impl World {
    /// Returns the present settings of air and noise.
    pub fn status(&self) -> WorldStatus {
        WorldStatus {
            wind: self.air.settled_wind(),
            gust_mps: self.air.gusts.size_mps(),
            gust_blowing: self.air.gusts.is_blowing(),
            turbulence: self.air.turbulence.level,
            noise: self.sensors.noise,
            switches: self.switches,
            refused_commands: self.refused_commands,
        }
    }
}
