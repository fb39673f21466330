//! What can be read from a world at the present instant, and what it is told from outside.

use crate::geo::LocalFrame;
use crate::signals::{SensorFrame, SimTime};
use crate::sim::airframe::Airframe;
use crate::sim::event::WorldEvent;
use crate::sim::fault::LinkFaults;
use crate::sim::truth::Truth;

use super::World;

impl World {
    /// Greatest thrust over weight in the air at the craft, with its payload.
    pub fn thrust_to_weight(&self) -> f64 {
        let unladen = self.airframe.thrust_to_weight() * self.air_now.density_ratio;
        unladen * self.airframe.mass_kg / self.plant.mass_kg()
    }

    /// The sensor readings of the present instant.
    pub fn sensors(&self) -> &SensorFrame {
        &self.frame
    }

    /// The true state at the present instant.
    pub fn truth(&self) -> &Truth {
        &self.truth
    }

    /// Simulated time since boot.
    pub fn time(&self) -> SimTime {
        self.time
    }

    /// Length of a step, µs.
    pub fn step_us(&self) -> u64 {
        self.step_us
    }

    pub fn airframe(&self) -> &Airframe {
        &self.airframe
    }

    /// The frame that turns truth into latitude and longitude.
    pub fn local_frame(&self) -> &LocalFrame {
        self.sensors.local()
    }

    /// The oldest event that was not taken yet.
    pub fn take_event(&mut self) -> Option<WorldEvent> {
        self.events.pop_at(0)
    }

    /// Tells that the autopilot engaged: faults without `boot+` count from the first call after boot or reset.
    pub fn set_engaged(&mut self, time: SimTime) {
        self.faults.set_engaged(time);
    }

    /// The seed of all randomness.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Whether the `gps-loss` fault is on.
    pub fn gps_lost(&self) -> bool {
        self.effects.gps.loss
    }

    /// Whether the `rx-loss` fault is on: no RC frame reaches the receiver.
    pub fn rx_lost(&self) -> bool {
        self.effects.rx_loss
    }

    /// Fraction of RC frames that the `rx-jitter` fault drops, 0…1; draw from [`Stream::RxJitter`](crate::sim::Stream).
    pub fn rx_drop_fraction(&self) -> f64 {
        self.effects.rx_jitter
    }

    /// What the active faults do to the packets of an external simulator.
    pub fn link_faults(&self) -> LinkFaults {
        self.effects.link
    }
}
