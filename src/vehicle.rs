//! Flight controller and physics in lockstep, and the RC transmitter.
//!
//! Each [`Vehicle::tick`] takes the physics from one instant to the next, always in this order:
//!
//! 1. RC frames that are due (every 20 ms) go to the receiver;
//! 2. the flight controller steps on the sensor frame of this instant and returns motor commands;
//! 3. the physics steps with them, which gives the sensor frame of the next instant.
//!
//! A clone is a frozen vehicle. If it continues, it gives the same trajectory to the last bit. Everything that
//! reaches the vehicle from other programs or people in the meantime is a [`VehicleCommand`].
//!
//! The flight controller is embedded or remote ([`FlightController`]). The physics is the simulated world or an
//! external simulator. With the latter, each [`Vehicle::tick_on`] steps the flight controller on the measurements of
//! that simulator, and [`Vehicle::see`] reports the place of the craft.
//!
//! ```
//! use betadeck_core::flight::FlightSetup;
//! use betadeck_core::signals::SimTime;
//! use betadeck_core::vehicle::VehicleCommand;
//!
//! let (mut vehicle, _notices) = FlightSetup::default().build().unwrap();
//! vehicle.apply(&VehicleCommand::CutRc(true));
//! while vehicle.time() < SimTime::from_secs_f64(1.0) {
//!     vehicle.tick();
//! }
//! vehicle.drain_events(|event| println!("{event:?}"));
//! assert!(!vehicle.snapshot().craft.is_armed());
//! ```

mod apply;
mod command;
mod controller;
mod host;
mod input_log;
mod physics;
mod view;

use nalgebra::Vector3;
use rand::RngExt as _;

pub use command::{
    CliLine, CliSession, CommandKind, Message, PlanUpload, Reply, VehicleCommand, VehicleRefusal,
};
pub use controller::{
    Answer, EmbeddedController, FlightController, FrameOut, LateAnswer, RemoteController, RemoteRequest,
    RemoteTelemetry, Ticket,
};

use crate::firmware::config::Configuration;
use crate::firmware::{Firmware, FirmwareOptions};
use crate::geo::LocalFrame;
use crate::pilot::{FRAME_US, RcTransmitter};
use crate::plan::FlightPlan;
use crate::signals::{MotorCommand, Pose, RcFrame, RcSource, SensorFrame, SimTime};
use crate::sim::{
    Airframe, Clock, Home, LinkFaults, Stream, StreamRng, Truth, World, WorldConfig, WorldError,
    WorldEventKind, WorldStatus,
};
use crate::telemetry::{Event, EventKind, FirmwareEvent, NavEvent, NavState, VehicleNotice};
use physics::{ExternalPhysics, Physics};

/// A craft slower than this is at rest, m/s.
const AT_REST_MPS: f64 = 0.2;

/// The configuration of a vehicle.
#[derive(Debug, Clone)]
pub struct VehicleConfig {
    /// The craft, the place and the air.
    pub world: WorldConfig,
    /// Options of the firmware.
    pub firmware: FirmwareOptions,
    /// Configuration in the memory of the craft.
    pub configuration: Configuration,
    /// `true` if other programs can influence the flight, so that it is not repeatable.
    pub live: bool,
}

/// A craft with its flight controller, the physics that moves it, and an RC transmitter.
#[derive(Debug, Clone)]
pub struct Vehicle {
    controller: FlightController,
    physics: Physics,
    transmitter: RcTransmitter,
    rx_jitter: StreamRng,
    engaged_at: Option<SimTime>,
    active_plan: Option<Box<FlightPlan>>,
    events: Vec<Event>,
}

impl Vehicle {
    /// Returns a vehicle at boot: the craft is at home, the firmware starts.
    ///
    /// # Errors
    /// Fails if the world cannot be built.
    pub fn new(config: VehicleConfig) -> Result<Self, WorldError> {
        let controller = embedded(config.configuration, config.firmware);
        let physics = Physics::World(Box::new(World::new(config.world)?));
        Ok(Self::build(controller, physics, config.live))
    }

    /// Returns a vehicle at boot that an external simulator moves. Only step rate, seed and faults of the world
    /// configuration are used.
    ///
    /// # Errors
    /// Fails if the step rate or a fault is not allowed.
    pub fn with_external_physics(config: VehicleConfig) -> Result<Self, WorldError> {
        let controller = embedded(config.configuration, config.firmware);
        let WorldConfig { rate_hz, seed, faults, .. } = config.world;
        let clock = Clock::from_external(rate_hz, seed, faults)?;
        let physics = Physics::External(Box::new(ExternalPhysics::new(clock)));
        Ok(Self::build(controller, physics, config.live))
    }

