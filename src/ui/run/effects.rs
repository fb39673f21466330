//! Carries out effects. The answers of the session, the files and the forecasts come back over one channel, as messages.

use std::io;

use crossterm::clipboard::CopyToClipboard;
use crossterm::execute;
use tokio::sync::mpsc;

use super::{SessionLink, flights};
use crate::lookahead::{ForecastReply, Forecaster, SurveyNews, SurveyReply, Surveyor, VehicleCopy};
use crate::session::{Command, ReplyTo};
use crate::sim::WorldCommand;
use crate::timeline::RecordedFlight;
use crate::ui::files_link::FilesLink;
use crate::ui::model::effect::{Effect, FlightForm};
use crate::ui::model::files::FileReply;
use crate::ui::model::message::Msg;

/// The channel of all answers.
#[derive(Debug, Clone)]
pub(super) struct Answers(mpsc::UnboundedSender<Msg>);

impl Answers {
    pub(super) fn channel() -> (Self, mpsc::UnboundedReceiver<Msg>) {
        let (sender, receiver) = mpsc::unbounded_channel();
        (Self(sender), receiver)
    }

    /// Returns the receiver of the forecaster's replies.
    pub(super) fn of_forecasts(&self) -> impl FnMut(ForecastReply) + Send + 'static + use<> {
        let answers = self.clone();
        move |reply| answers.send(Msg::Forecast(reply))
    }

    /// Returns the receiver of the surveyor's replies.
    pub(super) fn of_surveys(&self) -> impl FnMut(SurveyReply) + Send + 'static + use<> {
        let answers = self.clone();
        move |reply| answers.send(Msg::Survey(reply))
    }

    pub(super) fn send(&self, msg: Msg) {
        // The loop that receives it may have ended.
        self.0.send(msg).ok();
    }

    /// Returns a reply that sends its answer as a message.
    fn reply<T>(&self, message: impl FnOnce(Option<T>) -> Msg + Send + 'static) -> ReplyTo<T> {
        let answers = self.clone();
        ReplyTo::new(move |answer| answers.send(message(answer)))
    }

    /// Returns a reply that can be a refusal. `missing` is the refusal in place of a missing answer.
    fn result<T: 'static>(
        &self,
        missing: &'static str,
        message: impl FnOnce(Result<T, String>) -> Msg + Send + 'static,
    ) -> ReplyTo<Result<T, String>> {
        self.reply(move |answer| message(answer.unwrap_or_else(|| Err(missing.to_owned()))))
    }
}

/// The threads that fly copies of the vehicle.
#[derive(Debug)]
pub(super) struct Threads {
    forecaster: Forecaster,
    surveyor: Surveyor,
}

impl Threads {
    /// Starts them.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub(super) fn start(answers: &Answers) -> io::Result<Self> {
        let forecaster = Forecaster::start(answers.of_forecasts())?;
        Ok(Self { forecaster, surveyor: Surveyor::start(answers.of_surveys())? })
    }
}

