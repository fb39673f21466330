//! The wait for the first answer of a SITL executable.

use std::time::Duration;

/// The longest time that a program may take for its first answer.
pub(super) const FIRST_ANSWER: Duration = Duration::from_secs(10);

/// The number of answers, and the time since which the first one is awaited.
#[derive(Debug, Clone, Default)]
pub(super) struct FirstAnswer {
    /// The time of the first connection; for a program that is a child, at first the time of its start.
    since: Option<Duration>,
    /// `true` once a connection was made.
    pub(super) was_connected: bool,
    /// The number of answered requests since the first start of the program.
    pub(super) answers: u64,
}

impl FirstAnswer {
    /// Returns a wait that begins at the start of a program, or else at the first connection.
    pub(super) fn new(started: Option<Duration>) -> Self {
        Self { since: started, ..Self::default() }
    }

    pub(super) fn connected(&mut self, now: Duration) {
        if !std::mem::replace(&mut self.was_connected, true) {
            self.since = Some(now);
        }
    }

    /// Returns `true` if nothing was answered in time.
    pub(super) fn is_overdue(&self, now: Duration) -> bool {
        self.answers == 0 && self.since.is_some_and(|since| is_over(since, now))
    }
}

/// Returns `true` if the time for a first answer is over.
pub(super) fn is_over(since: Duration, now: Duration) -> bool {
    now.saturating_sub(since) >= FIRST_ANSWER
}