    /// Returns a vehicle at boot in the simulated world with a remote flight controller. Its flight is not
    /// repeatable.
    ///
    /// # Errors
    /// Fails if the world cannot be built.
    pub fn with_remote_controller(world: WorldConfig) -> Result<Self, WorldError> {
        let physics = Physics::World(Box::new(World::new(world)?));
        Ok(Self::build(FlightController::Remote(Box::default()), physics, true))
    }

    /// Returns a vehicle whose flight controller and craft are both remote. Only the flight controller reports their
    /// state. Nothing boots.
    ///
    /// # Errors
    /// Never fails with the default step rate.
    pub fn elsewhere() -> Result<Self, WorldError> {
        let WorldConfig { rate_hz, seed, faults, .. } = WorldConfig::default();
        let clock = Clock::from_external(rate_hz, seed, faults)?;
        let physics = Physics::External(Box::new(ExternalPhysics::new(clock)));
        let mut vehicle = Self::build(FlightController::Remote(Box::default()), physics, true);
        vehicle.events.clear();
        Ok(vehicle)
    }

    fn build(controller: FlightController, physics: Physics, live: bool) -> Self {
        let boot = EventKind::Boot {
            seed: physics.clock().seed(),
            rate_hz: (1_000_000 / physics.clock().step_us()) as u32,
            airframe: physics.airframe_name().to_owned(),
            live,
        };
        let mut events = Vec::with_capacity(64);
        events.push(Event { time: SimTime::ZERO, kind: boot });
        Self {
            rx_jitter: Stream::RxJitter.rng(physics.clock().seed()),
            controller,
            physics,
            transmitter: RcTransmitter::default(),
            engaged_at: None,
            active_plan: None,
            events,
        }
    }

    /// Returns the simulated time since boot.
    pub fn time(&self) -> SimTime {
        self.physics.clock().time()
    }

    /// Returns the length of a tick, µs.
    pub fn step_us(&self) -> u64 {
        self.physics.clock().step_us()
    }

    /// Returns the flight controller, to read it.
    pub fn controller(&self) -> &FlightController {
        &self.controller
    }

    /// Returns the embedded firmware, if it flies the craft.
    pub fn embedded(&self) -> Option<&Firmware> {
        self.controller.embedded()
    }

    /// Returns the RC transmitter, to read it.
    pub fn transmitter(&self) -> &RcTransmitter {
        &self.transmitter
    }

    /// Returns the true state of the craft. `None` if an external simulator moves it.
    pub fn truth(&self) -> Option<&Truth> {
        self.physics.truth()
    }

    /// Returns the airframe. `None` if an external simulator moves it.
    pub fn airframe(&self) -> Option<&Airframe> {
        self.physics.airframe()
    }

    /// Returns the settings of air and noise. `None` if an external simulator has them.
    pub fn world_status(&self) -> Option<WorldStatus> {
        self.physics.status()
    }

    /// Returns the maximum thrust over weight in the air at the craft, with its payload. `None` if an external
    /// simulator moves it.
    pub fn thrust_to_weight(&self) -> Option<f64> {
        self.physics.thrust_to_weight()
    }

    /// Returns the sensor frame of the present instant; of an external simulator, the last one received.
    pub fn sensors(&self) -> &SensorFrame {
        self.physics.sensors()
    }

    /// Returns time, seed and faults of the physics.
    pub fn clock(&self) -> &Clock {
        self.physics.clock()
    }

    /// Returns the frame with its origin at the boot place. `None` before an external simulator has reported that
    /// place, or before [`Self::set_origin`].
    pub fn local_frame(&self) -> Option<&LocalFrame> {
        self.physics.local_frame()
    }

    /// Returns the effects of active faults on the packets of an external simulator.
    pub fn link_faults(&self) -> LinkFaults {
        self.physics.clock().link_faults()
    }

    /// Returns `true` if the craft is known to have crashed.
    pub fn crashed(&self) -> bool {
        self.truth().is_some_and(|truth| truth.crashed)
    }

    /// Returns `true` if the simulation has left the range in which its numbers are meaningful.
    pub fn diverged(&self) -> bool {
        self.truth().is_some_and(|truth| truth.diverged)
    }

