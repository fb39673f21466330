//! Answers the requests of the links from a firmware and its store, between two steps.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use tokio::sync::oneshot;

use super::persistence;
use crate::firmware::Firmware;
use crate::firmware::cli::{CliAction, CliReply, Interpreter, Mode, complete};
use crate::firmware::msp::{MspAction, UtcTime};
use crate::link::proto::command_line::{AfterLine, Completion, LineReply, LineSource};
use crate::link::{ClientId, Request, RestartBell};
use crate::signals::{RcFrame, RcSource};
use crate::storage::Store;

/// A frame from a script counts as fresh for this long of wall time.
const RC_FRESH: Duration = Duration::from_millis(150);

/// What handling a request led to, beyond the answer.
#[derive(Debug, Default)]
pub struct Handled {
    /// Sentences for the user.
    pub notices: Vec<String>,
    /// The firmware started anew.
    pub restarted: bool,
    /// A datagram from a simulator, which is not for the firmware, and when it came.
    pub fdm: Option<(Vec<u8>, Instant)>,
}

/// The newest frame of a source that comes through a socket.
#[derive(Debug, Clone, Copy)]
struct ReceivedRc {
    frame: RcFrame,
    at: Instant,
}

/// The command line of one client, from its entry until it is left.
#[derive(Debug)]
struct CliSession {
    interpreter: Interpreter,
    /// Of a person: blocks arming.
    interactive: bool,
}

/// Handles the requests of the links.
#[derive(Debug)]
pub struct RequestHandler {
    bell: RestartBell,
    starter_modes: bool,
    clock: Option<(UtcTime, Instant)>,
    udp: Option<ReceivedRc>,
    msp: Option<ReceivedRc>,
    cli_sessions: BTreeMap<ClientId, CliSession>,
    /// The client whose command line turned motors on the bench last.
    bench: Option<ClientId>,
    told_plan: bool,
}

impl RequestHandler {
    /// A handler that rings `bell` when the firmware starts anew. `starter_modes` gives a craft without mode conditions
    /// the usual ones at every start.
    #[must_use]
    pub fn new(bell: RestartBell, starter_modes: bool) -> Self {
        Self {
            bell,
            starter_modes,
            clock: None,
            udp: None,
            msp: None,
            cli_sessions: BTreeMap::new(),
            bench: None,
            told_plan: false,
        }
    }

    /// Whether a craft without mode conditions gets the usual ones at every start.
    pub(super) fn gives_starter_modes(&self) -> bool {
        self.starter_modes
    }

    /// Handles a request at `now`.
    pub fn handle(
        &mut self,
        request: Request,
        firmware: &mut Firmware,
        store: &mut Store,
        now: Instant,
    ) -> Handled {
        let mut handled = Handled::default();
        match request {
            Request::Msp { code, payload, reply, .. } => {
                let outcome = firmware.run_msp(code, &payload, self.clock_at(now));
                if outcome.action == Some(MspAction::Save)
                    && let Err(notice) = persistence::save(firmware, store)
                {
                    handled.notices.push(notice);
                    answer(reply, None);
                    return handled;
                }
                // Links are closed before the answer goes out: who comes back after it is a new client.
                self.act_on_message(outcome.action, firmware, store, now, &mut handled);
                answer(reply, outcome.reply);
            }
            Request::EnterCli { client, interactive, reply } => {
                let admitted = !firmware.is_armed();
                if admitted {
                    self.enter_cli(client, interactive, firmware);
                }
                answer(reply, admitted);
            }
            Request::Cli { client, line, source, reply } => {
                let said = self.run_line(client, source, &line, firmware);
                let restart = self.act_on_line(client, &said, firmware, store, &mut handled);
                if let Some(close_links) = restart {
                    self.restart(close_links, firmware, store, &mut handled);
                }
                answer(reply, said.into());
            }
            Request::Complete { line, reply } => answer(reply, completion(&line)),
            Request::LeftCli { client } => {
                self.cli_sessions.remove(&client);
                // Motors that somebody else turns go on.
                if self.bench.take_if(|bench| *bench == client).is_some() {
                    firmware.cli_closed();
                }
            }
            // The command line was opened before the craft was armed; it does not fall from the sky for that.
            Request::Restart { .. } if firmware.is_armed() => {}
            Request::Restart { .. } => self.restart(true, firmware, store, &mut handled),
            Request::Rc { frame, at, .. } => {
                self.udp = Some(ReceivedRc { frame, at });
                firmware.receive_rc(&frame, RcSource::Udp);
            }
            Request::Fdm { datagram, at, .. } => handled.fdm = Some((datagram, at)),
            Request::Notice(text) => handled.notices.push(text),
        }
        handled
    }

    fn enter_cli(&mut self, client: ClientId, interactive: bool, firmware: &mut Firmware) {
        let mode = if interactive { Mode::Interactive } else { Mode::Framed };
        self.cli_sessions.insert(client, CliSession { interpreter: Interpreter::new(mode), interactive });
        if interactive {
            firmware.cli_opened();
        }
    }

