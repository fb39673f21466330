//! The world: one craft, the air, the ground, the sensors and what goes wrong, stepped together.

use arrayvec::ArrayVec;
use nalgebra::Vector3;

use crate::geo::LocalFrame;
use crate::signals::{MotorCommand, SensorFrame, SimTime};

use super::air::{AIR_TICK_US, Air};
use super::airframe::{Airframe, ROTORS};
use super::battery::{Battery, motor_power_w};
use super::body::{AirSample, BodyState, Loads, Plant};
use super::command::{check_wind, in_range};
use super::config::{Wind, WorldConfig, WorldError, step_us};
use super::event::{WorldEvent, WorldEventKind};
use super::fault::{ActiveFault, Effects, FaultBoard, FaultLink, LinkFaults, MAX_FAULTS};
use super::ground::{FREE_FEET, Feet, Touch};
use super::sensors::{Scene, Sensors};
use super::switches::Switches;
use super::touchdown::{GroundWatch, crash_cause};
use super::truth::{BatteryTruth, Truth, level_attitude};
use crate::telemetry::{CrashCause, DivergeCause};

/// Most events that can wait to be taken; when nobody takes them, later ones are lost.
const MAX_EVENTS: usize = 64;
/// Beyond these the integration has failed: distance from home, m, and body rate, rad/s.
const MAX_DISTANCE_M: f64 = 100_000.0;
const MAX_RATE: f64 = 300.0;

mod changes;
mod status;

pub use status::WorldStatus;

/// The plant: truth, sensors and everything that acts on them. A clone is a frozen copy that goes on identically.
#[derive(Debug, Clone)]
pub struct World {
    airframe: Airframe,
    start: BodyState,
    link: FaultLink,
    seed: u64,
    switches: Switches,
    step_us: u64,
    step_s: f64,
    time: SimTime,
    // The craft.
    plant: Plant,
    body: BodyState,
    rotors: [f64; ROTORS],
    feet: Feet,
    battery: Battery,
    command: [f64; ROTORS],
    refused_commands: u64,
    touch: Touch,
    watch: GroundWatch,
    crashed: bool,
    diverged: bool,
    // What acts on it.
    air: Air,
    faults: FaultBoard,
    effects: Effects,
    // What is known of the present instant.
    air_now: AirSample,
    loads: Loads,
    rate_before: Vector3<f64>,
    truth: Truth,
    sensors: Sensors,
    frame: SensorFrame,
    events: ArrayVec<WorldEvent, MAX_EVENTS>,
}

impl World {
    /// A world at boot: the craft stands on its legs at home.
    ///
    /// # Errors
    /// When a value of the configuration is not allowed.
    pub fn new(config: WorldConfig) -> Result<Self, WorldError> {
        let step_us = step_us(config.rate_hz)?;
        check(&config)?;
        let step_s = step_us as f64 * 1e-6;
        let start = standing_at_home(&config);
        let plant = Plant::new(&config.airframe, step_s);
        let air = Air::new(&config, start.pos_enu.z);
        let air_now = air.sample(SimTime::ZERO);
        let mut feet = FREE_FEET;
        plant.ground().latch_feet(&start, &mut feet);
        let rotors = [0.0; ROTORS];
        let mut sensors = Sensors::new(&config, step_s);
        sensors.settle(start.pos_enu, start.vel_enu);
        let loads = plant.loads(&start, &rotors, &air_now, &feet);
        let touch = plant.ground().touch(&start);
        let battery = full_battery(&config.airframe, &config.switches);
        let WorldConfig { airframe, switches, faults, link, seed, .. } = config;
        let mut world = Self {
            airframe,
            start,
            link,
            seed,
            switches,
            step_us,
            step_s,
            time: SimTime::ZERO,
            plant,
            body: start,
            rotors,
            feet,
            battery,
            command: [0.0; ROTORS],
            refused_commands: 0,
            touch,
            watch: GroundWatch::STANDING,
            crashed: false,
            diverged: false,
            air,
            faults: FaultBoard::new(faults),
            effects: Effects::NONE,
            air_now,
            loads,
            rate_before: Vector3::zeros(),
            truth: empty_truth(&start),
            sensors,
            frame: SensorFrame::default(),
            events: ArrayVec::new(),
        };
        world.set_ground_effect();
        world.run_faults();
        world.present();
        Ok(world)
    }

