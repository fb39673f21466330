//! The loop around the user interface: waits, passes messages in, carries out effects, draws.

#![allow(clippy::disallowed_methods, reason = "the shell of the user interface lives on wall-clock time")]

use std::io::{self, IsTerminal as _};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use crossterm::event::{Event as TerminalEvent, EventStream};
use futures_util::StreamExt as _;
use rustix::process::Signal;
use tokio::signal::unix::{SignalKind, signal};
use tokio::sync::{mpsc, oneshot, watch};
use tokio::time::sleep;

use crate::events::Event;
use crate::replay::Overview;
use crate::session::{Command, SessionView};
use crate::timeline::RecordedFlight;

use super::app_state::AppState;
use super::files_link::FilesLink;
use super::terminal::{Tui, can_be_continued};
use super::update::{follow_screen, keep, restore, update};
use crate::ui::model::config::UiConfig;
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::model::flights::FlightShelf;
use crate::ui::model::message::Msg;

mod effects;
mod flights;
mod plain;
mod typed_ahead;

use effects::{Answers, Threads, carry_out};
use flights::Shown;
pub use plain::run_plain;
use typed_ahead::{Input, TypedAhead};

/// The shortest time between two frames after a key.
const KEY_FRAME: Duration = Duration::from_millis(16);
/// The shortest time between two frames when only the flight went on.
const FLIGHT_FRAME: Duration = Duration::from_millis(50);
/// The longest time without a frame while something on the screen fades.
const FADE_FRAME: Duration = Duration::from_millis(500);
/// The time after which keys that wait are looked at again.
const HELD: Duration = Duration::from_millis(50);
/// The number of events processed at once.
const BATCH: usize = 256;

/// Receives a second flight: the name of its file, safe to print, and the flight, or the reason why it cannot be shown.
pub type OtherReceiver = oneshot::Receiver<(String, Result<Arc<Overview>, String>)>;

/// Writes the bytes of a recording to a file, or to one that is named after the plan. Returns a sentence.
type WriteFlight = fn(Option<PathBuf>, &str, RecordedFlight) -> Result<String, String>;
type WriteRecording = fn(Option<PathBuf>, &str, &[u8]) -> Result<String, String>;

/// The user interface's link to the session.
#[derive(Debug)]
pub struct SessionLink {
    pub commands: mpsc::Sender<Command>,
    pub view: watch::Receiver<SessionView>,
    pub events: mpsc::UnboundedReceiver<Event>,
    /// Pictures of an earlier flight, oldest first.
    pub past: Vec<SessionView>,
    /// A second flight, once it is read.
    pub other: Option<OtherReceiver>,
    /// The library of recorded flights, if there is one.
    pub shelf: Option<Arc<dyn FlightShelf>>,
    /// Writes a flight as a scenario. Receives the file, or the name of the plan if there is none. Returns a sentence
    /// with the place, or with the reason for a failure.
    pub write_scenario: WriteFlight,
    /// Writes the blackbox log of a flight, in the same way.
    pub write_log: WriteFlight,
    /// Writes a recording, in the same way.
    pub write_recording: WriteRecording,
}

/// The reason for the end of the user interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    Quit,
    /// A signal requested it.
    Signal,
    /// The session ended by itself.
    SessionEnded,
    /// The terminal went away.
    TerminalLost,
}

/// The reason for which the loop woke.
enum Wake {
    Msg(Msg),
    /// The program has to stop.
    Suspend,
    /// The program continues after a stop.
    Resume,
    Flight(Msg),
    Time,
    End(Ending),
}

/// Runs the user interface until it ends, at the latest when `stop` does. Drops `tui` at the end, which restores the
/// terminal.
///
/// # Errors
/// Returns an error if the terminal could not be read or written.
pub async fn run(
    tui: Tui,
    link: SessionLink,
    files: FilesLink,
    config: UiConfig,
    stop: impl Future<Output = ()>,
) -> io::Result<Ending> {
    match run_loop(tui, link, files, config, stop).await {
        // A closed terminal may fail in different ways.
        Err(_) if !io::stdout().is_terminal() => Ok(Ending::TerminalLost),
        ended => ended,
    }
}

