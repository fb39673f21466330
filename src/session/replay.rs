//! A session without a vehicle: the thread that plays flights of a recorded file.
//!
//! It takes the same commands and publishes the same views and events as a session that flies. `player` has the play head of
//! one flight. Commands to a craft are refused.
#![allow(clippy::disallowed_methods, reason = "this is where wall time meets the time of the flight")]

mod player;
mod view;

use std::task::Context;
use std::time::{Duration, Instant};

use tokio::sync::{mpsc, watch};

use super::command::{Command, Seek, SessionView};
use super::command_queue::CommandQueue;
use super::event_sender::EventSender;
use super::policy::{self, Facts, Intent};
use super::runtime::{Handle, refuse_command};
use super::waker;
use crate::events::{Event, ReplayNotice, SessionEvent};
use crate::replay::{PastEventKind, PastFlights};
use crate::signals::SimTime;
use player::Player;

/// The interval of published views.
const VIEW_INTERVAL: Duration = Duration::from_millis(16);
/// The interval of the views that show how much of a file was read.
const READING_INTERVAL: Duration = Duration::from_millis(100);
/// The longest sleep of the loop while nothing moves. Commands wake it.
const MAX_SLEEP: Duration = Duration::from_secs(1);

/// The instant at which a replay begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ReplayStart {
    /// Seconds since the first instant of the flight.
    Seconds(f64),
    /// The time on the craft's clock.
    Clock(SimTime),
}

/// The start of a replay.
pub struct ReplayConfig {
    pub flights: Box<dyn PastFlights>,
    /// The first flight to show, numbered from zero; `None` for the first that can be shown.
    pub number: Option<usize>,
    /// `true` if the flight and its instant were left in an earlier run: if the file has no such flight, the first one that
    /// can be shown is shown.
    pub is_left: bool,
    /// The first instant to show, with time paused. `None` plays the flight from its beginning.
    pub start: Option<ReplayStart>,
    /// The multiple of real time at the start.
    pub speed: f64,
    /// The notices that are reported once the first flight is shown.
    pub notices: Vec<String>,
}

impl std::fmt::Debug for ReplayConfig {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ReplayConfig").field("number", &self.number).finish_non_exhaustive()
    }
}

/// Starts the thread of a replay.
///
/// # Errors
/// Returns an error if the system cannot start a thread.
pub fn start_replay(config: ReplayConfig) -> std::io::Result<Handle> {
    let (command_tx, command_rx) = mpsc::channel(256);
    let (event_tx, event_rx) = mpsc::unbounded_channel();
    let mut session = ReplaySession::new(config, command_rx, event_tx);
    let (view_tx, view_rx) = watch::channel(session.view());
    let thread =
        std::thread::Builder::new().name("replay".to_owned()).spawn(move || session.run(&view_tx))?;
    Ok(Handle { commands: command_tx, orders: mpsc::channel(1).0, view: view_rx, events: event_rx, thread })
}

struct ReplaySession {
    flights: Box<dyn PastFlights>,
    /// The number of the flight that is shown, or of the first one to show.
    number: Option<usize>,
    is_left: bool,
    start: Option<ReplayStart>,
    speed: f64,
    /// The flight that is shown; `None` until it is read.
    player: Option<Player>,
    commands: CommandQueue,
    events: EventSender,
    /// The notices that wait for the first flight, whose beginning clears the log.
    notices: Vec<String>,
    changed: bool,
    quit: bool,
}

impl ReplaySession {
    fn new(
        config: ReplayConfig,
        commands: mpsc::Receiver<Command>,
        events: mpsc::UnboundedSender<Event>,
    ) -> Self {
        Self {
            number: config.number,
            is_left: config.is_left,
            flights: config.flights,
            start: config.start,
            speed: config.speed,
            player: None,
            commands: CommandQueue::new(commands),
            events: EventSender::new(events),
            notices: config.notices,
            changed: true,
            quit: false,
        }
    }