    /// Advances by exactly one step with the given motor commands, 0…1. A command that is not a number is refused: that
    /// motor keeps its previous one.
    pub fn step(&mut self, command: &MotorCommand) {
        self.accept(command);
        let before = self.body;
        if !self.diverged {
            self.move_body();
        }
        self.time.0 += self.step_us;
        if self.faults.is_due(self.time) {
            self.run_faults();
        }
        if self.time.0.is_multiple_of(AIR_TICK_US) {
            self.slow_tick();
        }
        self.rate_before = before.rate_flu;
        self.present();
        self.watch_ground(&before);
    }

    /// Lets one step pass in which nothing moves, for a craft that a simulator outside moves: faults begin and end.
    pub fn pass(&mut self) {
        self.time.0 += self.step_us;
        if self.faults.is_due(self.time) {
            self.run_faults();
        }
    }

    /// The sensor readings of the present instant.
    #[must_use]
    pub fn sensors(&self) -> &SensorFrame {
        &self.frame
    }

    /// The true state at the present instant.
    #[must_use]
    pub fn truth(&self) -> &Truth {
        &self.truth
    }

    /// Simulated time since boot.
    #[must_use]
    pub fn time(&self) -> SimTime {
        self.time
    }

    /// Length of a step, µs.
    #[must_use]
    pub fn step_us(&self) -> u64 {
        self.step_us
    }

    /// What flies.
    #[must_use]
    pub fn airframe(&self) -> &Airframe {
        &self.airframe
    }

    /// The frame that turns truth into latitude and longitude.
    #[must_use]
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
    #[must_use]
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Whether the `gps-loss` fault is on.
    #[must_use]
    pub fn gps_lost(&self) -> bool {
        self.effects.gps.loss
    }

    /// Whether the `rx-loss` fault is on: no RC frame reaches the receiver.
    #[must_use]
    pub fn rx_lost(&self) -> bool {
        self.effects.rx_loss
    }

    /// Fraction of RC frames that the `rx-jitter` fault drops, 0…1; draw from [`Stream::RxJitter`](super::Stream).
    #[must_use]
    pub fn rx_drop_fraction(&self) -> f64 {
        self.effects.rx_jitter
    }

    /// What the active faults do to the packets of an external simulator.
    #[must_use]
    pub fn link_faults(&self) -> LinkFaults {
        self.effects.link
    }

    /// The active faults.
    #[must_use]
    pub fn active_faults(&self) -> &[ActiveFault] {
        self.faults.active()
    }

    /// Takes commands at the border: finite ones, limited to 0…1.
    fn accept(&mut self, command: &MotorCommand) {
        for (kept, given) in self.command.iter_mut().zip(command.0) {
            if given.is_finite() {
                *kept = given.clamp(0.0, 1.0);
            } else {
                self.refused_commands += 1;
            }
        }
    }

    /// Motors, forces, integration and contact over one step.
    fn move_body(&mut self) {
        let scale = if self.switches.battery_sag { self.battery.speed_scale() } else { 1.0 };
        let full_speed = self.airframe.rotor_speed_max * scale;
        let target = std::array::from_fn(|i| {
            if self.crashed { 0.0 } else { full_speed * self.effects.stuck[i].unwrap_or(self.command[i]) }
        });
        let (body, rotors, feet) = (self.body, self.rotors, self.feet);
        self.plant.step(
            &mut self.body,
            &mut self.rotors,
            &mut self.feet,
            &target,
            &self.air_now,
            &self.loads,
        );
        if let Some(cause) = divergence(&self.body) {
            (self.body, self.rotors, self.feet) = (body, rotors, feet);
            self.diverged = true;
            self.tell(WorldEventKind::Diverged { cause });
        }
    }

    /// What happens each 10 ms: air and battery.
    fn slow_tick(&mut self) {
        self.air.tick(self.time, self.body.pos_enu.z, self.body.vel_enu, &self.switches);
        let load = self.plant.efficiency().map(|efficiency| efficiency * self.air_now.density_ratio);
        let power = motor_power_w(&self.airframe, &self.rotors, &load);
        self.battery.draw(power, self.effects.battery, AIR_TICK_US as f64 * 1e-6);
    }

    fn refresh_loads(&mut self) {
        self.loads = self.plant.loads(&self.body, &self.rotors, &self.air_now, &self.feet);
    }

    /// Truth and sensor readings of the present instant.
    fn present(&mut self) {
        let slow_tick = self.time.0.is_multiple_of(AIR_TICK_US).then_some(self.time.0 / AIR_TICK_US);
        self.present_with(slow_tick);
    }

