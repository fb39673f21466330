//! Firmware and world in lockstep, and the hands on the sticks.
//!
//! One [`Vehicle::tick`] takes the world from one instant to the next, always in this order:
//!
//! 1. RC frames due now (every 20 ms) go to the receiver;
//! 2. the firmware steps on the sensor frame of this instant and gives motor commands;
//! 3. the world steps with them, which makes the sensor frame of the next instant.
//!
//! A clone is a frozen vehicle: going on from it gives the same trajectory to the last bit.
//!
//! A vehicle that is moved from outside has a firmware and hands, but no world that moves: each [`Vehicle::tick_on`]
//! steps the firmware on what a simulator outside measured, and [`Vehicle::see`] tells where that has put the craft.

mod hands;
mod outside;
mod view;

use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;

pub use hands::{Hands, StickInput};

use crate::firmware::config::Configuration;
use crate::firmware::{Firmware, FirmwareOptions};
use crate::pilot::{Pilot, PilotFacts};
use crate::plan::FlightPlan;
use crate::signals::{RcSource, SensorFrame, SimTime};
use crate::sim::{FaultLink, Stream, World, WorldCommand, WorldConfig, WorldError, WorldEventKind};
use crate::telemetry::{Event, EventKind, FirmwareEvent, Mode, NavEvent, NavState, VehicleNotice};
use outside::Outside;