/// Carries out an effect; answers come back as messages. Returns `true` if the session gets a command.
pub(super) fn carry_out(
    effect: Effect,
    link: &SessionLink,
    threads: &Threads,
    files: &mut FilesLink,
    answers: &Answers,
) -> bool {
    const MISSING: &str = "the session did not answer.";
    let command = match effect {
        Effect::Files(request) => {
            if !files.ask(request) {
                let gone = "Plan files cannot be read or written any more: restart the program.".to_owned();
                answers.send(Msg::Files(FileReply::Failed(gone)));
            }
            return false;
        }
        Effect::Copy(text) => {
            // Terminals without this feature show nothing; the editor keeps its own copy.
            execute!(io::stdout(), CopyToClipboard::to_clipboard_from(text)).ok();
            return false;
        }
        Effect::ListFlights { after } => {
            flights::list(link.shelf.clone(), after, answers.clone());
            return false;
        }
        Effect::DeleteFlight(file) => {
            flights::delete(link.shelf.clone(), file, answers.clone());
            return false;
        }
        // These need the terminal.
        Effect::ShowFlights { .. } | Effect::Redraw | Effect::Suspend | Effect::Quit => return false,
        Effect::Send(command) => command,
        Effect::Cli(line) => Command::Cli { line, reply: answers.reply(Msg::CliReply) },
        Effect::ReadSettings => Command::ReadSettings { reply: answers.result(MISSING, Msg::SettingsReply) },
        Effect::Set(line) => {
            let set = line.clone();
            Command::Cli { line, reply: answers.reply(|output| Msg::SetReply { line: set, output }) }
        }
        Effect::World(line) => {
            let parsed = WorldCommand::parse(&line).map_err(|error| error.to_string());
            let message = |result| Msg::WorldReply { line, result };
            let reply = answers.result("The session did not answer.", message);
            match parsed {
                Ok(change) => Command::World { change: Box::new(change), reply },
                Err(problem) => {
                    reply.send(Err(problem));
                    return false;
                }
            }
        }
        Effect::Upload { id, name, plan, settings } => {
            let count = plan.waypoints.len();
            let message = move |result| Msg::UploadReply { id, count, result };
            Command::Upload { name, plan, settings, reply: answers.result(MISSING, message) }
        }
        Effect::Download(id) => {
            let message = move |result| Msg::DownloadReply { id, result };
            Command::Download { reply: answers.result(MISSING, message) }
        }
        Effect::SaveToFlash => Command::Save { reply: answers.result(MISSING, Msg::SaveReply) },
        Effect::WriteFlight { form, file, plan } => {
            let failed = "the flight could not be flown again.";
            let written =
                answers.result(failed, move |result| Msg::FlightWritten { what: form.word(), result });
            let write = match form {
                FlightForm::Scenario => link.write_scenario,
                FlightForm::Log => link.write_log,
            };
            let (reply, recorded) = ReplyTo::<Result<Box<RecordedFlight>, String>>::channel();
            tokio::spawn(async move {
                let recorded = recorded.await.unwrap_or_else(|_| Err(MISSING.to_owned()));
                // This flies the flight again, which takes a while.
                tokio::task::spawn_blocking(move || {
                    written.send(recorded.and_then(|recorded| write(file, &plan, *recorded)));
                });
            });
            Command::RecordedFlight(reply)
        }
        Effect::Curves(request) => {
            let asked = request.clone();
            let message = |result| Msg::Curves { request: asked, result };
            Command::Curves { request, reply: answers.result(MISSING, message) }
        }
        Effect::WriteRecording { file, plan } => {
            let written = answers.result("the flight could not be recorded.", |result| Msg::FlightWritten {
                what: "recording",
                result,
            });
            let write = link.write_recording;
            let (reply, copied) = ReplyTo::<Result<Vec<u8>, String>>::channel();
            tokio::spawn(async move {
                let copied = copied.await.unwrap_or_else(|_| Err(MISSING.to_owned()));
                // A disk may be slow.
                tokio::task::spawn_blocking(move || {
                    written.send(copied.and_then(|bytes| write(file, &plan, &bytes)));
                });
            });
            Command::CopyRecording(reply)
        }
        Effect::Forecast(job) => {
            let (forecaster, answers) = (threads.forecaster.clone(), answers.clone());
            let continues = job.request.continues();
            let reply = ReplyTo::new(move |copy: Option<Result<VehicleCopy, String>>| match copy {
                Some(Ok(copy)) => forecaster.order(job, copy),
                Some(Err(reason)) => {
                    let (revision, kind) = (job.revision, job.request.kind());
                    answers.send(Msg::Forecast(ForecastReply { revision, kind, forecast: Err(reason) }));
                }
                // The session ends.
                None => {}
            });
            Command::CopyVehicle { continues, reply }
        }
        Effect::Survey(job) => {
            threads.surveyor.want(job.revision);
            let (surveyor, answers) = (threads.surveyor.clone(), answers.clone());
            let reply = ReplyTo::new(move |copy: Option<Result<VehicleCopy, String>>| match copy {
                Some(Ok(copy)) => surveyor.order(job, copy),
                Some(Err(reason)) => {
                    let news = SurveyNews::Refused(reason);
                    answers.send(Msg::Survey(SurveyReply { revision: job.revision, news }));
                }
                // The session ends.
                None => {}
            });
            Command::CopyVehicle { continues: false, reply }
        }
        Effect::EndSurvey(revision) => {
            threads.surveyor.want(revision);
            return false;
        }
    };
    // A command that is not delivered is dropped after this message.
    let is_delivered = link.commands.try_send(command).is_ok();
    if !is_delivered {
        answers.send(Msg::Busy);
    }
    is_delivered
}
