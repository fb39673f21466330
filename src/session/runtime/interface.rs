//! The requests of the user interface to the flight controller: its command line, uploads, downloads, saving. A remote
//! flight controller answers them later, by ticket.

use std::time::Instant;

use crate::events::Notice;
use crate::fc::{CraftSettings, LIST, Upload, UploadProgress, UploadReport, UploadView, plan_above_home};
use crate::firmware::cli::{CliAction, CliReply, advice};
use crate::flight::{hazards, setup::replace_settings};
use crate::msp::code;
use crate::plan::{AltitudeReference, FlightPlan};
use crate::session::ReplyTo;
use crate::session::command::CliOutput;
use crate::session::host_status::HostStatus;
use crate::session::late_answers::{LateAnswers, NO_ANSWER, no_answer_line};
use crate::session::persistence::Persistence;
use crate::session::request_handler::RequestHandler;
use crate::telemetry::FirmwareProfile;
use crate::text::printable;
use crate::vehicle::{
    Answer, CliSession, LateAnswer, Message, Reply as VehicleReply, Ticket, Vehicle, VehicleCommand,
};

/// The line that prints all settings.
const GET: &str = "get";

/// A reply that can be a refusal, as a sentence.
type Reply<T> = ReplyTo<Result<T, String>>;

/// The user interface's side of the flight controller.
#[derive(Debug, Default)]
pub(super) struct Interface {
    /// The figures that `status` shows besides those of the flight controller.
    pub(super) host: HostStatus,
    late_answers: LateAnswers<Waiting>,
}

/// A request that waits for the answer of a remote flight controller.
#[derive(Debug)]
enum Waiting {
    Line {
        /// The line that was run.
        line: String,
        reply: ReplyTo<CliOutput>,
    },
    Download(Reply<Box<FlightPlan>>),
    Settings(Reply<Box<CraftSettings>>),
    /// Receives `Ok` once the configuration is stored.
    Save(Reply<()>),
    /// An upload, which continues with the answer.
    Upload(Box<Upload>, Reply<UploadReport>),
}

impl Interface {
    /// Runs a line. `handler` closes the clients' links if the line restarts the
    /// flight controller.
    pub(super) fn run_line(
        &mut self,
        line: String,
        reply: ReplyTo<CliOutput>,
        vehicle: &mut Vehicle,
        persistence: &mut Persistence,
        handler: Option<&mut RequestHandler>,
    ) -> Outcome {
        let mut answer = match vehicle.apply(&VehicleCommand::line(CliSession::Console, &line)) {
            Answer::Now(VehicleReply::Line(answer)) => answer,
            Answer::Now(_) => return Outcome::default(),
            Answer::Later(ticket) => {
                self.late_answers.expect(ticket, Waiting::Line { line, reply }, now());
                return Outcome::default();
            }
        };
        self.host.add_to(&mut answer);
        let done = persistence.carry_out(&mut answer, vehicle);
        if done.restarted.is_some() {
            restart_console(vehicle);
            if let Some(handler) = handler {
                handler.after_restart(true, vehicle);
            }
        }
        let output = output(&line, answer, done.restarted.is_some());
        Outcome::new(done.notices, move || reply.send(output))
    }

    /// Starts an upload. A craft that is only simulated gets gains with which it
    /// lands; a real one never gets gains that the user did not request.
    pub(super) fn upload(
        &mut self,
        plan: &FlightPlan,
        mut settings: Vec<String>,
        is_simulated: bool,
        reply: Reply<UploadReport>,
        craft: &mut UploadTo<'_>,
    ) -> Outcome {
        if craft.vehicle.embedded().is_some() {
            if craft.vehicle.controller().profile() == Some(FirmwareProfile::Master) {
                replace_settings(&mut settings);
            }
            let result = match craft.vehicle.apply(&VehicleCommand::upload(plan.clone(), settings)) {
                Answer::Now(VehicleReply::Refused(refusal)) => Err(refusal.to_string()),
                _ => Ok(UploadReport::default()),
            };
            return uploaded(result, reply, craft);
        }
        let reference = craft.vehicle.controller().altitude_reference();
        let replaced = match reference {
            AltitudeReference::SeaLevel { .. } if is_simulated => replace_settings(&mut settings),
            _ => Vec::new(),
        };
        match Upload::new(plan, &settings, reference) {
            Ok(mut upload) => {
                upload.report_replaced(replaced);
                let progress = upload.send_line(craft.vehicle);
                self.go_on(Box::new(upload), progress, reply, craft, now())
            }
            Err(unknown) => {
                reply.send(Err(unknown.to_string()));
                Outcome::default()
            }
        }
    }

