//! The thread that owns the vehicle: carries out commands, runs the due ticks, publishes pictures and events.
#![allow(clippy::disallowed_methods, reason = "this is where wall time meets simulated time")]

use std::sync::Arc;
use std::task::{Context, Poll, Wake, Waker};
use std::thread::Thread;
use std::time::{Duration, Instant};

use tokio::sync::{mpsc, watch};

use super::arming::ArmingWatch;
use super::command::{CliOutput, Command, PLACE_IS_OUTSIDE, SessionView, TIME_IS_OUTSIDE};
use super::event::{Event, EventSender, SessionEvent};
use super::pacer::Pacer;
use super::persistence;
use super::request_handler::{Handled, RequestHandler};
use super::simulator::{RC_REPEAT_US, Simulator};
use crate::firmware::cli::{CliAction, CliReply, Interpreter, advice};
use crate::link::{ExternalSimulator, ImpairedLink, Request};
use crate::plan::{FlightPlan, upload_lines};
use crate::signals::RcSource;
use crate::sim::{Stream, WorldCommand};
use crate::storage::Store;
use crate::telemetry::{EndpointStatus, LinkState};
use crate::vehicle::Vehicle;

/// Interval of published pictures.
const PICTURE: Duration = Duration::from_millis(16);
/// Rhythm of the loop while time is paced.
const BEAT: Duration = Duration::from_millis(2);
/// Rhythm of the loop while nothing moves.
const PAUSED_BEAT: Duration = Duration::from_millis(8);
/// Most wall time that clients get in one round of the loop; what they asked beyond that waits for the next.
const ATTENTION: Duration = Duration::from_millis(1);
/// Ticks between two looks at the clock and the commands.
const SLICE: u64 = 500;

/// The doors, seen from the session.
#[derive(Debug)]
pub struct Doorway {
    /// What clients, scripts and simulators ask.
    pub requests: mpsc::Receiver<Request>,
    /// Answers them.
    pub handler: RequestHandler,
    /// The state of the doors.
    pub views: watch::Receiver<Vec<EndpointStatus>>,
    /// The simulator that moves the craft, when the vehicle is moved from outside.
    pub simulator: Option<ExternalSimulator>,
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
    /// What is reported first, after the boot.
    pub first_events: Vec<SessionEvent>,
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
pub fn start(mut config: SessionConfig) -> std::io::Result<Handle> {
    let simulator = config.doorway.as_mut().and_then(|doorway| doorway.simulator.take());
    let incoming = ImpairedLink::new(Stream::Link.rng(config.vehicle.world().seed()));
    let (command_tx, command_rx) = mpsc::channel(256);
    let (event_tx, event_rx) = mpsc::unbounded_channel();
    let mut session = Session {
        pacer: Pacer::new(config.vehicle.step_us(), config.speed),
        console: Interpreter::default(),
        vehicle: config.vehicle,
        store: config.store,
        takeoff_m: config.takeoff_m,
        simulator: simulator.map(|link| Simulator::new(link, incoming, Instant::now())),
        doorway: config.doorway,
        commands: command_rx,
        events: EventSender::new(event_tx),
        arming: ArmingWatch::default(),
        changed: true,
        more_waits: false,
        quit: false,
    };
    for event in config.first_events {
        session.events.report(&mut session.vehicle, event);
    }
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
    simulator: Option<Simulator>,
    doorway: Option<Doorway>,
    commands: mpsc::Receiver<Command>,
    events: EventSender,
    arming: ArmingWatch,
    /// Something other than time changed what the picture shows.
    changed: bool,
    /// Clients asked more than one round of the loop has time for.
    more_waits: bool,
    quit: bool,
}

/// Wakes the session's thread when a command or a request comes.
struct Bell(Thread);

impl Wake for Bell {
    fn wake(self: Arc<Self>) {
        self.0.unpark();
    }
}

impl Session {
    fn run(&mut self, view: &watch::Sender<SessionView>) {
        let bell = Waker::from(Arc::new(Bell(std::thread::current())));
        let mut bell = Context::from_waker(&bell);
        let start = Instant::now();
        let mut pictured = Duration::ZERO;
        let mut moved = false;
        self.flush_events();
        while !self.quit {
            self.take_commands(start.elapsed(), &mut bell);
            let flown = self.attend_doors(&mut bell);
            let now = start.elapsed();
            let due = if self.follows_wall_clock() { self.pacer.due(now, SLICE) } else { 0 };
            for _ in 0..due {
                self.keep_rc_fresh();
                self.vehicle.tick();
            }
            let ticks = flown + due;
            let after = start.elapsed();
            self.pacer.ran(ticks, after);
            if ticks > 0 || self.changed {
                self.flush_events();
            }
            moved |= ticks > 0;
            if self.changed || moved && after - pictured >= PICTURE {
                pictured = after;
                (self.changed, moved) = (false, false);
                let seen = self.view();
                if let Some(notice) = self.arming.look(&seen.vehicle) {
                    self.notice(notice);
                }
                view.send_replace(seen);
            }
            if ticks < SLICE && !self.more_waits {
                std::thread::park_timeout(self.rest().saturating_sub(start.elapsed().saturating_sub(now)));
            }
        }
    }

