//! Detects a flight controller that does not answer over a connection that stays open, such as an adapter
//! whose board has no power.

use std::time::Instant;

use super::{FIRST_ANSWER, FeedState, RemoteEnds, RemoteLink, RemoteNotice, RemoteState};
use crate::fc::client::{Answer, Unanswered};

/// The number of unanswered requests in a row after which it counts as silent. Each waits for at least two
/// seconds.
const MOST_SILENT: u32 = 2;

/// The number of requests without an answer since the last answer.
#[derive(Debug, Default)]
pub(super) struct Silence {
    requests: u32,
    /// `true` once the flight controller counts as gone.
    reported: bool,
}

impl Silence {
    pub(super) fn note(&mut self, answer: &Answer) {
        match answer {
            Answer::NotAnswered(Unanswered::Silent) => self.requests += 1,
            Answer::NotAnswered(_) => {}
            Answer::Msp(_) | Answer::Line { .. } => self.requests = 0,
        }
    }
}

impl RemoteLink {
    /// Forgets the data of a real craft once it has been silent for some seconds. When it answers again, it
    /// may be another one.
    pub(super) fn follow_silence(&mut self) {
        let is_silent = self.silence.requests >= MOST_SILENT;
        match self.state {
            RemoteState::Ready | RemoteState::Identifying if is_silent && !self.is_fed() => {
                self.silence.reported = true;
                self.state = RemoteState::Lost;
                self.permission.lost();
                self.tell_client();
                self.observer.forget();
                self.notices.push(RemoteNotice::Lost(format!(
                    "{} no longer answers, although the connection is open: is it without power? Requests go on until \
                     it answers.",
                    self.ends.name
                )));
            }
            RemoteState::Lost if self.silence.reported && self.silence.requests == 0 => self.meet(),
            _ => {}
        }
    }

    /// Gives up a program that has never answered, and reports one that has stopped answering.
    pub(super) fn tell_silence(&mut self, now: Instant) {
        let is_over = |since: Instant| now.saturating_duration_since(since) >= FIRST_ANSWER;
        let started = self.ends.child.is_some().then_some(self.started);
        if !self.is_fed() || matches!(self.state, RemoteState::Unusable(_)) {
            return;
        }
        // A program that somebody else started, and to which another program is connected, was already
        // reported.
        let is_taken = self.reported_loss.is_some() && self.ends.child.is_none();
        if self.answers == 0 && !is_taken && self.first_connected.or(started).is_some_and(is_over) {
            let RemoteEnds { name, stream, .. } = &self.ends;
            let seconds = FIRST_ANSWER.as_secs();
            self.give_up(match &self.reported_loss {
                Some(reason) => format!("{name} has not answered for {seconds} s: {reason}."),
                None if self.first_connected.is_none() && self.motors != FeedState::Waiting => format!(
                    "{name} sends motors, but nothing has answered at {} for {seconds} s: name the port of its command line \
                     and MSP with --tcp-port.",
                    stream.place
                ),
                None => format!(
                    "{name} has not answered for {seconds} s: is it a SITL executable of Betaflight, and are its ports free?"
                ),
            });
        } else if !self.heard && self.connected.is_some_and(is_over) {
            self.connected = None;
            self.notices.push(RemoteNotice::Lost(format!(
                "{} accepts the connection but has not answered for {} s: requests go on until it does.",
                self.ends.name,
                FIRST_ANSWER.as_secs()
            )));
        }
    }

    /// Starts with a flight controller on a new connection. A real craft may be another one than before; a
    /// SITL that this program feeds is the same until it ends.
    pub(super) fn meet(&mut self) {
        self.silence = Silence::default();
        self.refresh = super::Refresh::default();
        self.client.connected();
        self.permission.connected();
        self.tell_client();
        if !self.is_fed() {
            self.observer.restarted();
        }
        // A usable one may be connected now, although the last one was not.
        if !self.is_fed() || !matches!(self.state, RemoteState::Unusable(_)) {
            self.state = RemoteState::Identifying;
            self.identification = super::Identification::default();
        }
    }
}
