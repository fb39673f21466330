//! Requests to a remote flight controller that still wait for their answers.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use crate::vehicle::Ticket;

/// The longest wait for an answer, wall time. The client of the flight controller's serial port answers every
/// request itself, even one that it gave up, and one request may take a minute. This limit covers answers
/// that were lost after that.
const ANSWER_TIMEOUT: Duration = Duration::from_secs(600);

/// The text in place of a missing answer.
pub(super) const NO_ANSWER: &str = "the flight controller does not answer";

/// Returns the command line's output in place of a missing answer.
pub(super) fn no_answer_line() -> String {
    format!("###ERROR: {}###", NO_ANSWER.to_uppercase())
}

/// The recipients of pending answers, by ticket.
#[derive(Debug)]
pub(super) struct LateAnswers<R>(BTreeMap<Ticket, (Instant, R)>);

impl<R> Default for LateAnswers<R> {
    fn default() -> Self {
        Self(BTreeMap::new())
    }
}

impl<R> LateAnswers<R> {
    /// Registers `recipient` for the answer with this ticket, from `now` on.
    pub(super) fn expect(&mut self, ticket: Ticket, recipient: R, now: Instant) {
        self.0.insert(ticket, (now, recipient));
    }

    /// Returns the recipient of an answer that has arrived.
    pub(super) fn take(&mut self, ticket: Ticket) -> Option<R> {
        self.0.remove(&ticket).map(|(_, recipient)| recipient)
    }

    /// Returns the recipients of all pending answers.
    pub(super) fn recipients(&self) -> impl Iterator<Item = &R> {
        self.0.values().map(|(_, recipient)| recipient)
    }

    /// Forgets the recipients for which `keeps` is false.
    pub(super) fn retain(&mut self, keeps: impl Fn(&R) -> bool) {
        self.0.retain(|_, (_, recipient)| keeps(recipient));
    }

    /// Returns the recipients that have waited too long.
    pub(super) fn take_overdue(&mut self, now: Instant) -> Vec<R> {
        let overdue = |_: &Ticket, (asked, _): &mut (Instant, R)| {
            now.saturating_duration_since(*asked) >= ANSWER_TIMEOUT
        };
        self.0.extract_if(.., overdue).map(|(_, (_, recipient))| recipient).collect()
    }
}