    /// Until a simulator outside speaks, and without one, time passes as on the wall.
    fn follows_wall_clock(&self) -> bool {
        self.simulator.as_ref().is_none_or(|simulator| simulator.state() == LinkState::Waiting)
    }

    /// How long the thread may sleep when nothing comes.
    fn rest(&self) -> Duration {
        match &self.simulator {
            Some(simulator) if !self.follows_wall_clock() => {
                PAUSED_BEAT.min(simulator.patience(Instant::now()))
            }
            _ if self.pacer.is_paused() => PAUSED_BEAT,
            _ => BEAT,
        }
    }

    fn view(&self) -> SessionView {
        SessionView {
            vehicle: Arc::new(self.vehicle.snapshot()),
            paused: self.pacer.is_paused(),
            speed_wanted: match self.simulator {
                Some(_) => f64::INFINITY,
                None => self.pacer.speed(),
            },
            speed_achieved: self.pacer.achieved(),
            sticks: self.vehicle.hands.sticks,
            rc_cut: self.vehicle.hands.cut,
            pilot: self.vehicle.hands.pilot.as_ref().map(crate::pilot::Pilot::doing),
            endpoints: self.endpoints(),
            simulator: self.simulator.as_ref().map(Simulator::state),
            live: self.doorway.is_some(),
        }
    }

    fn endpoints(&self) -> Vec<EndpointStatus> {
        let mut all = self.doorway.as_ref().map_or_else(Vec::new, |way| way.views.borrow().clone());
        all.extend(self.simulator.as_ref().map(|simulator| simulator.status(Instant::now())));
        all
    }

    fn flush_events(&mut self) {
        self.events.send_events_of(&mut self.vehicle);
    }

    fn notice(&mut self, text: impl Into<String>) {
        self.events.notice(&mut self.vehicle, text);
    }

    fn take_commands(&mut self, now: Duration, bell: &mut Context<'_>) {
        loop {
            match self.commands.poll_recv(bell) {
                Poll::Ready(Some(command)) => {
                    self.changed = true;
                    self.carry_out(command, now);
                }
                Poll::Ready(None) => {
                    self.quit = true;
                    return;
                }
                Poll::Pending => return,
            }
        }
    }

    /// Attends to what waits at the doors; gives the ticks that a simulator outside made the craft fly.
    fn attend_doors(&mut self, bell: &mut Context<'_>) -> u64 {
        // Otherwise the next picture is due soon.
        let time_stands_still = self.pacer.is_paused() || !self.follows_wall_clock();
        let Some(doorway) = &mut self.doorway else { return 0 };
        let mut flown = 0;
        let until = Instant::now() + ATTENTION;
        self.more_waits = true;
        while flown < SLICE && Instant::now() < until {
            let Poll::Ready(Some(request)) = doorway.requests.poll_recv(bell) else {
                self.more_waits = false;
                break;
            };
            // A simulator's packets change the picture like time does, at its own rhythm.
            self.changed |= time_stands_still && !matches!(request, Request::Fdm { .. });
            let firmware = self.vehicle.firmware_mut();
            let Handled { notices, restarted, fdm } =
                doorway.handler.handle(request, firmware, &mut self.store, Instant::now());
            for notice in notices {
                self.events.notice(&mut self.vehicle, notice);
            }
            if restarted {
                self.console = Interpreter::default();
            }
            if let (Some((datagram, at)), Some(simulator)) = (fdm, &mut self.simulator) {
                let speed = self.pacer.achieved();
                flown += simulator.hear(
                    datagram,
                    at,
                    &mut self.vehicle,
                    &mut doorway.handler,
                    &self.events,
                    speed,
                );
            }
        }
        if let Some(simulator) = &mut self.simulator {
            let speed = self.pacer.achieved();
            flown +=
                simulator.watch(Instant::now(), &mut self.vehicle, &mut doorway.handler, &self.events, speed);
            self.changed |= simulator.take_news();
        }
        let sources = self.vehicle.firmware().receiver().sources();
        let from_outside = matches!(sources.in_charge(), Some(RcSource::Udp | RcSource::Msp));
        if from_outside && !sources.taken_over() && !self.vehicle.hands.cut {
            // Otherwise the resting virtual sticks would disarm the craft the moment a script stops.
            self.vehicle.hands.cut = true;
            self.vehicle.hands.pilot = None;
            self.events.notice(
                &mut self.vehicle,
                "RC comes from outside now: the virtual sticks are cut, x takes them back.",
            );
        }
        if doorway.views.has_changed().unwrap_or(false) {
            doorway.views.mark_unchanged();
            self.changed = true;
        }
        flown
    }

