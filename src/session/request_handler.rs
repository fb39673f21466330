//! Passes the requests of the links to the flight controller between two steps, and returns the answers. A
//! remote flight controller answers later, by ticket.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use tokio::sync::oneshot;

use super::host_status::HostStatus;
use super::late_answers::{LateAnswers, no_answer_line};
use super::persistence::Persistence;
use crate::events::Notice;
use crate::firmware::cli::{COMMANDS, CliAction, CliMode, CliReply, complete};
use crate::firmware::msp::{MspAction, Outcome, UtcTime, flash_reply};
use crate::link::proto::command_line::{AfterLine, Completion, LineReply, LineSource};
use crate::link::{ClientId, Request, RestartSignal};
use crate::signals::{RcFrame, RcSource};
use crate::vehicle::{
    Answer, CliSession, FlightController, LateAnswer, Message, Reply, Ticket, Vehicle, VehicleCommand,
};

/// The wall time for which a frame from a script counts as fresh.
const RC_FRESH: Duration = Duration::from_millis(150);

/// The effects of a request besides the answer.
#[derive(Debug, Default)]
pub struct Handled {
    /// Sentences for the user.
    pub notices: Vec<Notice>,
    /// `true` if the flight controller restarts.
    pub restarted: bool,
    /// A datagram from a simulator, which is not meant for the flight controller, with its time of arrival.
    pub fdm: Option<(Vec<u8>, Instant)>,
}

/// The newest frame of a source that uses a socket.
#[derive(Debug, Clone, Copy)]
struct ReceivedRc {
    frame: RcFrame,
    at: Instant,
}

/// A client that waits for the answer of a remote flight controller.
#[derive(Debug)]
enum WaitingClient {
    /// Waits for the answer to an MSP message.
    Message(oneshot::Sender<Option<Vec<u8>>>),
    /// Waits for the answer to a line of the command line.
    Line(oneshot::Sender<LineReply>),
}

/// Handles the requests of the links.
#[derive(Debug)]
pub struct RequestHandler {
    restart_signal: RestartSignal,
    late_answers: LateAnswers<WaitingClient>,
    clock: Option<(UtcTime, Instant)>,
    udp: Option<ReceivedRc>,
    msp: Option<ReceivedRc>,
    /// The clients at a command line, with `true` for a person, which blocks arming.
    cli_sessions: BTreeMap<ClientId, bool>,
    /// The last client whose command line turned motors on the bench.
    bench: Option<ClientId>,
    reported_altitude_units: bool,
    host: HostStatus,
}

impl RequestHandler {
    /// Creates a handler that sends `restart_signal` when the flight controller restarts.
    pub fn new(restart_signal: RestartSignal) -> Self {
        Self {
            restart_signal,
            late_answers: LateAnswers::default(),
            clock: None,
            udp: None,
            msp: None,
            cli_sessions: BTreeMap::new(),
            bench: None,
            reported_altitude_units: false,
            host: HostStatus::default(),
        }
    }

    /// Sets the figures that `status` shows besides those of the firmware.
    pub(super) fn set_host_status(&mut self, host: HostStatus) {
        self.host = host;
    }

    /// Handles a request at `now`.
    pub fn handle(
        &mut self,
        request: Request,
        vehicle: &mut Vehicle,
        persistence: &mut Persistence,
        now: Instant,
    ) -> Handled {
        let mut handled = Handled::default();
        match request {
            Request::Msp { code, payload, reply, .. } => {
                let message = Message { code, payload, clock: self.clock_at(now) };
                vehicle.set_flash_facts(persistence.logs().flash().facts());
                match vehicle.apply(&message.into()) {
                    Answer::Now(Reply::Message(outcome)) => {
                        let payload = self.act_on_message(outcome, vehicle, persistence, now, &mut handled);
                        answer(reply, payload);
                    }
                    Answer::Now(_) => {}
                    Answer::Later(ticket) => {
                        self.late_answers.expect(ticket, WaitingClient::Message(reply), now);
                    }
                }
            }
            Request::EnterCli { client, interactive, reply } => {
                let admitted = !vehicle.controller().is_armed();
                if admitted {
                    self.enter_cli(client, interactive, vehicle);
                }
                answer(reply, admitted);
            }
            Request::Cli { client, line, source, reply } => {
                let session = self.session_of(client, source);
                match vehicle.apply(&VehicleCommand::line(session, line)) {
                    Answer::Now(Reply::Line(mut said)) => {
                        self.host.add_to(&mut said);
                        self.act_on_line(client, &mut said, vehicle, persistence, &mut handled);
                        answer(reply, said.into());
                    }
                    Answer::Now(_) => {}
                    Answer::Later(ticket) => {
                        self.late_answers.expect(ticket, WaitingClient::Line(reply), now);
                    }
                }
            }
            Request::Ignored { word, .. } => {
                handled
                    .notices
                    .extend(ignored_in_flight(&word, vehicle.controller()).into_iter().map(Notice::from));
            }
            Request::Complete { line, reply } => answer(reply, completion(&line)),
            Request::LeftCli { client } => {
                self.cli_sessions.remove(&client);
                vehicle.apply(&VehicleCommand::EndCli(CliSession::Client(client.0)));
                // Motors that another client turns keep turning.
                if self.bench.take_if(|bench| *bench == client).is_some() {
                    vehicle.apply(&VehicleCommand::CliClosed);
                }
            }
            // The command line was opened before the craft was armed. A restart in flight would make it fall.
            Request::Restart if vehicle.controller().armed() != Some(false) => {}
            Request::Restart => self.restart(true, vehicle, persistence, &mut handled),
            Request::Rc { frame, at, .. } => {
                self.udp = Some(ReceivedRc { frame, at });
                vehicle.apply(&VehicleCommand::Rc(frame, RcSource::Udp));
            }
            Request::Fdm { datagram, at, .. } => handled.fdm = Some((datagram, at)),
            Request::Notice(text) => handled.notices.push(text.into()),
        }
        handled
    }