    /// Returns `true` if the craft is disarmed and at rest, and no scripted pilot is about to fly it.
    pub fn is_idle(&self) -> bool {
        let is_at_rest = self.truth().is_none_or(|truth| truth.vel_enu.norm() < AT_REST_MPS);
        !self.controller.is_armed() && self.transmitter.pilot().is_none() && is_at_rest
    }

    /// Returns the time at which the autopilot first engaged since boot or reset.
    pub fn engaged_at(&self) -> Option<SimTime> {
        self.engaged_at
    }

    /// Adds a wind of the program's own to the air at the craft, ENU, m/s, in place of the one that was added before: see
    /// [`World::set_added_wind`]. A program that calls this before each tick blows as it likes, by time and place. A clone
    /// keeps the wind. It is not among the inputs of the vehicle, so a program that flies again adds it again.
    ///
    /// # Errors
    /// Fails if it is stronger than 60 m/s or not a number, or if an external simulator moves the craft. Nothing has changed
    /// then.
    pub fn set_added_wind(&mut self, vel_enu: Vector3<f64>) -> Result<(), WorldError> {
        self.physics.set_added_wind(vel_enu)
    }

    /// Returns the same craft with its present settings at boot, in the present air and without faults; `None` if the flight
    /// controller or the physics is another program. `change` may change the seed and the air before.
    ///
    /// # Errors
    /// Fails if a changed value is not allowed.
    pub fn again(&self, change: impl FnOnce(&mut WorldConfig)) -> Result<Option<Self>, WorldError> {
        let Some(firmware) = self.embedded() else { return Ok(None) };
        let Some(physics) = self.physics.again(change)? else { return Ok(None) };
        let controller = embedded(firmware.configuration().clone(), firmware.options());
        Ok(Some(Self::build(controller, physics, false)))
    }

    /// Returns a vehicle at boot whose embedded firmware has the settings that the remote one has reported, in the present
    /// craft and air. For a real craft these are the usual ones, at the place of the craft, and the mounting of its compass
    /// does not count. `None` if the settings or the place are unknown, or if the firmware is embedded.
    ///
    /// # Errors
    /// Fails if the world cannot be built.
    pub fn twin(&self) -> Result<Option<Self>, WorldError> {
        let reported = self.controller.reported_configuration().cloned();
        let (Some(mut configuration), Some(&frame)) = (reported, self.local_frame()) else {
            return Ok(None);
        };
        let physics = match self.physics.again(|_| ())? {
            Some(physics) => physics,
            None => {
                configuration.settings.set_number("align_mag", 0).ok();
                let home = Home {
                    lat_deg: frame.lat_deg,
                    lon_deg: frame.lon_deg,
                    alt_amsl_m: frame.alt_amsl_m,
                    ..Home::default()
                };
                Physics::World(Box::new(World::new(WorldConfig { home, ..WorldConfig::default() })?))
            }
        };
        configuration.starter_modes();
        let rate_hz = (1_000_000 / physics.clock().step_us()) as u32;
        let options = FirmwareOptions { rate_hz, site_alt_m: frame.alt_amsl_m, ..FirmwareOptions::default() };
        Ok(Some(Self::build(embedded(configuration, options), physics, false)))
    }

    /// Handles the restart of a remote flight controller by itself: the craft of the simulated world is at home
    /// again, disarmed.
    pub fn remote_restarted(&mut self) {
        let Some(remote) = self.controller.remote_mut() else { return };
        remote.restarted();
        self.engaged_at = None;
        self.active_plan = None;
        *self.transmitter.sticks_mut() = RcFrame::SAFE;
        // An external simulator is not reset from here.
        if self.truth().is_some() {
            self.physics.reset();
        }
    }

    /// Makes one step of simulated time. With an external simulator, the step has no measurements.
    pub fn tick(&mut self) {
        self.step(None);
    }

    /// Makes one step on the measurements of an external simulator. The simulator carries out the returned motor
    /// command.
    ///
    /// Only for a vehicle from [`Vehicle::with_external_physics`]. The simulated world of any other vehicle would not
    /// follow.
    pub fn tick_on(&mut self, sensors: &SensorFrame) -> MotorCommand {
        match self.physics {
            Physics::World(_) => MotorCommand::default(),
            Physics::External(_) => self.step(Some(sensors)),
        }
    }