    /// A script sends fifty frames of wall time a second; at a higher speed the receiver would miss it.
    fn keep_rc_fresh(&mut self) {
        if let Some(doorway) = &self.doorway
            && self.pacer.speed() > 1.0
            && self.vehicle.time().0.is_multiple_of(RC_REPEAT_US)
        {
            let speed = self.pacer.speed().min(*super::SPEED_RANGE.end());
            doorway.handler.keep_rc_fresh(self.vehicle.firmware_mut(), speed, Instant::now());
        }
    }

    fn carry_out(&mut self, command: Command, now: Duration) {
        match command {
            Command::Pause(_) | Command::Step(_) | Command::Speed(_) if self.simulator.is_some() => {
                self.notice(TIME_IS_OUTSIDE);
            }
            Command::Pause(paused) => self.pacer.set_paused(paused, now),
            Command::Step(ticks) => {
                for _ in 0..ticks {
                    self.vehicle.tick();
                }
            }
            Command::Speed(speed) => self.pacer.set_speed(speed, now),
            Command::Sticks(frame) => {
                if self.vehicle.hands.pilot.take().is_some() {
                    self.notice("The sticks were moved: the scripted pilot let go.");
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
                    self.notice(format!("No return home: {}", refusal.sentence()));
                }
            }
            Command::CancelReturn => self.vehicle.firmware_mut().cancel_command(),
            Command::ResetCraft => self.reset_craft(),
            Command::World { line, reply } => {
                let changed = self.change_world(&line);
                drop(reply.send(changed));
            }
            Command::Quit => self.quit = true,
        }
    }

    fn reset_craft(&mut self) {
        match &self.simulator {
            Some(simulator) if simulator.state() == LinkState::Flowing => {
                self.notice(PLACE_IS_OUTSIDE);
                return;
            }
            Some(_) => {
                self.vehicle.reset_craft();
                self.notice("The firmware started anew, disarmed; the simulator places the craft.");
            }
            None => self.vehicle.reset_craft(),
        }
        if let Some(doorway) = &mut self.doorway {
            doorway.handler.after_restart(false, self.vehicle.firmware_mut());
        }
    }

    fn change_world(&mut self, line: &str) -> Result<(), String> {
        let command = WorldCommand::parse(line).map_err(|error| error.to_string())?;
        self.vehicle.change_world(command).map_err(|error| error.to_string())
    }

    fn set_pilot(&mut self, on: bool) {
        if !on {
            self.vehicle.hands.pilot = None;
        } else if let Err(mode) = self.vehicle.start_pilot(self.takeoff_m) {
            self.notice(format!(
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
        let mut notices = Vec::new();
        for action in &reply.actions {
            match action {
                CliAction::Save => {
                    notices.extend(persistence::save(self.vehicle.firmware_mut(), &mut self.store).err());
                }
                CliAction::Restart { .. } => {
                    let firmware = self.vehicle.firmware_mut();
                    notices.extend(persistence::restart(firmware, &mut self.store, true));
                    self.console = Interpreter::default();
                    restarted = true;
                }
                // The firmware itself has carried these out.
                CliAction::Leave | CliAction::MotorTest { .. } | CliAction::PlanChanged => {}
            }
        }
        if restarted && let Some(doorway) = &mut self.doorway {
            doorway.handler.after_restart(true, self.vehicle.firmware_mut());
        }
        notices.into_iter().for_each(|notice| self.notice(notice));
        restarted
    }

    /// Uploads as a ground station does: through the command line.
    fn upload(&mut self, plan: &FlightPlan, settings: &[String]) -> Result<(), String> {
        let mut line = Interpreter::default();
        for text in upload_lines(plan, settings) {
            let reply = self.vehicle.firmware_mut().run_cli(&mut line, &text);
            if reply.failed {
                return Err(format!("the craft refused `{text}`: {}", reply.text.trim()));
            }
        }
        Ok(())
    }
}
