//! The world: one craft, the air, the ground, the sensors and their faults, stepped together.

use nalgebra::Vector3;

use crate::signals::{MotorCommand, SensorFrame};

use super::air::{AIR_TICK_US, Air};
use super::airframe::{Airframe, ROTORS};
use super::battery::{Battery, motor_power_w};
use super::body::{AirSample, BodyState};
use super::clock::{Clock, FaultHost};
use super::event::WorldEventKind;
use super::ground::GroundContact;
use super::landform::LocalRelief;
use super::plant::{Craft, Plant, Present};
use super::sensors::{SensorInputs, Sensors};
use super::switches::Switches;
use super::touchdown::{TouchdownDetector, crash_cause};
use super::truth::{BatteryTruth, Truth};
use crate::telemetry::{CrashCause, DivergeCause};

/// The limits beyond which the integration has failed: distance from home, m, and body rate, rad/s.
const MAX_DISTANCE_M: f64 = 100_000.0;
const MAX_RATE: f64 = 300.0;

mod boot;
mod changes;
mod readout;

use boot::full_battery;
pub use readout::WorldStatus;

/// The plant: truth, sensors and everything that acts on them. A clone is a frozen copy that continues identically.
#[derive(Debug, Clone)]
pub struct World {
    airframe: Airframe,
    start: BodyState,
    heading_deg: f64,
    switches: Switches,
    relief: Option<LocalRelief>,
    clock: Clock,
    // The craft.
    plant: Plant,
    craft: Craft,
    battery: Battery,
    command: [f64; ROTORS],
    refused_commands: u64,
    contact: GroundContact,
    touchdown: TouchdownDetector,
    crashed: bool,
    diverged: bool,
    air: Air,
    // The present instant.
    air_now: AirSample,
    present: Present,
    rate_before: Vector3<f64>,
    truth: Truth,
    sensors: Sensors,
    frame: SensorFrame,
}

impl World {
    /// Advances by exactly one step with the given motor commands, 0…1. A command that is not a number is refused,
    /// and that motor keeps its previous one.
    pub fn step(&mut self, command: &MotorCommand) {
        self.accept(command);
        let before = *self.craft.body();
        if !self.diverged {
            self.move_craft(&before);
        }
        self.clock.advance();
        self.run_faults();
        if self.clock.time.0.is_multiple_of(AIR_TICK_US) {
            self.slow_tick();
        }
        self.rate_before = before.rate_flu;
        self.update_outputs();
        self.detect_touchdown(&before);
    }

    /// Takes finite commands, limited to 0…1.
    fn accept(&mut self, command: &MotorCommand) {
        for (kept, given) in self.command.iter_mut().zip(command.0) {
            if given.is_finite() {
                *kept = given.clamp(0.0, 1.0);
            } else {
                self.refused_commands += 1;
            }
        }
    }

    /// Computes motors, forces, integration and contact over one step that begins in the state `before`.
    fn move_craft(&mut self, before: &BodyState) {
        let scale = if self.switches.battery_sag { self.battery.speed_scale() } else { 1.0 };
        let full_speed = self.airframe.rotor_speed_max * scale;
        let target: [f64; ROTORS] = std::array::from_fn(|i| {
            if self.crashed {
                0.0
            } else {
                full_speed * self.clock.effects.stuck[i].unwrap_or(self.command[i])
            }
        });
        // In the air a step does not change them.
        let anchors = if self.present.is_free() { None } else { Some(self.craft.anchors) };
        self.plant.step(&mut self.craft, &target, &self.air_now, &self.present);
        if let Some(cause) = divergence(self.craft.body()) {
            // The last sane state is also that of the truth.
            self.craft.set_body(*before);
            self.craft.set_rotors(self.truth.rotor_speeds);
            self.craft.anchors = anchors.unwrap_or(self.craft.anchors);
            self.diverged = true;
            self.clock.emit(WorldEventKind::Diverged { cause });
        }
    }

