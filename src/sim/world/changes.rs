//! Changes of a running world: commands, faults, displacement, reset.

use nalgebra::{Vector2, Vector3};

use crate::signals::SimTime;
use crate::sim::air::usual_length_s;
use crate::sim::airframe::ROTORS;
use crate::sim::body::BodyState;
use crate::sim::clock::{Clock, FaultHost};
use crate::sim::command::WorldCommand;
use crate::sim::error::{WorldError, in_range};
use crate::sim::fault::{ActiveFault, Fault};
use crate::sim::landform::Landform;
use crate::sim::touchdown::TouchdownDetector;
use crate::sim::wind::Wind;

use super::boot::standing;
use super::{World, full_battery};

/// The depth of the payload below the centre of mass, as a share of the height of the craft on its legs.
const PAYLOAD_DEPTH: f64 = 0.5;

impl World {
    /// Changes the world. Sensors and truth of the present instant stay as they are, except for a reset: no
    /// measurement after it contains anything of the previous flight.
    ///
    /// # Errors
    /// Fails if a value is not allowed. Nothing has changed then.
    pub fn apply(&mut self, command: WorldCommand) -> Result<(), WorldError> {
        command.check()?;
        let is_planned = matches!(command, WorldCommand::Schedule(_));
        match command {
            WorldCommand::SetWind(wind) => self.air.change_wind(wind, self.clock.time),
            WorldCommand::SetGust(size) => self.air.gusts.set_size(size, self.clock.time),
            WorldCommand::GustNow(wind) => {
                self.gust(wind, None);
            }
            WorldCommand::SetTurbulence(level) => self.air.set_turbulence(level),
            WorldCommand::SetNoise(noise) => self.sensors.noise = noise,
            WorldCommand::SetSwitch(switch) => {
                let mut switches = self.switches;
                switches.set(&switch)?;
                let landform = Landform::new(switches.ground, self.relief.as_ref())?;
                self.switches = switches;
                self.set_ground_effect();
                self.set_ground(landform);
                self.sensors.gps.set_grade(self.switches.gps);
            }
            WorldCommand::SetGpsRate(rate) => self.sensors.gps.set_rate(rate),
            WorldCommand::FaultOn(..)
            | WorldCommand::FaultOff(_)
            | WorldCommand::ClearFaults
            | WorldCommand::Schedule(_) => self.change_faults(command)?,
            WorldCommand::ResetToHome => self.reset_to_home(),
        }
        // Air and loads may have jumped, unless the change is only planned.
        if !is_planned {
            self.craft.forget();
            self.refresh_loads();
        }
        Ok(())
    }

    /// Adds a wind of this velocity (ENU, m/s) to the air at the craft, in place of the wind that was added before. It comes
    /// in over the next air tick, at every height, until it is changed.
    ///
    /// # Errors
    /// Fails if it is stronger than [`Wind::MAX_MPS`] or not a number. Nothing has changed then.
    pub fn set_added_wind(&mut self, vel_enu: Vector3<f64>) -> Result<(), WorldError> {
        in_range("added wind", vel_enu.norm(), 0.0, Wind::MAX_MPS)?;
        self.air.added = vel_enu;
        Ok(())
    }

    /// Starts a gust that ends at a given time, or after the default length. Returns its end.
    fn gust(&mut self, wind: Wind, until: Option<SimTime>) -> SimTime {
        let rise_s = self.switches.gust_rise_s;
        let total_s = until.map_or(usual_length_s(rise_s), |until| until.seconds_since(self.clock.time));
        self.air.gusts.blow(wind, rise_s, total_s, self.clock.time);
        SimTime(self.clock.time.0 + SimTime::from_secs_f64(total_s).0)
    }

    pub(super) fn set_ground_effect(&mut self) {
        self.plant.set_ground_effect(self.switches.ground_effect.then_some(self.airframe.rotor_radius_m));
    }

    /// Updates the plant for the shape of the ground. A craft on the ground is then on the new ground.
    fn set_ground(&mut self, landform: Landform) {
        if self.plant.ground().landform().surface() == landform.surface() {
            return;
        }
        let body = *self.craft.body();
        let stands = self.plant.ground().contact(&body).all_legs && !self.crashed;
        self.start = standing(&self.airframe, &landform, &Vector2::zeros(), self.heading_deg);
        if stands {
            let rotors = *self.craft.rotors();
            let place = body.pos_enu.xy();
            let body = standing(&self.airframe, &landform, &place, self.truth.heading_deg());
            self.plant.set_landform(landform);
            self.craft = self.plant.at_rest(body);
            self.craft.set_rotors(rotors);
        } else {
            self.plant.set_landform(landform);
            self.place_on_or_above_ground(body);
        }
    }

    /// Moves the craft to a state, and from below the ground up to it. Returns the clearance of the state, m.
    fn place_on_or_above_ground(&mut self, mut body: BodyState) -> f64 {
        let contact = self.plant.ground().contact(&body);
        body.pos_enu.z -= contact.clearance_m.min(0.0) / contact.plane.normal().z;
        self.craft.place(body);
        contact.clearance_m
    }

    /// Moves the craft, never into the ground.
    fn teleport(&mut self, by_enu: Vector3<f64>) {
        let mut body = *self.craft.body();
        body.pos_enu += by_enu;
        if self.place_on_or_above_ground(body) > 0.0 {
            self.touchdown.set_airborne(self.clock.time);
        }
    }

    /// Puts the craft back at home, undamaged, with a full battery. Air, noise and faults stay as they are.
    pub fn reset_to_home(&mut self) {
        self.end_flight();
        self.craft = self.plant.at_rest(self.start);
        self.battery = full_battery(&self.airframe, &self.switches);
        self.update_battery_truth();
        self.command = [0.0; ROTORS];
        self.touchdown = TouchdownDetector::STANDING;
        (self.crashed, self.diverged) = (false, false);
        self.sensors.settle(self.start.pos_enu, self.start.vel_enu);
        self.rate_before = self.start.rate_flu;
        self.update_outputs_on(None);
    }
}

impl FaultHost for World {
    fn clock_mut(&mut self) -> &mut Clock {
        &mut self.clock
    }

    fn act(&mut self, begun: &ActiveFault) {
        match begun.fault {
            Fault::Push(impulse, direction) => {
                let mut body = *self.craft.body();
                body.vel_enu += direction.enu() * (impulse / self.plant.mass_kg());
                self.craft.set_body(body);
            }
            Fault::Teleport([north, east, up]) => self.teleport(Vector3::new(east, north, up)),
            Fault::Gust(wind) => {
                let end = self.gust(wind, begun.until);
                self.clock.set_fault_end(&begun.fault, end);
            }
            _ => {}
        }
    }

    fn use_effects(&mut self) {
        let effects = &self.clock.effects;
        self.craft.forget();
        self.plant.set_efficiency(effects.efficiency);
        let depth = self.start.pos_enu.z * PAYLOAD_DEPTH;
        self.plant.set_payload(&self.airframe, effects.payload_kg, depth);
        self.air.change_wind_fault(effects.wind, self.clock.time);
    }
}