    /// As [`World::present`]; the slower sensors are read when this is the number of a slow tick.
    fn present_with(&mut self, slow_tick: Option<u64>) {
        self.air_now = self.air.sample(self.time);
        self.refresh_loads();
        self.touch = self.plant.ground().touch(&self.body);
        let truth = &mut self.truth;
        truth.time = self.time;
        truth.pos_enu = self.body.pos_enu;
        truth.vel_enu = self.body.vel_enu;
        truth.attitude = self.body.attitude;
        truth.rate_flu = self.body.rate_flu;
        truth.rotor_speeds = self.rotors;
        truth.motor_command = self.command;
        truth.specific_force_flu = self.loads.force_flu / self.plant.mass_kg();
        truth.wind_enu = self.air_now.wind_enu;
        truth.battery = BatteryTruth {
            voltage_v: self.battery.voltage_v,
            current_a: self.battery.current_a,
            drawn_mah: self.battery.drawn_mah,
            drawn_wh: self.battery.drawn_wh,
        };
        truth.on_ground = self.touch.any_leg;
        truth.crashed = self.crashed;
        truth.diverged = self.diverged;
        let scene = Scene {
            truth: &self.truth,
            effects: &self.effects,
            switches: &self.switches,
            slow_tick,
            rate_dot_flu: (self.body.rate_flu - self.rate_before) / self.step_s,
        };
        self.sensors.read(&scene, &mut self.frame);
    }

    /// Contact, touchdown and crash after a step that began in the state `before`.
    fn watch_ground(&mut self, before: &BodyState) {
        let touch = self.touch;
        let force = self.truth.specific_force_flu.norm();
        let event = self.watch.update(self.time, touch, before, &self.body, force);
        // A wreck that bounces and settles has nothing more to tell.
        if let Some(kind) = event
            && !self.crashed
        {
            self.tell(kind);
        }
        if self.crashed || !(touch.any_leg || touch.hull) {
            return;
        }
        let new_contact = matches!(event, Some(WorldEventKind::Contact { .. }));
        if let Some(cause) = crash_cause(touch, new_contact, before) {
            self.crash(cause);
        }
    }

    fn crash(&mut self, cause: CrashCause) {
        self.crashed = true;
        self.truth.crashed = true;
        self.tell(WorldEventKind::Crash { cause });
    }

    fn tell(&mut self, kind: WorldEventKind) {
        // A full queue means that nobody listens.
        let _ = self.events.try_push(WorldEvent { time: self.time, kind });
    }
}

fn check(config: &WorldConfig) -> Result<(), WorldError> {
    if let Some(fault) = config.airframe.fault() {
        return Err(WorldError::Airframe(config.airframe.name.clone(), fault));
    }
    config.home.check()?;
    check_wind(config.wind)?;
    in_range("gust", config.gust_mps, 0.0, Wind::MAX_MPS)?;
    config.switches.check()?;
    if config.faults.len() > MAX_FAULTS {
        return Err(WorldError::TooManyFaults(MAX_FAULTS));
    }
    for scheduled in &config.faults {
        scheduled.check()?;
        config.link.allows(&scheduled.fault)?;
    }
    Ok(())
}

fn standing_at_home(config: &WorldConfig) -> BodyState {
    BodyState {
        pos_enu: Vector3::new(0.0, 0.0, config.airframe.standing_height_m()),
        vel_enu: Vector3::zeros(),
        attitude: level_attitude(config.home.heading_deg),
        rate_flu: Vector3::zeros(),
    }
}

fn full_battery(airframe: &Airframe, switches: &Switches) -> Battery {
    let mut spec = airframe.battery;
    if let Some(capacity_ah) = switches.battery_capacity_ah {
        spec.capacity_ah = capacity_ah;
    }
    Battery::full(spec)
}

fn empty_truth(state: &BodyState) -> Truth {
    Truth {
        time: SimTime::ZERO,
        pos_enu: state.pos_enu,
        vel_enu: state.vel_enu,
        attitude: state.attitude,
        rate_flu: state.rate_flu,
        rotor_speeds: [0.0; ROTORS],
        motor_command: [0.0; ROTORS],
        specific_force_flu: Vector3::zeros(),
        wind_enu: Vector3::zeros(),
        battery: BatteryTruth::default(),
        on_ground: true,
        crashed: false,
        diverged: false,
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