    /// Advances air and battery, every 10 ms.
    fn slow_tick(&mut self) {
        let BodyState { pos_enu, vel_enu, .. } = *self.craft.body();
        let ground_m = self.plant.ground().landform().elevation_m(&pos_enu.xy());
        self.air.tick(self.clock.time, pos_enu.z, ground_m, vel_enu, &self.switches);
        let load = self.plant.efficiency().map(|efficiency| efficiency * self.air_now.density_ratio);
        let power = motor_power_w(&self.airframe, self.craft.rotors(), &load);
        let was_charged = self.battery.charge_left() > 0.0;
        let runs_out = self.switches.battery_sag;
        self.battery.draw(power, self.clock.effects.battery, runs_out, AIR_TICK_US as f64 * 1e-6);
        self.update_battery_truth();
        if was_charged && self.battery.charge_left() <= 0.0 {
            self.clock.emit(WorldEventKind::BatteryEmpty { cell_v: self.battery.cell_v() });
        }
    }

    fn refresh_loads(&mut self) {
        self.present = self.plant.present(&self.craft, &self.air_now);
    }

    fn update_battery_truth(&mut self) {
        self.truth.battery = BatteryTruth {
            voltage_v: self.battery.voltage_v,
            current_a: self.battery.current_a,
            drawn_mah: self.battery.drawn_mah,
            drawn_wh: self.battery.drawn_wh,
            capacity_mah: self.battery.capacity_mah(),
        };
    }

    /// Updates truth and sensor readings of the present instant.
    fn update_outputs(&mut self) {
        let slow_tick =
            self.clock.time.0.is_multiple_of(AIR_TICK_US).then_some(self.clock.time.0 / AIR_TICK_US);
        self.update_outputs_on(slow_tick);
    }

    /// Does the same as [`World::update_outputs`]. The slower sensors are read if `slow_tick` is the number of a slow
    /// tick.
    fn update_outputs_on(&mut self, slow_tick: Option<u64>) {
        self.air_now = self.air.sample(self.clock.time);
        self.present = self.plant.present(&self.craft, &self.air_now);
        let body = self.craft.body();
        self.contact = self.plant.ground().contact(body);
        let truth = &mut self.truth;
        truth.time = self.clock.time;
        truth.pos_enu = body.pos_enu;
        truth.vel_enu = body.vel_enu;
        truth.attitude = body.attitude;
        truth.rate_flu = body.rate_flu;
        truth.rotor_speeds = *self.craft.rotors();
        truth.motor_command = self.command;
        truth.specific_force_flu = self.present.loads.force_flu / self.plant.mass_kg();
        truth.wind_enu = self.air_now.wind_enu;
        truth.ground_m = self.plant.ground().landform().elevation_m(&body.pos_enu.xy());
        truth.on_ground = self.contact.any_leg;
        truth.crashed = self.crashed;
        truth.diverged = self.diverged;
        let inputs = SensorInputs {
            truth: &self.truth,
            effects: &self.clock.effects,
            switches: &self.switches,
            slow_tick,
            rate_before_flu: self.rate_before,
        };
        self.sensors.read(&inputs, &mut self.frame);
    }

    /// Detects contact, touchdown and crash after a step that began in the state `before`.
    fn detect_touchdown(&mut self, before: &BodyState) {
        let contact = self.contact;
        let force = self.truth.specific_force_flu;
        let event = self.touchdown.update(self.clock.time, contact, before, self.craft.body(), &force);
        // A wreck that bounces and settles has nothing more to report.
        if let Some(kind) = event
            && !self.crashed
        {
            self.clock.emit(kind);
        }
        if self.crashed || !(contact.any_leg || contact.hull) {
            return;
        }
        let new_contact = matches!(event, Some(WorldEventKind::Contact { .. }));
        if let Some(cause) = crash_cause(contact, new_contact, before) {
            self.crash(cause);
        }
    }

    fn crash(&mut self, cause: CrashCause) {
        self.crashed = true;
        self.truth.crashed = true;
        self.clock.emit(WorldEventKind::Crash { cause });
    }
}

fn divergence(state: &BodyState) -> Option<DivergeCause> {
    if !state.is_finite() {
        Some(DivergeCause::NotFinite)
    } else if state.pos_enu.norm_squared() > MAX_DISTANCE_M * MAX_DISTANCE_M {
        Some(DivergeCause::Position)
    } else if state.rate_flu.norm_squared() > MAX_RATE * MAX_RATE {
        Some(DivergeCause::Rate)
    } else {
        None
    }
}

#[cfg(test)]
mod tests;
