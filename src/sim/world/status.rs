//! The settings that the World panel shows.

use arrayvec::ArrayVec;

use crate::sim::config::{Noise, Wind};
use crate::sim::fault::{ActiveFault, Fault, MAX_FAULTS, ScheduledFault};
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
    /// Active faults and the remaining seconds of each.
    pub faults: ArrayVec<(Fault, Option<f64>), MAX_FAULTS>,
    /// Number of waiting faults.
    pub waiting: usize,
    /// Number of motor commands refused because they were not numbers.
    pub refused_commands: u64,
}

impl World {
    /// Returns the waiting faults.
    pub fn waiting_faults(&self) -> &[ScheduledFault] {
        self.faults.waiting()
    }

    /// Returns the present settings of air, noise and faults.
    pub fn status(&self) -> WorldStatus {
        let left =
            |fault: &ActiveFault| (fault.fault, fault.until.map(|until| until.seconds_since(self.time)));
        WorldStatus {
            wind: self.air.settled_wind(),
            gust_mps: self.air.gusts.size_mps(),
            gust_blowing: self.air.gusts.is_blowing(),
            turbulence: self.air.turbulence.level,
            noise: self.sensors.noise,
            switches: self.switches,
            faults: self.faults.active().iter().map(left).collect(),
            waiting: self.faults.waiting().len(),
            refused_commands: self.refused_commands,
        }
    }
}