/// What stands for the airframe when a simulator outside has it.
const EXTERNAL: &str = "external";

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
    /// What a simulator outside tells, when one moves the craft; the world then has only the time and the faults.
    outside: Option<Outside>,
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
        Self::build(config, None)
    }

    /// A vehicle at boot that a simulator outside moves: of the world, only step rate, seed and faults count.
    ///
    /// # Errors
    /// When the step rate is not allowed, or a fault.
    pub fn moved_from_outside(config: VehicleConfig) -> Result<Self, WorldError> {
        Self::build(config, Some(Outside::default()))
    }

    fn build(mut config: VehicleConfig, outside: Option<Outside>) -> Result<Self, WorldError> {
        if outside.is_some() {
            config.world.link = FaultLink::External;
        }
        let airframe = match outside {
            None => config.world.airframe.name.clone(),
            Some(_) => EXTERNAL.to_owned(),
        };
        let boot = EventKind::Boot {
            seed: config.world.seed,
            rate_hz: config.world.rate_hz,
            airframe,
            live: config.live,
        };
        let mut events = Vec::with_capacity(64);
        events.push(Event { time: SimTime::ZERO, kind: boot });
        Ok(Self {
            rx_jitter: Stream::RxJitter.rng(config.world.seed),
            world: World::new(config.world)?,
            outside,
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

    /// The world; nothing in it moves when the craft is moved from outside.
    #[must_use]
    pub fn world(&self) -> &World {
        &self.world
    }

    /// When the autopilot engaged for the first time since boot or reset.
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

    /// Puts the craft back home, undamaged and disarmed; plan, settings, air and faults stay, and what counts from the
    /// engagement waits for the next one. A craft that is moved from outside is disarmed only, and starts where it is
    /// seen next.
    pub fn reset_craft(&mut self) {
        self.engaged_at = None;
        self.hands.pilot = None;
        self.hands.sticks = crate::signals::RcFrame::SAFE;
        self.firmware.restart_in_place();
        if let Some(outside) = &mut self.outside {
            outside.forget();
            self.world.wait_for_next_flight();
            return;
        }
        // Returning home is always allowed.
        let _ = self.world.apply(WorldCommand::ResetToHome);
        self.notice(VehicleNotice::BackHome);
    }

    /// One step of simulated time. When the craft is moved from outside: a step in which nothing is sensed.
    pub fn tick(&mut self) {
        if self.outside.is_some() {
            self.tick_on(&SensorFrame::default());
            return;
        }
        self.send_due_rc();
        self.lose_rc();
        let command = self.firmware.step(self.world.sensors());
        self.world.step(&command);
        self.collect_events();
    }

    /// Moves the events since the last call into `sink`, oldest first.
    pub fn drain_events(&mut self, sink: impl FnMut(Event)) {
        self.events.drain(..).for_each(sink);
    }

    fn notice(&mut self, notice: VehicleNotice) {
        self.events.push(Event { time: self.time(), kind: EventKind::Notice(notice) });
    }

    /// What a pilot sees.
    #[must_use]
    pub fn pilot_facts(&self) -> PilotFacts {
        let fw = &self.firmware;
        PilotFacts {
            time: self.time(),
            fix: fw.gps_fix(),
            arming_blocked: !fw.arming_flags().is_empty(),
            armed: fw.is_armed(),
            engaged: fw.modes().has(Mode::Autopilot),
            alt_m: fw.altitude_m(),
            climb_mps: fw.climb_mps(),
            hover_stick_us: fw.hover_stick_us(),
            raised_stick_us: fw.raised_stick_us(),
        }
    }

    fn send_due_rc(&mut self) {
        if !self.time().0.is_multiple_of(hands::FRAME_US) {
            return;
        }
        let facts = self.pilot_facts();
        let frame = self.hands.frame(&facts, self.engaged_at);
        let fraction = self.world.rx_drop_fraction();
        let dropped = !self.world.rx_lost() && fraction > 0.0 && self.rx_jitter.random::<f64>() < fraction;
        if let Some(frame) = frame
            && !dropped
        {
            self.firmware.receive_rc(&frame, RcSource::Sticks);
        }
    }

    /// With the `rx-loss` fault no frame reaches the receiver, whoever sent it.
    fn lose_rc(&mut self) {
        if self.world.rx_lost() {
            self.firmware.lose_rc();
        }
    }

    fn collect_events(&mut self) {
        let time = self.time();
        while let Some(event) = self.firmware.take_event() {
            if let FirmwareEvent::Nav(nav) = &event {
                self.note_nav_event(nav, time);
            }
            self.events.push(Event { time, kind: EventKind::Firmware(event) });
        }
        let lost = self.firmware.take_events_lost();
        if lost > 0 {
            self.notice(VehicleNotice::EventsLost(lost));
        }
        while let Some(event) = self.world.take_event() {
            let kind = match event.kind {
                WorldEventKind::Contact { impact_mps } => EventKind::Contact { impact_mps },
                WorldEventKind::Touchdown { impact_mps, peak_mps2 } => {
                    EventKind::Touchdown { impact_mps, peak_mps2 }
                }
                WorldEventKind::Crash { cause } => EventKind::Crash { cause },
                WorldEventKind::Fault { fault, on } => {
                    EventKind::Fault { kind: fault.kind(), on, value: fault.value() }
                }
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
    use crate::geo::LatLon;
    use crate::sim::Fault;
    use crate::telemetry::TransitionReason;

    fn config() -> VehicleConfig {
        VehicleConfig {
            world: WorldConfig::default(),
            firmware: FirmwareOptions::default(),
            configuration: Configuration::default(),
            live: false,
        }
    }

    fn vehicle() -> Vehicle {
        Vehicle::new(config()).unwrap()
    }

    fn run(vehicle: &mut Vehicle, until_s: f64) {
        while vehicle.time().as_secs_f64() < until_s {
            vehicle.tick();
        }
    }

    #[test]
    fn lost_events_are_told() {
        let mut vehicle = vehicle();
        for _ in 0..100 {
            // Refused, for the craft is not armed.
            assert!(vehicle.firmware_mut().return_to_home().is_err());
        }
        vehicle.tick();
        let mut notices = Vec::new();
        vehicle.drain_events(|event| {
            if let EventKind::Notice(notice) = event.kind {
                notices.push(notice.to_string());
            }
        });
        assert_eq!(notices, ["Too many events of the firmware came between two steps; lost: the last 36."]);
    }

    #[test]
    fn after_a_reset_faults_and_sticks_count_from_the_next_engagement() {
        counts_from_the_next_engagement(vehicle());
        counts_from_the_next_engagement(Vehicle::moved_from_outside(config()).unwrap());
    }

    fn counts_from_the_next_engagement(mut vehicle: Vehicle) {
        vehicle.hands.inputs.push(StickInput {
            channel: 0,
            value_us: 1900,
            at_s: 0.5,
            for_s: Some(0.2),
            from_boot: false,
        });
        vehicle.change_world(WorldCommand::parse("fault=gps-loss@0.5").unwrap()).unwrap();
        for engaged_s in [1.0, 3.0] {
            run(&mut vehicle, engaged_s);
            assert_eq!(vehicle.engaged_at(), None);
            let engaged = NavEvent::State {
                from: NavState::Idle,
                to: NavState::Approaching,
                wp: 0,
                kind: None,
                reason: TransitionReason::Reset,
                guard: None,
                target: LatLon::default(),
                target_alt_m: 0.0,
            };
            vehicle.note_nav_event(&engaged, vehicle.time());
            run(&mut vehicle, engaged_s + 0.4);
            let stick = |vehicle: &Vehicle| {
                vehicle.hands.clone().frame(&vehicle.pilot_facts(), vehicle.engaged_at()).unwrap().channels[0]
            };
            assert_eq!((stick(&vehicle), vehicle.world().status().faults.len()), (1500, 0));
            run(&mut vehicle, engaged_s + 0.6);
            assert_eq!((stick(&vehicle), vehicle.world().status().faults.len()), (1900, 1));
            vehicle.reset_craft();
        }
    }

    #[test]
    fn a_craft_put_back_home_knows_nothing_of_the_fall() {
        let mut vehicle = vehicle();
        run(&mut vehicle, 4.0);
        vehicle.change_world(WorldCommand::FaultOn(Fault::Teleport([0.0, 0.0, 30.0]), None)).unwrap();
        // A slow tick, so that barometer and GPS have just spoken.
        run(&mut vehicle, 5.0);
        vehicle.reset_craft();
        run(&mut vehicle, 15.0);
        let estimate = vehicle.firmware().altitude_m();
        assert!(estimate.abs() < 1.0, "{estimate}");
        let flags = vehicle.firmware().arming_flags();
        assert!(!flags.has(crate::telemetry::ArmingFlag::Angle), "{flags:?}");
    }
}