    /// Runs until it is told to quit. Returns the reason if there is nothing to show.
    fn run(&mut self, view: &watch::Sender<SessionView>) -> Option<String> {
        let waker = waker::of_this_thread();
        let mut context = Context::from_waker(&waker);
        let clock = Instant::now();
        match self.begin_with_file(clock, view) {
            Ok(true) => {}
            // The screen has left meanwhile.
            Ok(false) => return None,
            Err(why) => return Some(why),
        }
        std::mem::take(&mut self.notices).into_iter().for_each(|text| self.notice(text));
        let (mut published, mut shown_events) = (Duration::ZERO, 0);
        while !self.quit {
            let further = self.take_commands(clock.elapsed(), &mut context);
            if let Some(further) = further {
                self.show_further(further, clock.elapsed());
            }
            let now = clock.elapsed();
            let moved = self.player.as_mut().map_or(Ok(false), |player| player.play(now));
            let moved = moved.unwrap_or_else(|why| self.fail(why, now));
            let has_news = self.changed || self.events.sent() > shown_events;
            if has_news || moved && now.saturating_sub(published) >= VIEW_INTERVAL {
                published = now;
                shown_events = self.events.sent();
                self.changed = false;
                view.send_replace(self.view());
            }
            if self.commands.is_idle() {
                let is_playing = self.player.as_ref().is_some_and(Player::is_playing);
                std::thread::park_timeout(if is_playing { VIEW_INTERVAL } else { MAX_SLEEP });
            }
        }
        None
    }

    /// Reads the file and shows the first flight. Returns `false` if the receiver of the views has left.
    fn begin_with_file(&mut self, clock: Instant, view: &watch::Sender<SessionView>) -> Result<bool, String> {
        let name = self.flights.name().to_owned();
        let mut published = Duration::ZERO;
        let (commands, speed) = (&self.commands, self.speed);
        let mut progress = |share: f64| {
            let now = clock.elapsed();
            if now.saturating_sub(published) >= READING_INTERVAL {
                published = now;
                view.send_replace(view::while_reading(&name, share, speed));
            }
            !commands.is_closed()
        };
        if !self.flights.read(&mut progress)? {
            return Ok(false);
        }
        let now = clock.elapsed();
        if let Some(number) = self.number {
            match self.show_flight(number, now) {
                Err(_) if self.is_left => self.start = None,
                shown => return shown.map(|()| true),
            }
        }
        self.show_first_of(0..self.flights.count(), now)?;
        Ok(true)
    }

    /// Shows the first flight that can be shown. Reports those before it.
    fn show_first_of(&mut self, numbers: impl Iterator<Item = usize>, now: Duration) -> Result<(), String> {
        let mut refused = None;
        for number in numbers {
            match self.show_flight(number, now) {
                Ok(()) => {
                    refused.into_iter().for_each(|why| self.report(ReplayNotice::Warning(why)));
                    return Ok(());
                }
                Err(why) => refused = Some(why),
            }
        }
        refused.map_or(Ok(()), Err)
    }

    /// Shows a flight. If that fails, the flight before stays.
    fn show_flight(&mut self, number: usize, now: Duration) -> Result<(), String> {
        let flight = self.flights.open(number)?;
        let player = Player::new(flight, self.start.take(), self.speed, now)?;
        self.changed = true;
        self.number = Some(number);
        self.begin(&player, number);
        self.player = Some(player);
        Ok(())
    }

    /// Reports the beginning of a flight and all of its events.
    fn begin(&mut self, player: &Player, number: usize) {
        let overview = player.overview();
        let (first, count) = (overview.first, self.flights.count());
        let which = match count {
            1 => String::new(),
            count => format!(", flight {} of {count}", number + 1),
        };
        let name = self.flights.name();
        let length_s = overview.last.seconds_since(first);
        let begins = ReplayNotice::Begins(format!("{name}{which}: {length_s:.1} s of flight are shown."));
        let mut send = |time, kind| self.events.send(&Event { time, kind });
        send(first, SessionEvent::Replay(begins));
        let event = |kind: &PastEventKind| match kind {
            PastEventKind::Vehicle(kind) => SessionEvent::Vehicle(kind.clone()),
            PastEventKind::Warning(text) => SessionEvent::Replay(ReplayNotice::Warning(text.clone())),
            PastEventKind::Notice(text) => SessionEvent::Notice(text.clone()),
        };
        for text in self.flights.notices() {
            send(first, SessionEvent::Notice(text));
        }
        for kind in &overview.about {
            send(first, event(kind));
        }
        for past in &overview.events {
            send(past.time, event(&past.kind));
        }
    }