async fn run_loop(
    tui: Tui,
    link: SessionLink,
    files: FilesLink,
    config: UiConfig,
    stop: impl Future<Output = ()>,
) -> io::Result<Ending> {
    // Signals of other programs; the Ctrl-Z key is an effect.
    let mut suspend = signal(SignalKind::from_raw(Signal::TSTP.as_raw()))?;
    let mut resume = signal(SignalKind::from_raw(Signal::CONT.as_raw()))?;
    let started = Instant::now();
    let mut stop = std::pin::pin!(stop);
    let (mut screen, mut replies) = Screen::start(tui, link, files, config)?;
    let mut events = Vec::with_capacity(BATCH);
    let mut drawn = Instant::now();
    // The time of the next frame; `None` while nothing has changed.
    let mut due: Option<Instant> = None;

    loop {
        let is_held = screen.holds_keys();
        let frame_at = due.unwrap_or(drawn + if is_held { HELD } else { FADE_FRAME });
        let early = screen.ahead.next(is_held);
        let link = &mut screen.link;
        let wake = tokio::select! {
            // Keys first: the user gets an answer before the flight is shown.
            biased;
            () = &mut stop => Wake::End(Ending::Signal),
            Some(event) = std::future::ready(early) => terminal_message(event).map_or(Wake::Time, Wake::Msg),
            Some(()) = suspend.recv() => Wake::Suspend,
            Some(()) = resume.recv() => Wake::Resume,
            // An answer that keys typed ahead are meant for comes before them.
            Some(reply) = screen.files.replies.recv() => Wake::Msg(Msg::Files(reply)),
            key = screen.keys.next(), if screen.ahead.reads_keys(is_held) => match key {
                Some(Ok(event)) => match screen.ahead.let_through(event, is_held) {
                    Some(event) => terminal_message(event).map_or(Wake::Time, Wake::Msg),
                    None => continue,
                },
                Some(Err(error)) => return Err(error),
                None => Wake::End(Ending::TerminalLost),
            },
            Some(msg) = replies.recv() => Wake::Msg(msg),
            Some(msg) = second_flight(&mut link.other) => Wake::Msg(msg),
            () = sleep(frame_at.saturating_duration_since(Instant::now())) => Wake::Time,
            received = link.events.recv_many(&mut events, BATCH) => match received {
                0 => Wake::End(Ending::SessionEnded),
                _ => Wake::Flight(Msg::Clock(started.elapsed())),
            },
            changed = link.view.changed() => match changed {
                Ok(()) => Wake::Flight(Msg::View(link.view.borrow_and_update().clone())),
                Err(_) => Wake::End(Ending::SessionEnded),
            },
        };
        let now = Instant::now();
        update(&mut screen.state, Msg::Clock(now - started));
        let (msg, frame) = match wake {
            Wake::End(ending) => {
                let kept = keep(&mut screen.state);
                screen.carry_out(kept);
                return Ok(screen.quit(ending));
            }
            Wake::Time => {
                // Nothing else looks at a screen that waits.
                let kept = follow_screen(&mut screen.state);
                screen.carry_out(kept);
                (None, Duration::ZERO)
            }
            Wake::Suspend => {
                screen.tui.suspend()?;
                (Some(screen.size()?), Duration::ZERO)
            }
            Wake::Resume => {
                screen.tui.resume()?;
                (Some(screen.size()?), Duration::ZERO)
            }
            Wake::Msg(msg) => (Some(msg), KEY_FRAME),
            Wake::Flight(msg) => (Some(msg), FLIGHT_FRAME),
        };
        let received = events.drain(..).map(Msg::Event);
        for msg in received.chain(msg).collect::<Vec<_>>() {
            if let Some(ending) = screen.take(msg, now, &mut stop).await? {
                return Ok(screen.quit(ending));
            }
        }
        let wanted = drawn + frame;
        due = Some(due.map_or(wanted, |due| due.min(wanted)));
        if due.is_some_and(|due| due <= now) {
            screen.files.keep_edits().await;
            screen.tui.draw(&screen.state)?;
            drawn = Instant::now();
            due = None;
        }
    }
}

/// The running user interface with its links.
struct Screen {
    state: AppState,
    link: SessionLink,
    files: FilesLink,
    threads: Threads,
    answers: Answers,
    keys: EventStream,
    ahead: TypedAhead,
    /// Last, so that the reader of the keys ends before the terminal is restored.
    tui: Tui,
}

impl Screen {
    /// Draws the first frame. Returns the screen, and the receiver of the answers to its effects.
    fn start(
        mut tui: Tui,
        mut link: SessionLink,
        files: FilesLink,
        config: UiConfig,
    ) -> io::Result<(Self, mpsc::UnboundedReceiver<Msg>)> {
        let size = tui.terminal().size()?;
        let view = link.view.borrow_and_update().clone();
        let mut state = AppState::new(config, (size.width, size.height), view.clone());
        // Each picture extends tracks and graphs.
        for past in link.past.drain(..).chain([view]) {
            update(&mut state, Msg::View(past));
        }
        // Before the first frame: a terminal that is closed once it has seen that frame sends no keys any more.
        let keys = EventStream::new();
        restore(&mut state);
        tui.draw(&state)?;
        let (answers, replies) = Answers::channel();
        let threads = Threads::start(&answers)?;
        let ahead = TypedAhead::default();
        Ok((Self { tui, state, link, files, threads, answers, keys, ahead }, replies))
    }

