//! Answers the clients of the doors from a firmware and its store. Whoever owns the firmware calls it between two
//! steps.

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

use tokio::sync::oneshot;

use super::doors::RestartBell;
use super::request::{CliAnswer, ClientId, Request};
use super::upkeep;
use crate::firmware::Firmware;
use crate::firmware::cli::{CliAction, CliReply};
use crate::firmware::msp::{MspAction, UtcTime};
use crate::signals::{RcFrame, RcSource};
use crate::storage::Store;

/// A frame from a script counts as fresh for this long of wall time.
const RC_FRESH: Duration = Duration::from_millis(150);

/// What attending to a request led to, beyond the answer.
#[derive(Debug, Default)]
pub struct Attended {
    /// Sentences for the user.
    pub notices: Vec<String>,
    /// The firmware started anew.
    pub restarted: bool,
    /// A datagram from a simulator, which is not the desk's business, and when it came.
    pub fdm: Option<(Vec<u8>, Instant)>,
}

/// The newest frame of a source that comes through a socket.
#[derive(Debug, Clone, Copy)]
struct HeardRc {
    frame: RcFrame,
    at: Instant,
}

/// Attends to the requests of the doors.
#[derive(Debug)]
pub struct Desk {
    bell: RestartBell,
    starter_modes: bool,
    clock: Option<(UtcTime, Instant)>,
    udp: Option<HeardRc>,
    msp: Option<HeardRc>,
    /// Clients with an open command line that blocks arming.
    people: BTreeSet<ClientId>,
    /// The client whose command line turned motors on the bench last.
    bench: Option<ClientId>,
    told_plan: bool,
}

impl Desk {
    /// A desk that rings `bell` when the firmware starts anew. `starter_modes` gives a craft without mode conditions
    /// the usual ones at every start.
    #[must_use]
    pub fn new(bell: RestartBell, starter_modes: bool) -> Self {
        Self {
            bell,
            starter_modes,
            clock: None,
            udp: None,
            msp: None,
            people: BTreeSet::new(),
            bench: None,
            told_plan: false,
        }
    }

    /// Attends to a request at `now`.
    pub fn attend(
        &mut self,
        request: Request,
        firmware: &mut Firmware,
        store: &mut Store,
        now: Instant,
    ) -> Attended {
        let mut attended = Attended::default();
        match request {
            Request::Msp { code, payload, reply, .. } => {
                let outcome = firmware.run_msp(code, &payload, self.clock_at(now));
                if outcome.action == Some(MspAction::Save)
                    && let Err(notice) = upkeep::save(firmware, store)
                {
                    attended.notices.push(notice);
                    answer(reply, None);
                    return attended;
                }
                // Links are closed before the answer goes out: who comes back after it is a new client.
                self.act_on_message(outcome.action, firmware, store, now, &mut attended);
                answer(reply, outcome.reply);
            }
            Request::EnterCli { client, interactive, reply } => {
                let admitted = !firmware.is_armed();
                if admitted && interactive {
                    self.people.insert(client);
                    firmware.cli_opened();
                }
                answer(reply, admitted);
            }
            Request::Cli { client, line, mut interpreter, reply } => {
                let said = firmware.run_cli(&mut interpreter, &line);
                let restart = self.act_on_line(client, &said, firmware, store, &mut attended);
                if let Some(close_links) = restart {
                    self.restart(close_links, firmware, store, &mut attended);
                }
                answer(reply, CliAnswer { interpreter, reply: said });
            }
            Request::LeftCli { client } => {
                self.people.remove(&client);
                // Motors that somebody else turns go on.
                if self.bench.take_if(|bench| *bench == client).is_some() {
                    firmware.cli_closed();
                }
            }
            // The command line was opened before the craft was armed; it does not fall from the sky for that.
            Request::Restart { .. } if firmware.is_armed() => {}
            Request::Restart { .. } => self.restart(true, firmware, store, &mut attended),
            Request::Rc { frame, at, .. } => {
                self.udp = Some(HeardRc { frame, at });
                firmware.receive_rc(&frame, RcSource::Udp);
            }
            Request::Fdm { datagram, at, .. } => attended.fdm = Some((datagram, at)),
            Request::Notice(text) => attended.notices.push(text),
        }
        attended
    }

    fn act_on_message(
        &mut self,
        action: Option<MspAction>,
        firmware: &mut Firmware,
        store: &mut Store,
        now: Instant,
        attended: &mut Attended,
    ) {
        match action {
            Some(MspAction::Reboot) => self.restart(true, firmware, store, attended),
            Some(MspAction::SaveAndReboot) => {
                attended.notices.extend(upkeep::save(firmware, store).err());
                self.restart(true, firmware, store, attended);
            }
            Some(MspAction::SetClock { unix_s, millis }) => {
                self.clock = Some((UtcTime { unix_s, millis }, now));
            }
            // The firmware has used it; from here on it ages in wall time.
            Some(MspAction::RawRc(frame)) => {
                self.msp = Some(HeardRc { frame, at: now });
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
        attended: &mut Attended,
    ) -> Option<bool> {
        let mut restart = None;
        for action in &said.actions {
            match *action {
                CliAction::Save => attended.notices.extend(upkeep::save(firmware, store).err()),
                CliAction::Restart { close_links } => restart = Some(close_links),
                CliAction::PlanChanged if !self.told_plan => {
                    self.told_plan = true;
                    attended.notices.push("Waypoint altitudes count from home, in centimetres.".to_owned());
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
        attended: &mut Attended,
    ) {
        attended.notices.extend(upkeep::restart(firmware, store, self.starter_modes));
        attended.restarted = true;
        self.after_restart(close_links, firmware);
    }

    /// Puts the clients' side in order after the firmware started anew: closes the links, or, where they are kept,
    /// lets those who are at a command line block arming as before.
    pub fn after_restart(&mut self, close_links: bool, firmware: &mut Firmware) {
        (self.udp, self.msp, self.bench) = (None, None, None);
        if close_links {
            self.people.clear();
            self.bell.ring();
        } else if !self.people.is_empty() {
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
            if let Some(HeardRc { frame, at }) = heard
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

/// A client that went away needs no answer.
fn answer<T>(reply: oneshot::Sender<T>, value: T) {
    drop(reply.send(value));
}
