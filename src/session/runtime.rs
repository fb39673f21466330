//! The thread that owns the vehicle: carries out commands, runs the due ticks, publishes pictures and events.
#![allow(clippy::disallowed_methods, reason = "this is where wall time meets simulated time")]

use std::sync::Arc;
use std::time::{Duration, Instant};

use tokio::sync::{mpsc, watch};

use super::command::{CliOutput, Command, DoorView, SessionView};
use super::pacer::Pacer;
use crate::firmware::cli::{CliAction, CliReply, Interpreter, advice};
use crate::link::{Desk, Request};
use crate::plan::FlightPlan;
use crate::signals::RcSource;
use crate::sim::WorldCommand;
use crate::storage::Store;
use crate::vehicle::{Event, Vehicle};

/// Interval of published pictures.
const PICTURE: Duration = Duration::from_millis(16);
/// Rhythm of the loop while time is paced.
const BEAT: Duration = Duration::from_millis(2);
/// Rhythm of the loop while nothing moves.
const PAUSED_BEAT: Duration = Duration::from_millis(8);
/// How often frames from sockets are repeated while time runs fast, µs of simulated time.
const RC_REPEAT_US: u64 = 20_000;
/// Ticks between two looks at the clock and the commands.
const SLICE: u64 = 500;

/// The doors, seen from the session.
#[derive(Debug)]
pub struct Doorway {
    /// What clients, scripts and simulators ask.
    pub requests: mpsc::Receiver<Request>,
    /// Answers them.
    pub desk: Desk,
    /// The state of the doors.
    pub views: watch::Receiver<Vec<DoorView>>,
}

/// What a session starts with.
#[derive(Debug)]
pub struct SessionConfig {
    /// The vehicle at boot.
    pub vehicle: Vehicle,
    /// Where `save` goes.
    pub store: Store,
    /// Times real time at the start; infinite = as fast as possible.
    pub speed: f64,
    /// Altitude to which the scripted pilot climbs, m.
    pub takeoff_m: f64,
    /// The doors, when any are open; they make the flight live.
    pub doorway: Option<Doorway>,
}

/// The ends of a running session that the outside holds.
#[derive(Debug)]
pub struct Handle {
    /// Requests.
    pub commands: mpsc::Sender<Command>,
    /// The newest picture.
    pub view: watch::Receiver<SessionView>,
    /// Every event, in order.
    pub events: mpsc::UnboundedReceiver<Event>,
    /// The thread; it ends on [`Command::Quit`] or when all senders are gone.
    pub thread: std::thread::JoinHandle<()>,
}

/// Starts the session's thread.
///
/// # Errors
/// When the system gives no thread.
pub fn start(config: SessionConfig) -> std::io::Result<Handle> {
    let (command_tx, command_rx) = mpsc::channel(256);
    let (event_tx, event_rx) = mpsc::unbounded_channel();
    let mut session = Session {
        pacer: Pacer::new(config.vehicle.step_us(), config.speed),
        console: Interpreter::default(),
        vehicle: config.vehicle,
        store: config.store,
        takeoff_m: config.takeoff_m,
        doorway: config.doorway,
        commands: command_rx,
        events: event_tx,
        changed: true,
        quit: false,
    };
    let (view_tx, view_rx) = watch::channel(session.view());
    let thread =
        std::thread::Builder::new().name("vehicle".to_owned()).spawn(move || session.run(&view_tx))?;
    Ok(Handle { commands: command_tx, view: view_rx, events: event_rx, thread })
}

struct Session {
    vehicle: Vehicle,
    store: Store,
    pacer: Pacer,
    console: Interpreter,
    takeoff_m: f64,
    doorway: Option<Doorway>,
    commands: mpsc::Receiver<Command>,
    events: mpsc::UnboundedSender<Event>,
    /// Something other than time changed what the picture shows.
    changed: bool,
    quit: bool,
}

impl Session {
    fn run(&mut self, view: &watch::Sender<SessionView>) {
        let start = Instant::now();
        let mut pictured = Duration::ZERO;
        self.flush_events();
        while !self.quit {
            self.take_commands(start.elapsed());
            self.attend_doors();
            let now = start.elapsed();
            let due = self.pacer.due(now, SLICE);
            for _ in 0..due {
                self.keep_rc_fresh();
                self.vehicle.tick();
            }
            let after = start.elapsed();
            self.pacer.ran(due, after);
            if due > 0 || self.changed {
                self.flush_events();
            }
            if self.changed || due > 0 && after - pictured >= PICTURE {
                pictured = after;
                self.changed = false;
                view.send_replace(self.view());
            }
            if due < SLICE {
                let beat = if self.pacer.is_paused() { PAUSED_BEAT } else { BEAT };
                std::thread::sleep(beat.saturating_sub(start.elapsed().saturating_sub(now)));
            }
        }
    }

    fn view(&self) -> SessionView {
        SessionView {
            vehicle: Arc::new(self.vehicle.snapshot()),
            paused: self.pacer.is_paused(),
            speed_wanted: self.pacer.speed(),
            speed_achieved: self.pacer.achieved(),
            sticks: self.vehicle.hands.sticks,
            rc_cut: self.vehicle.hands.cut,
            pilot: self.vehicle.hands.pilot.as_ref().map(crate::pilot::Pilot::doing),
            doors: self.doorway.as_ref().map_or_else(Vec::new, |way| way.views.borrow().clone()),
            live: self.doorway.is_some(),
        }
    }

    fn flush_events(&mut self) {
        let events = &self.events;
        // The receiver is gone only while the program ends.
        self.vehicle.drain_events(|event| drop(events.send(event)));
    }

