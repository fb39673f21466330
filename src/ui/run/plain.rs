//! The user interface without a screen: events as sentences, one per line, and commands of the `:` line as input.

use std::io::{self, ErrorKind, Write};
use std::time::Instant;

use tokio::sync::mpsc;

use super::effects::{Answers, Threads, carry_out};
use super::{Ending, SessionLink, flights, second_flight};
use crate::flight::forecast::ForecastKind;
use crate::session::Command;
use crate::ui::app_state::AppState;
use crate::ui::files_link::FilesLink;
use crate::ui::formatting::clock_ms;
use crate::ui::model::config::UiConfig;
use crate::ui::model::editor::{EditorPopup, Question};
use crate::ui::model::effect::Effect;
use crate::ui::model::files::{FileReply, FileRequest};
use crate::ui::model::message::Msg;
use crate::ui::update::update;
use lines::Lines;

mod lines;

/// The screen size that the state assumes; nothing is drawn.
const SIZE: (u16, u16) = (80, 24);

/// Runs until a command or `stop` ends it. At the end of the input the flight goes on, as in `serve`. A line of input
/// waits for the answers to the one before. An error in place of a line is a sentence to write.
///
/// # Errors
/// Returns an error if the output cannot be written. A reader that went away is an ordinary end.
pub async fn run_plain(
    link: SessionLink,
    files: FilesLink,
    config: UiConfig,
    input: mpsc::UnboundedReceiver<Result<String, String>>,
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
    mut config: UiConfig,
    mut input: mpsc::UnboundedReceiver<Result<String, String>>,
    output: impl Write,
    stop: impl Future<Output = ()>,
) -> io::Result<Ending> {
    let started = Instant::now();
    let mut stop = std::pin::pin!(stop);
    let mut lines = Lines::new(output);
    let view = link.view.borrow_and_update().clone();
    config.keymap = config.keymap.without_a_screen();
    let mut state = AppState::new(config, SIZE, view);
    let (answers, mut replies) = Answers::channel();
    let threads = Threads::start(&answers)?;
    let (mut awaited, mut events) = (0_usize, 0);
    let mut has_ended = false;
    let ending = loop {
        let effects = tokio::select! {
            biased;
            () = &mut stop => break Ending::Signal,
            Some(msg) = replies.recv() => {
                awaited = awaited.saturating_sub(usize::from(is_answer(&msg)));
                lines.answer(&mut state, msg)?
            }
            Some(reply) = files.replies.recv() => {
                let msg = Msg::Files(reply);
                awaited = awaited.saturating_sub(usize::from(is_answer(&msg)));
                lines.answer(&mut state, msg)?
            }
            Some(msg) = second_flight(&mut link.other) => lines.answer(&mut state, msg)?,
            event = link.events.recv() => match event {
                None => break Ending::SessionEnded,
                Some(event) => {
                    events += 1;
                    let text = (state.sentence)(&event);
                    if !text.is_empty() {
                        let text = state.shared.keymap.in_force(&text);
                        lines.write(&format!("{} {text}", clock_ms(event.time)))?;
                    }
                    let effects = update(&mut state, Msg::Event(event));
                    // The notice has the same sentence.
                    state.shared.notice = None;
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
            // A line must not act on the state before an event that its writer has read.
            line = input.recv(), if awaited == 0
                && !has_ended
                && state.shared.view.events_sent >= events
                && !is_reading(&state) =>
            {
                update(&mut state, Msg::Clock(started.elapsed()));
                match line {
                    None => {
                        has_ended = true;
                        Vec::new()
                    }
                    Some(Ok(line)) => lines.enter(&mut state, &line)?,
                    Some(Err(sentence)) => {
                        lines.write(&sentence)?;
                        Vec::new()
                    }
                }
            }
        };
        lines.follow(&mut state)?;
        // After the end of the input a flight goes on. A recorded one is over once its events are written.
        let is_over = awaited == 0 && link.other.is_none() && link.events.is_empty() && is_read(&state);
        // Nobody answers the question about unsaved edits any more. They are kept for the next start, if edits are kept.
        if has_ended && (is_over || awaited == 0 && asks_before_it_quits(&state)) {
            break Ending::Quit;
        }
        if effects.iter().any(|effect| matches!(effect, Effect::Quit)) {
            break Ending::Quit;
        }
        for effect in effects {
            match effect {
                Effect::Redraw | Effect::Suspend => {}
                Effect::Copy(text) => lines.write(&text)?,
                Effect::ShowFlights { files, again } => {
                    lines.write(&flights::command(&link, &files, again))?;
                }
                Effect::EndSurvey(_) => {
                    awaited = awaited.saturating_sub(1);
                    carry_out(effect, &link, &threads, &mut files, &answers);
                }
                effect => {
                    awaited += usize::from(is_question(&effect));
                    carry_out(effect, &link, &threads, &mut files, &answers);
                }
            }
        }
    };
    files.keep_edits().await;
    link.commands.try_send(Command::Quit).ok();
    Ok(ending)
}

/// Returns `true` while a recorded flight is read.
fn is_reading(state: &AppState) -> bool {
    state.shared.view.replay.as_ref().is_some_and(|replay| replay.reading.is_some())
}

/// Returns `true` if `quit` waits for an answer about unsaved edits.
fn asks_before_it_quits(state: &AppState) -> bool {
    let question = state.shared.editor.popup.as_ref();
    matches!(question, Some(EditorPopup::Question(Question::Unsaved { quits: true, .. })))
}

/// Returns `true` if a recorded flight is shown that was read to its end.
fn is_read(state: &AppState) -> bool {
    state.shared.view.replay.as_ref().is_some_and(|replay| replay.reading.is_none())
}

/// Returns `true` if a message answers the effect. The next line is read only after that answer.
fn is_question(effect: &Effect) -> bool {
    match effect {
        Effect::Cli(_)
        | Effect::Set(_)
        | Effect::World(_)
        | Effect::Upload { .. }
        | Effect::Download(_)
        | Effect::WriteFlight { .. }
        | Effect::WriteRecording { .. }
        | Effect::DeleteFlight(_)
        | Effect::SaveToFlash
        | Effect::ReadSettings
        | Effect::Survey(_) => true,
        Effect::ListFlights { after } => after.is_zero(),
        Effect::Files(request) => {
            matches!(
                request,
                FileRequest::Open { .. }
                    | FileRequest::Save { .. }
                    | FileRequest::ReadDisk { .. }
                    | FileRequest::SaveSettings { .. }
                    | FileRequest::List(_)
                    | FileRequest::Backdrop(..)
            )
        }
        Effect::Forecast(job) => job.request.kind() != ForecastKind::PlanEstimate,
        Effect::Send(_)
        | Effect::EndSurvey(_)
        | Effect::Curves(_)
        | Effect::ShowFlights { .. }
        | Effect::Copy(_)
        | Effect::Redraw
        | Effect::Suspend
        | Effect::Quit => false,
    }
}

/// Returns `true` if the message is such an answer.
fn is_answer(msg: &Msg) -> bool {
    match msg {
        Msg::CliReply(_)
        | Msg::SetReply { .. }
        | Msg::SettingsReply(_)
        | Msg::WorldReply { .. }
        | Msg::UploadReply { .. }
        | Msg::DownloadReply { .. }
        | Msg::SaveReply(_)
        | Msg::FlightWritten { .. }
        | Msg::FlightDeleted { .. }
        | Msg::Flights(_)
        | Msg::Busy => true,
        Msg::Forecast(reply) => reply.kind != ForecastKind::PlanEstimate,
        Msg::Survey(reply) => reply.news.is_last(),
        Msg::Files(reply) => !matches!(
            reply,
            FileReply::Changed(_)
                | FileReply::NotKept(_)
                | FileReply::KeptAgain
                | FileReply::NotRecorded(_)
                | FileReply::EditsLost(_)
                | FileReply::Ground { .. }
                | FileReply::Backdrop { is_new: false, .. }
        ),
        Msg::Clock(_)
        | Msg::Key(_)
        | Msg::Mouse(_)
        | Msg::Paste(_)
        | Msg::Resize(..)
        | Msg::View(_)
        | Msg::OtherFlight { .. }
        | Msg::FlightsShown(_)
        | Msg::Curves { .. }
        | Msg::Event(_) => false,
    }
}
