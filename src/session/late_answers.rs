//! Requests to a remote flight controller whose answers are still to come.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use crate::vehicle::Ticket;

/// How long an answer is awaited, wall time. The client of the flight controller's serial port answers each request itself,
/// that it gave up as well, and one request may take a minute: this is for answers that were lost after that.
const ANSWER_TIMEOUT: Duration = Duration::from_secs(600);

/// What is said in place of an answer that did not come.
pub(super) const NO_ANSWER: &str = "the flight controller does not answer";

/// What a command line prints in place of the output of a line that was not answered.
pub(super) fn no_answer_line() -> String {
    format!("###ERROR: {}###", NO_ANSWER.to_uppercase())
}

/// Who awaits which answer.
#[derive(Debug)]
pub(super) struct LateAnswers<R>(BTreeMap<Ticket, (Instant, R)>);

impl<R> Default for LateAnswers<R> {
    fn default() -> Self {
        Self(BTreeMap::new())
    }
}

impl<R> LateAnswers<R> {
    /// `recipient` awaits the answer with this ticket from `now` on.
    pub(super) fn expect(&mut self, ticket: Ticket, recipient: R, now: Instant) {
        self.0.insert(ticket, (now, recipient));
    }

    /// Who awaits this answer, which has come.
    pub(super) fn take(&mut self, ticket: Ticket) -> Option<R> {
        self.0.remove(&ticket).map(|(_, recipient)| recipient)
    }

    /// Who awaits an answer.
    pub(super) fn recipients(&self) -> impl Iterator<Item = &R> {
        self.0.values().map(|(_, recipient)| recipient)
    }

    /// Those who have waited for too long.
    pub(super) fn take_overdue(&mut self, now: Instant) -> Vec<R> {
        let overdue = |_: &Ticket, (asked, _): &mut (Instant, R)| {
            now.saturating_duration_since(*asked) >= ANSWER_TIMEOUT
        };
        self.0.extract_if(.., overdue).map(|(_, (_, recipient))| recipient).collect()
    }
}