    fn take_commands(&mut self, now: Duration) {
        loop {
            match self.commands.try_recv() {
                Ok(command) => {
                    self.changed = true;
                    self.carry_out(command, now);
                }
                Err(mpsc::error::TryRecvError::Empty) => return,
                Err(mpsc::error::TryRecvError::Disconnected) => {
                    self.quit = true;
                    return;
                }
            }
        }
    }

    fn attend_doors(&mut self) {
        let Some(doorway) = &mut self.doorway else { return };
        while let Ok(request) = doorway.requests.try_recv() {
            self.changed = true;
            let firmware = self.vehicle.firmware_mut();
            let attended = doorway.desk.attend(request, firmware, &mut self.store, Instant::now());
            for notice in attended.notices {
                self.vehicle.notice(notice);
            }
            if attended.restarted {
                self.console = Interpreter::default();
            }
        }
        let sources = self.vehicle.firmware().receiver().sources();
        let from_outside = matches!(sources.in_charge(), Some(RcSource::Udp | RcSource::Msp));
        if from_outside && !sources.taken_over() && !self.vehicle.hands.cut {
            // Otherwise the resting virtual sticks would disarm the craft the moment a script stops.
            self.vehicle.hands.cut = true;
            self.vehicle.hands.pilot = None;
            self.vehicle.notice("RC comes from outside now: the virtual sticks are cut, x takes them back.");
        }
        if doorway.views.has_changed().unwrap_or(false) {
            doorway.views.mark_unchanged();
            self.changed = true;
        }
    }

    /// A script sends fifty frames of wall time a second; at a higher speed the receiver would miss it.
    fn keep_rc_fresh(&mut self) {
        if let Some(doorway) = &self.doorway
            && self.pacer.speed() > 1.0
            && self.vehicle.time().0.is_multiple_of(RC_REPEAT_US)
        {
            let speed = self.pacer.speed().min(*super::SPEED_RANGE.end());
            doorway.desk.keep_rc_fresh(self.vehicle.firmware_mut(), speed, Instant::now());
        }
    }

    fn carry_out(&mut self, command: Command, now: Duration) {
        match command {
            Command::Pause(paused) => self.pacer.set_paused(paused, now),
            Command::Step(ticks) => {
                for _ in 0..ticks {
                    self.vehicle.tick();
                }
            }
            Command::Speed(speed) => self.pacer.set_speed(speed, now),
            Command::Sticks(frame) => {
                if self.vehicle.hands.pilot.take().is_some() {
                    self.vehicle.notice("The sticks were moved: the scripted pilot let go.");
                }
                self.vehicle.hands.sticks = frame;
            }
            Command::CutRc(cut) => {
                // Taking the sticks back wins over a script that still sends.
                self.vehicle.firmware_mut().take_over_sticks(!cut);
                self.vehicle.hands.cut = cut;
            }
            Command::Cli { line, reply } => {
                let output = self.run_cli(&line);
                drop(reply.send(output));
            }
            Command::Upload { plan, settings, reply } => {
                let result = self.upload(&plan, &settings);
                drop(reply.send(result));
            }
            Command::Pilot(on) => self.set_pilot(on),
            Command::ReturnHome => {
                if let Err(refusal) = self.vehicle.firmware_mut().return_to_home() {
                    self.vehicle.notice(format!("No return home: {}", refusal.sentence()));
                }
            }
            Command::ResetCraft => self.vehicle.reset_craft(),
            Command::World { line, reply } => {
                let changed =
                    WorldCommand::parse(&line).map_err(|error| error.to_string()).and_then(|command| {
                        self.vehicle.change_world(command).map_err(|error| error.to_string())
                    });
                drop(reply.send(changed));
            }
            Command::Quit => self.quit = true,
        }
    }

    fn set_pilot(&mut self, on: bool) {
        if !on {
            self.vehicle.hands.pilot = None;
        } else if let Err(mode) = self.vehicle.start_pilot(self.takeoff_m) {
            self.vehicle.notice(format!(
                "The scripted pilot needs a switch for {mode}: give it one with the CLI command aux."
            ));
        }
    }

    fn run_cli(&mut self, line: &str) -> CliOutput {
        let reply = self.vehicle.firmware_mut().run_cli(&mut self.console, line);
        let restarted = self.act_on(&reply);
        let advice = advice(line, &reply);
        CliOutput { text: reply.text, advice, restarted }
    }

    /// Does what a command line asked the owner of the firmware to do; says whether the firmware restarted.
    fn act_on(&mut self, reply: &CliReply) -> bool {
        let mut restarted = false;
        for action in &reply.actions {
            match action {
                CliAction::Save => {
                    if let Err(error) = self.store.save(self.vehicle.firmware().configuration()) {
                        self.vehicle.notice(format!("Not saved: {error}."));
                    }
                    self.vehicle.firmware_mut().set_storage_facts(self.store.facts());
                }
                CliAction::Restart { .. } => {
                    let mut configuration = self.store.load().configuration;
                    configuration.starter_modes();
                    self.vehicle.firmware_mut().restart(configuration);
                    self.console = Interpreter::default();
                    restarted = true;
                }
                // The firmware itself has carried these out.
                CliAction::Leave | CliAction::MotorTest { .. } | CliAction::PlanChanged => {}
            }
        }
        restarted
    }

    /// Uploads as a ground station does: through the command line.
    fn upload(&mut self, plan: &FlightPlan, settings: &[String]) -> Result<(), String> {
        let mut line = Interpreter::default();
        for text in super::upload::lines(plan, settings) {
            let reply = self.vehicle.firmware_mut().run_cli(&mut line, &text);
            if reply.failed {
                return Err(format!("the craft refused `{text}`: {}", reply.text.trim()));
            }
        }
        Ok(())
    }
}