    /// Runs a line in the client's session. A message is a session of its own, and so is a line that was underway when a
    /// restart ended the client's.
    fn run_line(
        &mut self,
        client: ClientId,
        source: LineSource,
        line: &str,
        firmware: &mut Firmware,
    ) -> CliReply {
        let (mode, session) = match source {
            LineSource::Prompt => (Mode::Interactive, self.cli_sessions.get_mut(&client)),
            LineSource::Framed => (Mode::Framed, self.cli_sessions.get_mut(&client)),
            LineSource::Message => (Mode::Message, None),
        };
        match session {
            Some(session) => firmware.run_cli(&mut session.interpreter, line),
            None => firmware.run_cli(&mut Interpreter::new(mode), line),
        }
    }

    fn act_on_message(
        &mut self,
        action: Option<MspAction>,
        firmware: &mut Firmware,
        store: &mut Store,
        now: Instant,
        handled: &mut Handled,
    ) {
        match action {
            Some(MspAction::Reboot) => self.restart(true, firmware, store, handled),
            Some(MspAction::SaveAndReboot) => {
                handled.notices.extend(persistence::save(firmware, store).err());
                self.restart(true, firmware, store, handled);
            }
            Some(MspAction::SetClock { unix_s, millis }) => {
                self.clock = Some((UtcTime { unix_s, millis }, now));
            }
            // The firmware has used it; from here on it ages in wall time.
            Some(MspAction::RawRc(frame)) => {
                self.msp = Some(ReceivedRc { frame, at: now });
            }
            // The firmware itself has carried these out.
            Some(
                MspAction::Save
                | MspAction::RawGps { .. }
                | MspAction::MotorTest(_)
                | MspAction::CalibrateAcc
                | MspAction::CalibrateMag
                | MspAction::HoldHeading(_)
                | MspAction::RunawayPrevention(_),
            )
            | None => {}
        }
    }

    /// Does what a line asks for; a restart is left to the caller: whether it closes the links.
    fn act_on_line(
        &mut self,
        client: ClientId,
        said: &CliReply,
        firmware: &mut Firmware,
        store: &mut Store,
        handled: &mut Handled,
    ) -> Option<bool> {
        let mut restart = None;
        for action in &said.actions {
            match *action {
                CliAction::Save => handled.notices.extend(persistence::save(firmware, store).err()),
                CliAction::Restart { close_links } => restart = Some(close_links),
                CliAction::PlanChanged if !self.told_plan => {
                    self.told_plan = true;
                    handled.notices.push("Waypoint altitudes count from home, in centimetres.".to_owned());
                }
                CliAction::MotorTest { .. } => self.bench = Some(client),
                CliAction::PlanChanged | CliAction::Leave => {}
            }
        }
        restart
    }

    fn restart(
        &mut self,
        close_links: bool,
        firmware: &mut Firmware,
        store: &mut Store,
        handled: &mut Handled,
    ) {
        handled.notices.extend(persistence::restart(firmware, store, self.starter_modes));
        handled.restarted = true;
        self.after_restart(close_links, firmware);
    }

    /// Brings the clients' sessions up to date after the firmware started anew: closes the links, or, where they are kept,
    /// lets those who are at a command line block arming as before.
    pub fn after_restart(&mut self, close_links: bool, firmware: &mut Firmware) {
        (self.udp, self.msp, self.bench) = (None, None, None);
        if close_links {
            self.cli_sessions.clear();
            self.bell.ring();
        } else if self.cli_sessions.values().any(|session| session.interactive) {
            firmware.cli_opened();
        }
    }

    /// Keeps RC from sockets alive while simulated time runs `speed` times faster than the wall clock: a script sends
    /// 50 frames of wall time a second, and the firmware would miss it. To be called about every 20 ms of simulated
    /// time.
    pub fn keep_rc_fresh(&self, firmware: &mut Firmware, speed: f64, now: Instant) {
        if speed <= 1.0 {
            return;
        }
        // The firmware itself notices a loss after as much simulated time.
        let patience = RC_FRESH.mul_f64(1.0 - 1.0 / speed);
        for (source, heard) in [(RcSource::Udp, self.udp), (RcSource::Msp, self.msp)] {
            if let Some(ReceivedRc { frame, at }) = heard
                && now.saturating_duration_since(at) < patience
            {
                firmware.receive_rc(&frame, source);
            }
        }
    }

    /// The time of day, when a client has set it.
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

/// How a line being typed may go on.
fn completion(line: &str) -> Completion {
    let found = complete(line);
    Completion { tail: found.tail(line).to_owned(), words: found.candidates }
}

/// A client that went away needs no answer.
fn answer<T>(reply: oneshot::Sender<T>, value: T) {
    drop(reply.send(value));
}
