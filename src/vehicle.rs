//! Firmware and world in lockstep, and the hands on the sticks.
//!
//! One [`Vehicle::tick`] takes the world from one instant to the next, always in this order:
//!
//! 1. RC frames due now (every 20 ms) go to the receiver;
//! 2. the firmware steps on the sensor frame of this instant and gives motor commands;
//! 3. the world steps with them, which makes the sensor frame of the next instant.
//!
//! A clone is a frozen vehicle: going on from it gives the same trajectory to the last bit.

pub mod event;
mod hands;
pub mod snapshot;
mod view;

use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;

pub use event::{Event, EventKind};
pub use hands::{Hands, StickInput};
pub use snapshot::Snapshot;

use crate::autopilot::io::{NavEvent, NavState};
use crate::firmware::config::Configuration;
use crate::firmware::mode::Mode;
use crate::firmware::{Firmware, FirmwareEvent, FirmwareOptions};
use crate::pilot::{Pilot, PilotFacts};
use crate::plan::FlightPlan;
use crate::signals::{RcSource, SimTime};
use crate::sim::{Stream, World, WorldCommand, WorldConfig, WorldError, WorldEventKind};

/// What a vehicle is made of.
#[derive(Debug, Clone)]
pub struct VehicleConfig {
    /// The craft, the place and the air.
    pub world: WorldConfig,
    /// How the firmware is built.
    pub firmware: FirmwareOptions,
    /// What the craft remembers.
    pub configuration: Configuration,
    /// Outside doors can influence the flight, so that it is not repeatable.
    pub live: bool,
}

/// A craft with its firmware, in its world.
#[derive(Debug, Clone)]
pub struct Vehicle {
    firmware: Firmware,
    world: World,
    /// Who moves the sticks.
    pub hands: Hands,
    rx_jitter: ChaCha8Rng,
    engaged_at: Option<SimTime>,
    active_plan: Option<Box<FlightPlan>>,
    events: Vec<Event>,
}

impl Vehicle {
    /// A vehicle at boot: the craft stands at home, the firmware starts.
    ///
    /// # Errors
    /// When the world cannot be built.
    pub fn new(config: VehicleConfig) -> Result<Self, WorldError> {
        let boot = EventKind::Boot {
            seed: config.world.seed,
            rate_hz: config.world.rate_hz,
            airframe: config.world.airframe.name.clone(),
            live: config.live,
        };
        let mut events = Vec::with_capacity(64);
        events.push(Event { time: SimTime::ZERO, kind: boot });
        Ok(Self {
            rx_jitter: Stream::RxJitter.rng(config.world.seed),
            world: World::new(config.world)?,
            firmware: Firmware::new(config.configuration, config.firmware),
            hands: Hands::default(),
            engaged_at: None,
            active_plan: None,
            events,
        })
    }

    /// Simulated time since boot.
    #[must_use]
    pub fn time(&self) -> SimTime {
        self.world.time()
    }

    /// Length of a tick, µs.
    #[must_use]
    pub fn step_us(&self) -> u64 {
        self.world.step_us()
    }

    /// The flight controller.
    #[must_use]
    pub fn firmware(&self) -> &Firmware {
        &self.firmware
    }

    /// The flight controller, to talk to it.
    pub fn firmware_mut(&mut self) -> &mut Firmware {
        &mut self.firmware
    }

    /// The world.
    #[must_use]
    pub fn world(&self) -> &World {
        &self.world
    }

    /// When the autopilot engaged for the first time.
    #[must_use]
    pub fn engaged_at(&self) -> Option<SimTime> {
        self.engaged_at
    }

    /// Changes air, noise or faults.
    ///
    /// # Errors
    /// When a value is not allowed; then nothing has changed.
    pub fn change_world(&mut self, command: WorldCommand) -> Result<(), WorldError> {
        self.world.apply(command)
    }

    /// Lets the scripted pilot fly the mission from here: climb to `takeoff_m`, engage.
    ///
    /// # Errors
    /// The mode that no channel switches.
    pub fn start_pilot(&mut self, takeoff_m: f64) -> Result<(), Mode> {
        self.hands.pilot = Some(Pilot::new(takeoff_m, &self.firmware.mode_ranges())?);
        Ok(())
    }

    /// Puts the craft back home, undamaged and disarmed; plan, settings, air and faults stay.
    pub fn reset_craft(&mut self) {
        self.hands.pilot = None;
        self.hands.sticks = crate::signals::RcFrame::SAFE;
        self.firmware.restart_in_place();
        // Returning home is always allowed.
        let _ = self.world.apply(WorldCommand::ResetToHome);
        self.notice("The craft is back home, undamaged and disarmed.");
    }