    fn step(&mut self, measured: Option<&SensorFrame>) -> MotorCommand {
        self.send_due_rc();
        // With the `rx-loss` fault no frame from any source reaches the receiver.
        if self.physics.clock().rx_lost() {
            self.controller.lose_rc();
        }
        if let Some(external) = self.physics.external_mut() {
            external.measure(measured.unwrap_or(&SensorFrame::default()));
        }
        let motors = self.controller.step(self.physics.sensors());
        self.physics.step(&motors);
        self.collect_events();
        motors
    }

    /// Ends faults of the link whose time is over after a silence of this length, µs. The time of the vehicle stops
    /// during the silence. Returns `true` if there were any.
    pub fn end_link_faults(&mut self, silence_us: u64) -> bool {
        let before = self.events.len();
        if let Some(external) = self.physics.external_mut() {
            external.clock_mut().end_link_faults(silence_us);
        }
        self.collect_events();
        self.events.len() != before
    }

    /// Takes the place of the craft as reported by an external simulator.
    pub fn see(&mut self, pose: Pose) {
        if let Some(external) = self.physics.external_mut() {
            external.see(pose);
        }
    }

    /// Sets the origin of the positions of a vehicle from [`Vehicle::elsewhere`]. Any other vehicle keeps its boot
    /// place.
    pub fn set_origin(&mut self, origin: LocalFrame) {
        if let Some(external) = self.physics.external_mut() {
            external.set_frame(origin);
        }
    }

    /// Moves the events since the last call into `sink`, oldest first.
    pub fn drain_events(&mut self, sink: impl FnMut(Event)) {
        self.events.drain(..).for_each(sink);
    }

    fn notice(&mut self, notice: VehicleNotice) {
        self.events.push(Event { time: self.time(), kind: EventKind::Notice(notice) });
    }

    fn send_due_rc(&mut self) {
        if !self.time().0.is_multiple_of(FRAME_US) {
            return;
        }
        let facts = self.controller.pilot_facts(self.time());
        let frame = self.transmitter.frame(&facts, self.engaged_at);
        let fraction = self.physics.clock().rx_drop_fraction();
        let dropped =
            !self.physics.clock().rx_lost() && fraction > 0.0 && self.rx_jitter.random::<f64>() < fraction;
        if let Some(frame) = frame
            && !dropped
        {
            self.controller.receive_rc(&frame, RcSource::Sticks);
        }
    }

    fn collect_events(&mut self) {
        let time = self.time();
        while let Some(event) = self.controller.take_event() {
            if let FirmwareEvent::Nav(nav) = &event {
                self.note_nav_event(nav, time);
            }
            self.events.push(Event { time, kind: EventKind::Firmware(event) });
        }
        let lost = self.controller.take_events_lost();
        if lost > 0 {
            self.notice(VehicleNotice::EventsLost(lost));
        }
        while let Some(event) = self.physics.clock_mut().take_event() {
            let kind = match event.kind {
                WorldEventKind::Contact { impact_mps } => EventKind::Contact { impact_mps },
                WorldEventKind::Touchdown { impact_mps, peak_mps2 } => {
                    EventKind::Touchdown { impact_mps, peak_mps2 }
                }
                WorldEventKind::Crash { cause } => EventKind::Crash { cause },
                WorldEventKind::Fault { fault, on } => {
                    EventKind::Fault { kind: fault.kind(), on, value: fault.value() }
                }
                WorldEventKind::BatteryEmpty { cell_v } => EventKind::BatteryEmpty { cell_v },
                WorldEventKind::Diverged { cause } => EventKind::Notice(VehicleNotice::Diverged(cause)),
            };
            self.events.push(Event { time: event.time, kind });
        }
    }

    fn note_nav_event(&mut self, event: &NavEvent, time: SimTime) {
        match event {
            NavEvent::Plan { plan, .. } => self.active_plan = Some(plan.clone()),
            NavEvent::State { to, .. } if *to != NavState::Idle && self.engaged_at.is_none() => {
                self.engaged_at = Some(time);
                self.physics.clock_mut().set_engaged(time);
            }
            NavEvent::State { .. }
            | NavEvent::Climbing(_)
            | NavEvent::Limited { .. }
            | NavEvent::Geofence { .. }
            | NavEvent::CannotHold { .. }
            | NavEvent::Refused(_)
            | NavEvent::Disarm => {}
        }
    }
}

fn embedded(configuration: Configuration, options: FirmwareOptions) -> FlightController {
    Firmware::new(configuration, options).into()
}

#[cfg(test)]
mod tests;
