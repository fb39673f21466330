//! The user interface without a screen: what happens as sentences, one a line, and commands of the `:` line as input.

use std::io::{self, ErrorKind, Write};
use std::time::Instant;

use tokio::sync::mpsc;

use super::{Ending, SessionLink, carry_out};
use crate::printable;
use crate::session::{Command, Forecaster};
use crate::ui::action::{ACTIONS, Context};
use crate::ui::app_state::{AppState, UiConfig};
use crate::ui::command;
use crate::ui::files_link::FilesLink;
use crate::ui::message::{Effect, Msg};
use crate::ui::popup::Popup;
use crate::ui::update::update;

/// The size that the state believes in; nothing is drawn.
const SIZE: (u16, u16) = (80, 24);

/// Runs until a command or `stop` ends it; when the input ends the flight goes on, as in `serve`. A line of input waits
/// for the answers to the one before.
///
/// # Errors
/// The output cannot be written; a reader that went away is an ordinary end.
pub async fn run_plain(
    link: SessionLink,
    files: FilesLink,
    config: UiConfig,
    input: mpsc::UnboundedReceiver<String>,
    output: impl Write,
    stop: impl Future<Output = ()>,
) -> io::Result<Ending> {
    match run_loop(link, files, config, input, output, stop).await {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(Ending::Quit),
        ended => ended,
    }
}

async fn run_loop(
    mut link: SessionLink,
    mut files: FilesLink,
    config: UiConfig,
    mut input: mpsc::UnboundedReceiver<String>,
    output: impl Write,
    stop: impl Future<Output = ()>,
) -> io::Result<Ending> {
    let started = Instant::now();
    let mut stop = std::pin::pin!(stop);
    let mut lines = Lines(output);
    let view = link.view.borrow_and_update().clone();
    let mut state = AppState::new(config, SIZE, view);
    let (replies_in, mut replies) = mpsc::unbounded_channel();
    let forecasts = replies_in.clone();
    let forecaster = Forecaster::start(move |reply| drop(forecasts.send(Msg::Forecast(reply))))?;
    let mut awaited = 0_usize;
    let mut quit_asked = false;
    let ending = loop {
        let mut effects = tokio::select! {
            biased;
            () = &mut stop => break Ending::Signal,
            Some(msg) = replies.recv() => {
                if is_answer(&msg) {
                    awaited = awaited.saturating_sub(1);
                }
                lines.answer(&mut state, msg)?
            }
            Some(reply) = files.replies.recv() => update(&mut state, Msg::Files(reply)),
            event = link.events.recv() => match event {
                None => break Ending::SessionEnded,
                Some(event) => {
                    let text = (state.sentence)(&event);
                    if !text.is_empty() {
                        lines.write(&format!("{:>7.1} s  {text}", event.time.as_secs_f64()))?;
                    }
                    let effects = update(&mut state, Msg::Event(event));
                    // The same sentence.
                    state.notice = None;
                    effects
                }
            },
            changed = link.view.changed() => match changed {
                Ok(()) => {
                    let view = link.view.borrow_and_update().clone();
                    update(&mut state, Msg::View(view))
                }
                Err(_) => break Ending::SessionEnded,
            },
            Some(line) = input.recv(), if awaited == 0 => {
                update(&mut state, Msg::Clock(started.elapsed()));
                let effects = match command::run(&mut state, &line) {
                    Ok(effects) => effects,
                    Err(sentence) => {
                        lines.write(&sentence)?;
                        Vec::new()
                    }
                };
                let asked = lines.question(&mut state)?;
                if asked && quit_asked {
                    break Ending::Quit;
                }
                quit_asked = asked;
                effects
            }
        };
        if let Some(notice) = state.notice.take() {
            lines.write(&notice.text)?;
        }
        let is_end = |effect: &Effect| matches!(effect, Effect::Quit);
        if effects.iter().any(is_end) {
            break Ending::Quit;
        }
        for effect in effects.drain(..) {
            match effect {
                Effect::Suspend => {}
                Effect::Copy(text) => lines.write(&text)?,
                effect => {
                    let answers = matches!(effect, Effect::Cli(_) | Effect::World(_) | Effect::Upload { .. });
                    awaited += usize::from(answers);
                    carry_out(effect, &link, &forecaster, &mut files, &replies_in);
                }
            }
        }
    };
    files.keep_edits().await;
    link.commands.try_send(Command::Quit).ok();
    Ok(ending)
}

/// Whether a message is what a line of input waits for.
fn is_answer(msg: &Msg) -> bool {
    matches!(msg, Msg::CliReply(_) | Msg::WorldReply { .. } | Msg::UploadReply(_) | Msg::Busy)
}

/// The output, a sentence a line.
struct Lines<W>(W);

impl<W: Write> Lines<W> {
    fn write(&mut self, text: &str) -> io::Result<()> {
        writeln!(self.0, "{}", printable::line(text))?;
        self.0.flush()
    }

    /// Writes what the firmware answered as it is, and passes every answer on.
    fn answer(&mut self, state: &mut AppState, msg: Msg) -> io::Result<Vec<Effect>> {
        let Msg::CliReply(Some(output)) = &msg else { return Ok(update(state, msg)) };
        for line in output.text.trim_end().lines().chain(output.advice.as_deref()) {
            self.write(line.trim_end())?;
        }
        let effects = update(state, msg);
        state.notice = None;
        Ok(effects)
    }

    /// What a screen would ask in a popup: help is written, and whoever quits is told what would be lost. Whether it was
    /// that.
    fn question(&mut self, state: &mut AppState) -> io::Result<bool> {
        let popups = std::mem::take(&mut state.popups);
        let unsaved = state.editor.popup.is_some();
        state.editor.cancel();
        match popups.last() {
            Some(Popup::Quit) => {
                self.write("The craft is armed and flying ends here: quit once more to end.")?;
                return Ok(true);
            }
            Some(Popup::Help { .. }) => {
                for command in command::all() {
                    self.write(&format!("{} {} — {}", command.name, command.argument, command.help))?;
                }
                let everywhere = ACTIONS.iter().filter(|spec| spec.context == Context::Global);
                for spec in everywhere {
                    self.write(&format!("{} — {}", spec.name, spec.help))?;
                }
            }
            Some(_) => self.write("This is chosen on the screen: start without --plain.")?,
            None if unsaved => {
                self.write(
                    "This asks on the screen; quit once more to end, unsaved edits are kept for later.",
                )?;
                return Ok(true);
            }
            None => {}
        }
        Ok(false)
    }
}
