//! The phases of a connection: it is made, lost, silent, given up.

use std::time::Duration;

use super::{Connection, Event, Life, Remote, RemoteNotice};
use crate::fc::first_answer::{FIRST_ANSWER, is_over};
use crate::fc::identify::Identification;

impl Remote {
    /// Begins a new connection.
    pub(super) fn connect(&mut self, now: Duration) {
        self.first_answer.connected(now);
        let before = match &mut self.life {
            Life::Unusable { connection, .. } => connection.take(),
            life => life.end(),
        };
        self.meet(Connection::after(before, now));
        self.release_messages();
        self.events.push_back(Event::CameUp);
    }

    /// Starts with a flight controller on a connection. A real craft may be another one than before; a SITL
    /// that this program feeds is the same until it ends.
    fn meet(&mut self, met: Connection) {
        self.client.connected();
        self.permission.connected();
        self.report_to_client();
        if !self.craft.is_fed {
            self.observer.restarted();
        }
        match &mut self.life {
            Life::Unusable { connection, .. } if self.craft.is_fed => *connection = Some(met),
            // A usable one may be connected now, although the last one was not.
            life => *life = Life::identifying(met),
        }
    }

    /// Ends the connection.
    pub(super) fn lose(&mut self, reason: &str) {
        self.client.disconnected();
        self.permission.lost();
        self.observer.forget();
        let name = &self.craft.name;
        self.life = match std::mem::take(&mut self.life) {
            Life::Unusable { why, connection, identification } => {
                Life::Unusable { why, connection: connection.map(Connection::closed), identification }
            }
            // Its own program may still be starting. A delay that is too long is reported elsewhere.
            Life::Connecting if self.craft.is_child => Life::Connecting,
            Life::Connecting => {
                let notice = format!("No connection to {name}: {reason}; trying again.");
                self.notice(RemoteNotice::Lost(notice));
                Life::Connecting
            }
            // A program that somebody else started closes its port when it ends to be restarted.
            Life::Identifying { connection, .. } | Life::Ready { connection }
                if self.craft.is_fed && !self.craft.is_child && connection.heard =>
            {
                self.restart(format!(
                    "{name} ended or is restarting: when it is back, the craft is at home."
                ));
                Life::Lost { connection: connection.closed() }
            }
            Life::Identifying { mut connection, .. } | Life::Ready { mut connection } => {
                // A connection that closes at once is reported only once. In simulated time only a restart closes it, which
                // is reported as such.
                if !self.craft.is_in_steps && connection.reported_loss.as_deref() != Some(reason) {
                    let notice = format!("The connection to {name} is lost: {reason}; reconnecting.");
                    self.notice(RemoteNotice::Lost(notice));
                    connection.reported_loss = Some(reason.to_owned());
                }
                self.went_down(&connection);
                Life::Lost { connection: connection.closed() }
            }
            Life::Silent { connection } | Life::Lost { connection } => {
                self.went_down(&connection);
                Life::Lost { connection: connection.closed() }
            }
        };
    }

    /// Reports that it is gone, if nothing came over the connection.
    fn went_down(&mut self, connection: &Connection) {
        if !connection.heard {
            self.events.push_back(Event::WentDown);
        }
    }

    /// Begins another run of an executable that ended. The craft is at home.
    pub(super) fn restart(&mut self, notice: String) {
        self.observer.restarted();
        self.events.push_back(Event::Restarted(notice));
    }

    pub(super) fn give_up(&mut self, why: String) {
        if matches!(self.life, Life::Unusable { .. }) {
            return;
        }
        self.notice(RemoteNotice::Failed(why.clone()));
        self.events.push_back(Event::GivenUp);
        let identification =
            self.life.identification_mut().map_or_else(Identification::default, |asked| *asked);
        self.life = Life::Unusable { why, connection: self.life.end(), identification };
        self.release_messages();
    }

    /// Forgets the data of a real craft once it has been silent for some seconds. When it answers again, it
    /// may be another one.
    pub(super) fn follow_silence(&mut self) {
        match &mut self.life {
            Life::Identifying { connection, .. } | Life::Ready { connection }
                if connection.is_silent() && !self.craft.is_fed =>
            {
                let connection = std::mem::take(connection);
                self.life = Life::Silent { connection };
                self.permission.lost();
                self.report_to_client();
                self.observer.forget();
                self.notice(RemoteNotice::Lost(format!(
                    "{} no longer answers, although the connection is open: is it without power? Requests go on until \
                     it answers.",
                    self.craft.name
                )));
            }
            Life::Silent { connection } if connection.is_answered() => {
                let connection = std::mem::take(connection).for_another();
                self.meet(connection);
            }
            _ => {}
        }
    }

    /// Gives up a program that has never answered, and reports one that has stopped answering.
    pub(super) fn check_first_answer(&mut self, now: Duration) {
        if !self.craft.is_fed || matches!(self.life, Life::Unusable { .. }) {
            return;
        }
        let name = &self.craft.name;
        let seconds = FIRST_ANSWER.as_secs();
        let reported_loss = self.life.connection().and_then(|connection| connection.reported_loss.as_ref());
        // A program that somebody else started, and to which another program is connected, was already
        // reported.
        let is_taken = reported_loss.is_some() && !self.craft.is_child;
        if self.first_answer.is_overdue(now) && !is_taken {
            let why = match reported_loss {
                Some(reason) => format!("{name} has not answered for {seconds} s: {reason}."),
                None if !self.first_answer.was_connected && self.sends_motors => format!(
                    "{name} sends motors, but nothing has answered at {} for {seconds} s: name the port of its command line \
                     and MSP with --tcp-port.",
                    self.craft.place
                ),
                None => format!(
                    "{name} has not answered for {seconds} s: is it a SITL executable of Betaflight, and are its ports free?"
                ),
            };
            self.give_up(why);
        } else if let Some(connection) = self.life.connection_mut()
            && !connection.heard
            && connection.since.take_if(|since| is_over(*since, now)).is_some()
        {
            let notice = format!(
                "{name} accepts the connection but has not answered for {seconds} s: requests go on until it does."
            );
            self.notice(RemoteNotice::Lost(notice));
        }
    }
}
