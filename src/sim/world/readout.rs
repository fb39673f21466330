//! Reads the present instant of a world.

use crate::geo::LocalFrame;
use crate::signals::{SensorFrame, SimTime};
use crate::sim::airframe::Airframe;
use crate::sim::clock::Clock;
use crate::sim::event::WorldEvent;
use crate::sim::truth::Truth;

use super::World;

impl World {
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

    pub fn clock(&self) -> &Clock {
        &self.clock
    }

    /// Returns the clock, to report the engagement to it and to take its events.
    pub fn clock_mut(&mut self) -> &mut Clock {
        &mut self.clock
    }

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