    /// Takes the commands that wait. Returns the way to another flight to show.
    fn take_commands(&mut self, now: Duration, context: &mut Context<'_>) -> Option<isize> {
        while let Some(command) = self.commands.take(context) {
            self.changed = true;
            match command {
                Command::ShowFlight(further) => return Some(further),
                Command::Seek(seek) => {
                    self.seek(seek, now);
                    // Its view is shown before the next seek.
                    return None;
                }
                command => self.carry_out(command, now),
            }
        }
        self.quit |= self.commands.has_ended();
        None
    }

    /// Shows the flight this many further, or the next one in this direction that can be shown.
    fn show_further(&mut self, further: isize, now: Duration) {
        let count = self.flights.count();
        let Some(shown) = self.number else { return };
        let step = further.signum();
        let numbers = std::iter::successors(shown.checked_add_signed(further), |number| {
            number.checked_add_signed(step)
        });
        let mut numbers = numbers.take_while(|number| *number < count).take(count).peekable();
        if numbers.peek().is_some() {
            if let Err(why) = self.show_first_of(numbers, now) {
                self.report(ReplayNotice::Failed(why));
            }
            return;
        }
        self.notice(match count {
            1 => "The file has only this flight.".to_owned(),
            _ if further < 0 => "This is the first flight of the file.".to_owned(),
            count => format!("This is the last flight of the file, {} of {count}.", shown + 1),
        });
    }

    fn carry_out(&mut self, command: Command, now: Duration) {
        if let Err(refusal) = policy::check(&Facts::from(&self.view()), Intent::of(&command)) {
            if let Some(sentence) = refuse_command(command, refusal) {
                self.notice(sentence);
            }
            return;
        }
        match command {
            Command::Quit => self.quit = true,
            Command::Curves { request, reply } => {
                let player = self.player.as_mut();
                let none = || Err("No flight is read yet.".to_owned());
                reply.send(player.map_or_else(none, |player| player.curves(&request)));
            }
            Command::RecordedFlight(reply) => {
                let name = self.flights.name();
                reply.send(Err(format!(
                    "{name} is shown, not flown: `betadeck open` flies a recording again."
                )));
            }
            Command::CopyRecording(reply) => {
                reply.send(Err(format!("the flight is recorded already, in {}.", self.flights.name())));
            }
            Command::Speed(speed) => {
                self.speed = speed;
                if let Some(player) = &mut self.player {
                    player.set_speed(speed, now);
                }
            }
            Command::Pause(paused) => self.with_player(now, |player| player.pause(paused, now)),
            Command::Step(ticks) => self.with_player(now, |player| player.step(ticks, now)),
            // A recorded flight has no remote craft. The policy refuses the rest.
            _ => {}
        }
    }

    fn seek(&mut self, seek: Seek, now: Duration) {
        let Some(player) = &mut self.player else { return };
        match player.seek(seek, now) {
            Ok(None) => {}
            Ok(Some(sentence)) => self.notice(sentence),
            Err(why) => {
                self.fail(why, now);
            }
        }
    }

    fn with_player(&mut self, now: Duration, act: impl FnOnce(&mut Player) -> Result<(), String>) {
        if let Some(Err(why)) = self.player.as_mut().map(act) {
            self.fail(why, now);
        }
    }

    /// Reports that the file can no longer be read, and pauses. The picture stays. Returns `false`.
    fn fail(&mut self, why: String, now: Duration) -> bool {
        self.changed = true;
        if self.player.as_mut().is_some_and(|player| player.halt(now)) {
            self.report(ReplayNotice::Failed(why));
        }
        false
    }

    fn notice(&mut self, text: impl Into<String>) {
        self.send(SessionEvent::Notice(text.into()));
    }

    fn report(&mut self, notice: ReplayNotice) {
        self.send(SessionEvent::Replay(notice));
    }

    fn send(&mut self, kind: SessionEvent) {
        let time = self.player.as_ref().map_or(SimTime::ZERO, Player::shown);
        self.events.send(&Event { time, kind });
    }

    fn view(&self) -> SessionView {
        let name = self.flights.name();
        let view = match &self.player {
            Some(player) => view::of(player, (name, self.number.unwrap_or_default(), self.flights.count())),
            None => view::while_reading(name, 0.0, self.speed),
        };
        SessionView { commands_taken: self.commands.taken(), events_sent: self.events.sent(), ..view }
    }
}

#[cfg(test)]
mod tests;