    /// Returns the progress of the current upload.
    pub(super) fn upload_under_way(&self) -> Option<UploadView> {
        self.late_answers.recipients().find_map(|waiting| match waiting {
            Waiting::Upload(upload, _) => Some(upload.lines_sent()),
            Waiting::Line { .. } | Waiting::Download(_) | Waiting::Settings(_) | Waiting::Save(_) => None,
        })
    }

    /// Reads the plan of the craft as a ground station does.
    pub(super) fn download(&mut self, reply: Reply<Box<FlightPlan>>, vehicle: &mut Vehicle) {
        let reference = vehicle.controller().altitude_reference();
        match vehicle.apply(&VehicleCommand::single_line(LIST)) {
            Answer::Now(VehicleReply::Line(answer)) => {
                reply.send(plan_above_home(&answer, reference).map(Box::new));
            }
            Answer::Now(_) => {}
            Answer::Later(ticket) => self.late_answers.expect(ticket, Waiting::Download(reply), now()),
        }
    }

    /// Reads all settings: those of an embedded flight controller from its configuration, those of a remote one from
    /// its command line.
    pub(super) fn read_settings(
        &mut self,
        reply: Reply<Box<CraftSettings>>,
        vehicle: &mut Vehicle,
        persistence: &Persistence,
    ) {
        if let Some(configuration) = vehicle.controller().configuration() {
            let saved = persistence.after_restart();
            return reply.send(Ok(Box::new(CraftSettings::from_configuration(configuration, saved))));
        }
        if let Answer::Later(ticket) = vehicle.apply(&VehicleCommand::single_line(GET)) {
            self.late_answers.expect(ticket, Waiting::Settings(reply), now());
        }
    }

    /// Saves as a ground station does over MSP, without a restart. A remote flight controller stores its configuration
    /// itself.
    pub(super) fn save(
        &mut self,
        is_real: bool,
        reply: Reply<()>,
        vehicle: &mut Vehicle,
        persistence: &mut Persistence,
    ) {
        if vehicle.controller().is_armed() {
            let way = if is_real { "its transmitter disarms it" } else { "`a` disarms it" };
            reply.send(Err(format!("Not saved while the craft is armed: {way} on the ground.")));
        } else if vehicle.embedded().is_some() {
            reply.send(persistence.save(vehicle));
        } else if let Answer::Later(ticket) =
            vehicle.apply(&Message::of(code::EEPROM_WRITE, Vec::new()).into())
        {
            self.late_answers.expect(ticket, Waiting::Save(reply), now());
        }
    }

    /// Takes a late answer.
    ///
    /// # Errors
    /// Returns an answer that is not for the user interface.
    pub(super) fn take_answer(
        &mut self,
        ticket: Ticket,
        answer: LateAnswer,
        craft: &mut UploadTo<'_>,
        now: Instant,
    ) -> Result<Outcome, LateAnswer> {
        match (self.late_answers.take(ticket), answer) {
            (Some(Waiting::Line { line, reply }), LateAnswer::Cli(said)) => {
                // It has saved and restarted by itself.
                let restarted = said.actions.iter().any(|action| matches!(action, CliAction::Restart { .. }));
                reply.send(output(&line, said, restarted));
            }
            (Some(Waiting::Upload(mut upload, reply)), LateAnswer::Cli(said)) => {
                let progress = upload.take_answer(&said, craft.vehicle);
                return Ok(self.go_on(upload, progress, reply, craft, now));
            }
            (Some(Waiting::Download(reply)), LateAnswer::Cli(said)) => {
                let reference = craft.vehicle.controller().altitude_reference();
                reply.send(plan_above_home(&said, reference).map(Box::new));
            }
            (Some(Waiting::Settings(reply)), LateAnswer::Cli(said)) => reply.send(settings_of(&said)),
            (Some(Waiting::Save(reply)), LateAnswer::Msp(stored)) => {
                let refusal = || "Not saved: the flight controller refuses to store now.".to_owned();
                reply.send(stored.map(drop).ok_or_else(refusal));
            }
            (_, answer) => return Err(answer),
        }
        Ok(Outcome::default())
    }