    /// Returns `true` while keys wait for an answer.
    fn holds_keys(&mut self) -> bool {
        let taken = self.state.shared.view.commands_taken;
        self.ahead.holds_keys(taken, Instant::now()) || self.files.holds_keys()
    }

    /// Returns the message with the size of the terminal.
    fn size(&mut self) -> io::Result<Msg> {
        let size = self.tui.terminal().size()?;
        Ok(Msg::Resize(size.width, size.height))
    }

    /// Carries out an effect, if there is one. Returns `true` if the session gets a command.
    fn carry_out(&mut self, effect: Option<Effect>) -> bool {
        let Self { link, threads, files, answers, .. } = self;
        effect.is_some_and(|effect| carry_out(effect, link, threads, files, answers))
    }

    /// Ends the session.
    fn quit(&self, ending: Ending) -> Ending {
        self.link.commands.try_send(Command::Quit).ok();
        ending
    }

    /// Takes a message and carries out its effects. Returns the reason if one of them ends the user interface.
    async fn take(
        &mut self,
        msg: Msg,
        now: Instant,
        stop: &mut (impl Future<Output = ()> + Unpin),
    ) -> io::Result<Option<Ending>> {
        if matches!(msg, Msg::Resize(..)) {
            self.tui.lose_screen();
        }
        let input = Input::of(&msg);
        self.ahead.hears(&msg);
        let effects = update(&mut self.state, msg);
        let is_awaited = self.ahead.takes(input, &effects, now);
        for effect in effects {
            match &effect {
                Effect::Quit => return Ok(Some(Ending::Quit)),
                Effect::Redraw => self.tui.lose_screen(),
                Effect::Suspend => self.suspend()?,
                Effect::ShowFlights { files, again } => {
                    if !self.show_flights(files, *again, &mut *stop).await? {
                        return Ok(Some(Ending::Signal));
                    }
                }
                _ => {
                    if self.carry_out(Some(effect)) {
                        self.ahead.sends(is_awaited, now);
                    }
                }
            }
        }
        Ok(None)
    }

    /// Stops the program until its shell continues it.
    fn suspend(&mut self) -> io::Result<()> {
        if !can_be_continued() {
            let text = "Not stopped: there is no shell that could continue the program.";
            self.state.shared.notify(Severity::Warn, text);
            return Ok(());
        }
        self.tui.suspend()?;
        let size = self.size()?;
        update(&mut self.state, size);
        Ok(())
    }

    /// Leaves the terminal to another program that shows flights, until it ends. Returns `false` if this program has to
    /// stop meanwhile.
    async fn show_flights(
        &mut self,
        files: &[PathBuf],
        again: bool,
        stop: impl Future<Output = ()>,
    ) -> io::Result<bool> {
        // The reader of the terminal ends, so that the keys go to the other program. What it has read already was meant
        // for that program and would act on this one.
        self.keys = EventStream::new();
        drop_typed_keys()?;
        self.ahead.drop_key();
        self.tui.leave();
        let shown = flights::show(self.link.shelf.as_ref(), files, again, stop).await;
        self.tui.resume()?;
        let Shown::Left(result) = shown else { return Ok(false) };
        let size = self.size()?;
        update(&mut self.state, size);
        update(&mut self.state, Msg::FlightsShown(result));
        Ok(true)
    }
}

/// Drops what was typed so far. A mouse that keeps moving does not hold it up.
fn drop_typed_keys() -> io::Result<()> {
    /// The time for which a reader that ends may still hold the terminal.
    const READER_ENDS: Duration = Duration::from_millis(20);
    let end = Instant::now() + 5 * READER_ENDS;
    while Instant::now() < end && crossterm::event::poll(READER_ENDS)? {
        crossterm::event::read()?;
    }
    Ok(())
}

/// Waits for the second flight. Returns its message once; without one, or after it, `None` at once.
async fn second_flight(other: &mut Option<OtherReceiver>) -> Option<Msg> {
    let received = other.as_mut()?.await;
    *other = None;
    let (name, result) = received.ok()?;
    Some(Msg::OtherFlight { name, result })
}

/// Returns the message of a terminal event, if there is one.
fn terminal_message(event: TerminalEvent) -> Option<Msg> {
    match event {
        TerminalEvent::Key(key) => Some(Msg::Key(key)),
        TerminalEvent::Mouse(mouse) => Some(Msg::Mouse(mouse)),
        TerminalEvent::Paste(text) => Some(Msg::Paste(text)),
        TerminalEvent::Resize(columns, rows) => Some(Msg::Resize(columns, rows)),
        TerminalEvent::FocusGained | TerminalEvent::FocusLost => None,
    }
}