    /// One step of simulated time.
    pub fn tick(&mut self) {
        let now = self.world.time();
        if now.0.is_multiple_of(hands::FRAME_US) {
            self.send_rc();
        }
        let command = self.firmware.step(self.world.sensors());
        self.world.step(&command);
        self.collect_events();
    }

    /// Moves the events since the last call into `sink`, oldest first.
    pub fn drain_events(&mut self, sink: impl FnMut(Event)) {
        self.events.drain(..).for_each(sink);
    }

    /// Says something to the user.
    pub fn notice(&mut self, text: impl Into<String>) {
        self.events.push(Event { time: self.time(), kind: EventKind::Notice(text.into()) });
    }

    /// What a pilot sees.
    #[must_use]
    pub fn pilot_facts(&self) -> PilotFacts {
        let fw = &self.firmware;
        PilotFacts {
            time: self.world.time(),
            fix: fw.gps_fix(),
            arming_blocked: !fw.arming_flags().is_empty(),
            armed: fw.is_armed(),
            engaged: fw.modes().has(Mode::Autopilot),
            alt_m: fw.altitude_m(),
            climb_mps: fw.climb_mps(),
            hover_stick_us: fw.hover_stick_us(),
        }
    }

    fn send_rc(&mut self) {
        let facts = self.pilot_facts();
        let frame = self.hands.frame(&facts, self.engaged_at);
        let dropped = self.world.rx_lost() || {
            let fraction = self.world.rx_drop_fraction();
            fraction > 0.0 && self.rx_jitter.random::<f64>() < fraction
        };
        if let Some(frame) = frame
            && !dropped
        {
            self.firmware.receive_rc(&frame, RcSource::Sticks);
        }
    }

    fn collect_events(&mut self) {
        let time = self.world.time();
        while let Some(event) = self.firmware.take_event() {
            if let FirmwareEvent::Nav(nav) = &event {
                self.note_nav_event(nav, time);
            }
            self.events.push(Event { time, kind: EventKind::Firmware(event) });
        }
        while let Some(event) = self.world.take_event() {
            let kind = match event.kind {
                WorldEventKind::Contact { impact_mps } => EventKind::Contact { impact_mps },
                WorldEventKind::Touchdown { impact_mps, peak_mps2 } => {
                    EventKind::Touchdown { impact_mps, peak_mps2 }
                }
                WorldEventKind::Crash { cause } => EventKind::Crash { cause: cause.to_string() },
                WorldEventKind::Fault { fault, on } => {
                    EventKind::Fault { name: fault.name(), on, value: fault.to_string() }
                }
                WorldEventKind::Diverged { cause } => {
                    EventKind::Notice(format!("The simulation diverged: {cause}."))
                }
            };
            self.events.push(Event { time: event.time, kind });
        }
    }

    fn note_nav_event(&mut self, event: &NavEvent, time: SimTime) {
        match event {
            NavEvent::Plan { plan, .. } => self.active_plan = Some(plan.clone()),
            NavEvent::State { to, .. } if *to != NavState::Idle && self.engaged_at.is_none() => {
                self.engaged_at = Some(time);
                self.world.set_engaged(time);
            }
            NavEvent::State { .. }
            | NavEvent::Climbing(_)
            | NavEvent::Geofence { .. }
            | NavEvent::Refused(_)
            | NavEvent::Disarm => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::Fault;

    #[test]
    fn a_craft_put_back_home_knows_nothing_of_the_fall() {
        let mut vehicle = Vehicle::new(VehicleConfig {
            world: WorldConfig::default(),
            firmware: FirmwareOptions::default(),
            configuration: Configuration::default(),
            live: false,
        })
        .unwrap();
        let run = |vehicle: &mut Vehicle, until_s: f64| {
            while vehicle.time().as_secs_f64() < until_s {
                vehicle.tick();
            }
        };
        run(&mut vehicle, 4.0);
        vehicle.change_world(WorldCommand::FaultOn(Fault::Teleport([0.0, 0.0, 30.0]), None)).unwrap();
        // A slow tick, so that barometer and GPS have just spoken.
        run(&mut vehicle, 5.0);
        vehicle.reset_craft();
        run(&mut vehicle, 15.0);
        let estimate = vehicle.firmware().altitude_m();
        assert!(estimate.abs() < 1.0, "{estimate}");
        let flags = vehicle.firmware().arming_flags();
        assert!(!flags.has(crate::firmware::arming::ArmingFlag::Angle), "{flags:?}");
    }
}