    /// Passes a late answer to the client that waits for it.
    pub fn deliver(&mut self, ticket: Ticket, late: LateAnswer) {
        match (self.late_answers.take(ticket), late) {
            (Some(WaitingClient::Message(reply)), LateAnswer::Msp(payload)) => answer(reply, payload),
            (Some(WaitingClient::Line(reply)), LateAnswer::Cli(said)) => answer(reply, said.into()),
            // The answer belongs to a request that was given up, or has another type.
            _ => {}
        }
    }

    /// Refuses the requests whose answers are overdue.
    pub fn give_up_overdue(&mut self, now: Instant) {
        for recipient in self.late_answers.take_overdue(now) {
            match recipient {
                WaitingClient::Message(reply) => answer(reply, None),
                WaitingClient::Line(reply) => {
                    let text = no_answer_line();
                    answer(reply, LineReply { text, refused: true, ..LineReply::default() });
                }
            }
        }
    }

    fn enter_cli(&mut self, client: ClientId, interactive: bool, vehicle: &mut Vehicle) {
        let mode = if interactive { CliMode::Interactive } else { CliMode::Framed };
        self.cli_sessions.insert(client, interactive);
        vehicle.apply(&VehicleCommand::BeginCli(CliSession::Client(client.0), mode));
        if interactive {
            vehicle.apply(&VehicleCommand::CliOpened);
        }
    }

    /// Returns the session of a client's line. A message is a session of its own, and so is a line that was in
    /// progress when a restart ended the client's session.
    fn session_of(&self, client: ClientId, source: LineSource) -> CliSession {
        match source {
            LineSource::Message => CliSession::Single(CliMode::Message),
            _ if self.cli_sessions.contains_key(&client) => CliSession::Client(client.0),
            LineSource::Prompt => CliSession::Single(CliMode::Interactive),
            LineSource::Framed => CliSession::Single(CliMode::Framed),
        }
    }

    /// Carries out the action of a message and returns the payload of the reply. Links are closed before the
    /// reply goes out, so a client that reconnects after it is a new one.
    fn act_on_message(
        &mut self,
        outcome: Outcome,
        vehicle: &mut Vehicle,
        persistence: &mut Persistence,
        now: Instant,
        handled: &mut Handled,
    ) -> Option<Vec<u8>> {
        match outcome.action {
            Some(MspAction::Save) => {
                if let Err(notice) = persistence.save(vehicle) {
                    handled.notices.push(Notice::warning(notice));
                    return None;
                }
            }
            Some(MspAction::Reboot) => self.restart(true, vehicle, persistence, handled),
            Some(MspAction::SaveAndReboot) => {
                if let Err(notice) = persistence.save(vehicle) {
                    handled.notices.push(Notice::warning(notice));
                    return None;
                }
                self.restart(true, vehicle, persistence, handled);
            }
            Some(MspAction::SetClock { unix_s, millis }) => {
                self.clock = Some((UtcTime { unix_s, millis }, now));
            }
            Some(MspAction::ReadFlash { address, length }) => {
                let bytes = persistence.logs().flash().read(address as usize, length.into());
                return Some(flash_reply(address, bytes));
            }
            Some(MspAction::EraseFlash) => persistence.logs().erase_flash(),
            // The firmware has used it. From here on it ages in wall time.
            Some(MspAction::RawRc(frame)) => {
                self.msp = Some(ReceivedRc { frame, at: now });
            }
            // The firmware itself has carried these out.
            Some(
                MspAction::RawGps { .. }
                | MspAction::MotorTest(_)
                | MspAction::CalibrateAcc
                | MspAction::CalibrateMag
                | MspAction::HoldHeading(_)
                | MspAction::RunawayPrevention(_),
            )
            | None => {}
        }
        outcome.reply
    }

