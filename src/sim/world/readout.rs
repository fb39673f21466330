//! Reads the present instant of a world, and reports the engagement to it.

use crate::geo::LocalFrame;
use crate::signals::{SensorFrame, SimTime};
use crate::sim::airframe::Airframe;
use crate::sim::event::WorldEvent;
use crate::sim::fault::LinkFaults;
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
        self.time
    }

    /// Returns the length of a step, µs.
    pub fn step_us(&self) -> u64 {
        self.step_us
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
        self.events.pop_at(0)
    }

    /// Reports that the autopilot engaged. Faults without `boot+` count from the first call after boot or reset.
    pub fn set_engaged(&mut self, time: SimTime) {
        self.faults.set_engaged(time);
    }

    /// Returns the seed of all randomness.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Returns `true` while the `gps-loss` fault is active.
    pub fn gps_lost(&self) -> bool {
        self.effects.gps.loss
    }

    /// Returns `true` while the `rx-loss` fault is active. No RC frame reaches the receiver then.
    pub fn rx_lost(&self) -> bool {
        self.effects.rx_loss
    }

    /// Returns the fraction of RC frames that the `rx-jitter` fault drops, 0…1. Draw from
    /// [`Stream::RxJitter`](crate::sim::Stream).
    pub fn rx_drop_fraction(&self) -> f64 {
        self.effects.rx_jitter
    }

    /// Returns the effects of the active faults on the packets of an external simulator.
    pub fn link_faults(&self) -> LinkFaults {
        self.effects.link
    }
}
