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
    mut tui: Tui,
    mut link: SessionLink,
    mut files: FilesLink,
    config: UiConfig,
    stop: impl Future<Output = ()>,
) -> io::Result<Ending> {
    // Signals of other programs; the Ctrl-Z key is an effect.
    let mut suspend = signal(SignalKind::from_raw(Signal::TSTP.as_raw()))?;
    let mut resume = signal(SignalKind::from_raw(Signal::CONT.as_raw()))?;
    let started = Instant::now();
    let mut stop = std::pin::pin!(stop);
    let size = tui.terminal().size()?;
    let view = link.view.borrow_and_update().clone();
    let mut state = AppState::new(config, (size.width, size.height), view.clone());
    // Each picture extends tracks and graphs.
    for past in link.past.drain(..).chain([view]) {
        update(&mut state, Msg::View(past));
    }
    // Before the first frame: a terminal that is closed once it has seen that frame sends no keys any more.
    let mut keys = EventStream::new();
    restore(&mut state);
    tui.draw(&state)?;

    let (answers, mut replies) = Answers::channel();
    let threads = Threads::start(&answers)?;
    let mut ahead = TypedAhead::default();
    let mut events = Vec::with_capacity(BATCH);
    let mut drawn = Instant::now();
    // The time of the next frame; `None` while nothing has changed.
    let mut due: Option<Instant> = None;

    loop {
        let is_held =
            ahead.holds_keys(state.shared.view.commands_taken, Instant::now()) || files.holds_keys();
        let frame_at = due.unwrap_or(drawn + if is_held { HELD } else { FADE_FRAME });
        let early = ahead.next(is_held);
        let wake = tokio::select! {
            // Keys first: the user gets an answer before the flight is shown.
            biased;
            () = &mut stop => Wake::End(Ending::Signal),
            Some(event) = std::future::ready(early) => terminal_message(event).map_or(Wake::Time, Wake::Msg),
            Some(()) = suspend.recv() => Wake::Suspend,
            Some(()) = resume.recv() => Wake::Resume,
            // An answer that keys typed ahead are meant for comes before them.
            Some(reply) = files.replies.recv() => Wake::Msg(Msg::Files(reply)),
            key = keys.next(), if ahead.reads_keys(is_held) => match key {
                Some(Ok(event)) => match ahead.let_through(event, is_held) {
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
        update(&mut state, Msg::Clock(now - started));
        let (msg, frame) = match wake {
            Wake::End(ending) => {
                if let Some(effect) = keep(&mut state) {
                    carry_out(effect, &link, &threads, &mut files, &answers);
                }
                link.commands.try_send(Command::Quit).ok();
                return Ok(ending);
            }
            Wake::Time => {
                // Nothing else looks at a screen that waits.
                if let Some(effect) = follow_screen(&mut state) {
                    carry_out(effect, &link, &threads, &mut files, &answers);
                }
                (None, Duration::ZERO)
            }
            Wake::Suspend | Wake::Resume => {
                if matches!(wake, Wake::Suspend) {
                    tui.suspend()?;
                } else {
                    tui.resume()?;
                }
                let size = tui.terminal().size()?;
                (Some(Msg::Resize(size.width, size.height)), Duration::ZERO)
            }
            Wake::Msg(msg) => (Some(msg), KEY_FRAME),
            Wake::Flight(msg) => (Some(msg), FLIGHT_FRAME),
        };
        let received = events.drain(..).map(Msg::Event);
        for msg in received.chain(msg).collect::<Vec<_>>() {
            if matches!(msg, Msg::Resize(..)) {
                tui.lose_screen();
            }
            let input = Input::of(&msg);
            ahead.hears(&msg);
            let effects = update(&mut state, msg);
            let is_awaited = ahead.takes(input, &effects, now);
            for effect in effects {
                if matches!(effect, Effect::Quit) {
                    link.commands.try_send(Command::Quit).ok();
                    return Ok(Ending::Quit);
                }
                if matches!(effect, Effect::Redraw) {
                    tui.lose_screen();
                }
                if matches!(effect, Effect::Suspend) && !can_be_continued() {
                    state.shared.notify(
                        Severity::Warn,
                        "Not stopped: there is no shell that could continue the program.",
                    );
                } else if matches!(effect, Effect::Suspend) {
                    tui.suspend()?;
                    let size = tui.terminal().size()?;
                    update(&mut state, Msg::Resize(size.width, size.height));
                }
                if let Effect::ShowFlights { files, again } = &effect {
                    // The reader of the terminal ends, so that the keys go to the other program. What it has read
                    // already was meant for that program and would act on this one.
                    keys = EventStream::new();
                    drop_typed_keys()?;
                    ahead.drop_key();
                    tui.leave();
                    let shown = flights::show(link.shelf.as_ref(), files, *again, &mut stop).await;
                    tui.resume()?;
                    let Shown::Left(result) = shown else {
                        link.commands.try_send(Command::Quit).ok();
                        return Ok(Ending::Signal);
                    };
                    let size = tui.terminal().size()?;
                    update(&mut state, Msg::Resize(size.width, size.height));
                    update(&mut state, Msg::FlightsShown(result));
                }
                if carry_out(effect, &link, &threads, &mut files, &answers) {
                    ahead.sends(is_awaited, now);
                }
            }
        }
        let wanted = drawn + frame;
        due = Some(due.map_or(wanted, |due| due.min(wanted)));
        if due.is_some_and(|due| due <= now) {
            files.keep_edits().await;
            tui.draw(&state)?;
            drawn = Instant::now();
            due = None;
        }
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