    /// Carries out the actions of a line. If saving fails, the answer becomes a refusal.
    fn act_on_line(
        &mut self,
        client: ClientId,
        said: &mut CliReply,
        vehicle: &mut Vehicle,
        persistence: &mut Persistence,
        handled: &mut Handled,
    ) {
        for action in &said.actions {
            match *action {
                CliAction::PlanChanged if !self.reported_altitude_units => {
                    self.reported_altitude_units = true;
                    handled.notices.push("Waypoint altitudes are above home, in centimetres.".into());
                }
                CliAction::MotorTest { .. } => self.bench = Some(client),
                CliAction::Save | CliAction::Restart { .. } | CliAction::PlanChanged | CliAction::Leave => {}
            }
        }
        let done = persistence.carry_out(said, vehicle);
        handled.notices.extend(done.notices);
        if let Some(close_links) = done.restarted {
            handled.restarted = true;
            self.after_restart(close_links, vehicle);
        }
    }

    fn restart(
        &mut self,
        close_links: bool,
        vehicle: &mut Vehicle,
        persistence: &mut Persistence,
        handled: &mut Handled,
    ) {
        handled.notices.extend(persistence.restart(vehicle));
        handled.restarted = true;
        self.after_restart(close_links, vehicle);
    }

    /// Updates the clients' sessions after a restart of the flight controller. Closes the links. If the links
    /// stay open, clients at a command line block arming as before.
    pub fn after_restart(&mut self, close_links: bool, vehicle: &mut Vehicle) {
        (self.udp, self.msp, self.bench) = (None, None, None);
        if close_links {
            // The end of the link is the answer. A line that caused the restart still gets its own.
            self.late_answers.retain(|waiting| !matches!(waiting, WaitingClient::Message(_)));
            self.cli_sessions.clear();
            vehicle.apply(&VehicleCommand::EndAllCli);
            self.restart_signal.send();
        } else if self.cli_sessions.values().any(|interactive| *interactive) {
            vehicle.apply(&VehicleCommand::CliOpened);
        }
    }

    /// Keeps RC from sockets alive while simulated time runs `speed` times faster than the wall clock. A
    /// script sends 50 frames per second of wall time, and the flight controller would detect a loss. Call
    /// this about every 20 ms of simulated time.
    pub fn keep_rc_fresh(&self, vehicle: &mut Vehicle, speed: f64, now: Instant) {
        if speed <= 1.0 {
            return;
        }
        // The receiver itself detects a loss after the same amount of simulated time.
        let still_fresh = RC_FRESH.mul_f64(1.0 - 1.0 / speed);
        for (source, heard) in [(RcSource::Udp, self.udp), (RcSource::Msp, self.msp)] {
            if let Some(ReceivedRc { frame, at }) = heard
                && now.saturating_duration_since(at) < still_fresh
            {
                vehicle.apply(&VehicleCommand::Rc(frame, source));
            }
        }
    }

    /// Returns the time of day if a client has set it.
    fn clock_at(&self, now: Instant) -> Option<UtcTime> {
        let (set, at) = self.clock?;
        let millis = u128::from(set.millis) + now.saturating_duration_since(at).as_millis();
        Some(UtcTime {
            unix_s: set.unix_s.wrapping_add((millis / 1000) as u32),
            millis: (millis % 1000) as u16,
        })
    }
}

impl From<CliReply> for LineReply {
    fn from(reply: CliReply) -> Self {
        let has = |action| reply.actions.contains(&action);
        let then = if has(CliAction::Restart { close_links: true }) {
            AfterLine::Close
        } else if has(CliAction::Leave) {
            AfterLine::Leave
        } else {
            AfterLine::Stay
        };
        Self { text: reply.text, refused: reply.failed, then }
    }
}

/// Returns the reason why a client got no answer to lines that begin with this word, if it is a command and
/// the craft is armed.
fn ignored_in_flight(word: &str, controller: &FlightController) -> Option<String> {
    let command = COMMANDS.iter().find(|command| command.name.eq_ignore_ascii_case(word))?;
    controller.is_armed().then(|| {
        format!(
            "A program at a door sent command lines (`{}` first) while the craft is armed: they were ignored without \
             an answer, because the command line does not open in flight. Send them again after the landing, or \
             type them in the CLI panel of the screen.",
            command.name
        )
    })
}

/// Returns the completion of a line being typed.
fn completion(line: &str) -> Completion {
    let found = complete(line);
    Completion { tail: found.tail(line).to_owned(), words: found.candidates }
}

/// Sends an answer. A client that has disconnected needs none.
fn answer<T>(reply: oneshot::Sender<T>, value: T) {
    drop(reply.send(value));
}