    /// Refuses the requests whose answers are overdue.
    pub(super) fn give_up_overdue(&mut self, now: Instant) {
        for waiting in self.late_answers.take_overdue(now) {
            match waiting {
                Waiting::Line { reply, .. } => {
                    reply.send(CliOutput { text: no_answer_line(), ..CliOutput::default() });
                }
                Waiting::Download(reply) => reply.send(Err(NO_ANSWER.to_owned())),
                Waiting::Settings(reply) => reply.send(Err(NO_ANSWER.to_owned())),
                Waiting::Upload(_, reply) => reply.send(Err(NO_ANSWER.to_owned())),
                Waiting::Save(reply) => reply.send(Err(NO_ANSWER.to_owned())),
            }
        }
    }

    /// Waits for the next answer to an upload, or reports its result.
    fn go_on(
        &mut self,
        upload: Box<Upload>,
        progress: UploadProgress,
        reply: Reply<UploadReport>,
        craft: &mut UploadTo<'_>,
        now: Instant,
    ) -> Outcome {
        match progress {
            UploadProgress::Done(result) => uploaded(result, reply, craft),
            UploadProgress::Waiting(ticket) => {
                self.late_answers.expect(ticket, Waiting::Upload(upload, reply), now);
                Outcome::default()
            }
        }
    }
}

/// Returns the settings in the answer to [`GET`].
fn settings_of(said: &CliReply) -> Result<Box<CraftSettings>, String> {
    let settings = CraftSettings::from_get(&said.text);
    if said.failed || settings.all.is_empty() {
        let why =
            printable::line(said.text.trim().trim_matches('#').trim_start_matches("ERROR: ")).into_owned();
        return Err(format!("The settings cannot be read now: {}.", why.trim_end_matches('.')));
    }
    Ok(Box::new(settings))
}

/// The notices of a request for the user, and its answer, which follows them.
#[derive(Default)]
pub(super) struct Outcome {
    pub(super) notices: Vec<Notice>,
    /// Sends the answer, if it is known.
    pub(super) answer: Option<Box<dyn FnOnce()>>,
}

impl Outcome {
    fn new(notices: Vec<Notice>, answer: impl FnOnce() + 'static) -> Self {
        Self { notices, answer: Some(Box::new(answer)) }
    }
}

/// The craft of an upload.
pub(super) struct UploadTo<'a> {
    pub(super) vehicle: &'a mut Vehicle,
    /// The altitude to which the scripted pilot climbs, m.
    pub(super) takeoff_m: f64,
}

/// Reports the result of an upload, after the hazards of the plan.
fn uploaded(
    result: Result<UploadReport, String>,
    reply: Reply<UploadReport>,
    craft: &UploadTo<'_>,
) -> Outcome {
    let hazards = if result.is_ok() { hazards(craft.vehicle, craft.takeoff_m, None) } else { Vec::new() };
    Outcome::new(hazards.into_iter().map(Notice::from).collect(), move || reply.send(result))
}

/// Begins a new session of the command line, after a restart of the flight controller.
pub(super) fn restart_console(vehicle: &mut Vehicle) {
    vehicle.apply(&VehicleCommand::EndCli(CliSession::Console));
}

/// Returns the console's output for an answer.
pub(super) fn output(line: &str, answer: CliReply, restarted: bool) -> CliOutput {
    let advice = advice(line, &answer);
    CliOutput { text: answer.text, advice, restarted }
}

#[allow(clippy::disallowed_methods, reason = "a late answer is awaited in wall time")]
fn now() -> Instant {
    Instant::now()
}
