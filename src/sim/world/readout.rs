//! Reads the present instant of a world, and its settings.

use crate::geo::LocalFrame;
use crate::signals::{SensorFrame, SimTime};
use crate::sim::airframe::Airframe;
use crate::sim::clock::Clock;
use crate::sim::config::Noise;
use crate::sim::event::WorldEvent;
use crate::sim::switches::Switches;
use crate::sim::truth::Truth;
use crate::sim::wind::Wind;
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
    /// Level of turbulence.
    pub turbulence: Turbulence,
    /// Sensor errors on or off.
    pub noise: Noise,
    /// Rare switches.
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

    /// Returns the maximum thrust over weight in the air at the craft, with its payload.
    pub fn thrust_to_weight(&self) -> f64 {
        let unladen = self.airframe.thrust_to_weight() * self.air_now.density_ratio;
        unladen * self.airframe.mass_kg / self.plant.mass_kg()
    }

    /// Returns the sensor readings of the present instant.
    pub fn sensors(&self) -> &SensorFrame {
        &self.frame
    }

    /// Returns the true state at the present instant.
    pub fn truth(&self) -> &Truth {
        &self.truth
    }

    /// Returns the simulated time since boot.
    pub fn time(&self) -> SimTime {
        self.clock.time
    }

    /// Returns time, seed and faults.
    pub fn clock(&self) -> &Clock {
        &self.clock
    }

    /// Returns the clock, to report the engagement to it and to take its events.
    pub fn clock_mut(&mut self) -> &mut Clock {
        &mut self.clock
    }

    /// Returns the airframe.
    pub fn airframe(&self) -> &Airframe {
        &self.airframe
    }

    /// Returns the frame that turns truth into latitude and longitude.
    pub fn local_frame(&self) -> &LocalFrame {
        self.sensors.local()
    }

    /// Takes the oldest waiting event.
    pub fn take_event(&mut self) -> Option<WorldEvent> {
        self.clock.take_event()
    }
}
