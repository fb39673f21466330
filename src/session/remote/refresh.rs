//! Asks a flight controller again how it is set, once that may have changed or when it could not tell before.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use super::identify::{Question, how_it_is_set};
use super::{RemoteLink, RemoteNotice};
use crate::link::proto::fc_client::{Answer, Unanswered};

/// How long nothing may change for it to be asked: of several changes the last counts.
const SETTLED: Duration = Duration::from_millis(500);

/// What is to be asked again.
#[derive(Debug, Default)]
pub(super) struct Refresh {
    due: Option<Instant>,
    left: VecDeque<Question>,
}

impl Refresh {
    /// What was read is old.
    pub(super) fn request(&mut self, now: Instant) {
        self.due = Some(now + SETTLED);
    }

    /// The next question, when its turn has come.
    fn next(&mut self, now: Instant) -> Option<Question> {
        if self.due.take_if(|due| now >= *due).is_some() {
            self.left = how_it_is_set().collect();
        }
        self.left.pop_front()
    }
}

impl RemoteLink {
    /// What to ask again now: while disarmed, for the command line does not open in flight, and where no line opens it for good.
    pub(super) fn next_to_refresh(&mut self, now: Instant) -> Option<Question> {
        let can_tell = self.observer.armed() == Some(false) && !self.permission.opens_cli();
        if can_tell { self.refresh.next(now) } else { None }
    }

    /// It disarmed: what it could not tell in flight is asked again.
    pub(super) fn disarmed(&mut self, now: Instant) {
        if !self.observer.knows_settings() || self.permission.opens_cli() {
            self.permission.try_lines_again();
            self.tell_client();
            self.refresh.request(now);
        }
    }

    pub(super) fn take_refreshed(&mut self, question: Question, answer: &Answer, now: Instant) {
        let knew_settings = self.observer.knows_settings();
        match answer {
            Answer::NotAnswered(Unanswered::CliClosed) => self.refresh = Refresh::default(),
            Answer::NotAnswered(_) => self.refresh.request(now),
            Answer::Line { .. } | Answer::Msp(_) => self.observer.learn(question, answer),
        }
        if !knew_settings && self.observer.knows_settings() && self.observer.has_plans() {
            let told = format!("{}: {}.", self.ends.name, self.observer.about_altitudes());
            self.notices.push(RemoteNotice::Told(told));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[allow(clippy::disallowed_methods, reason = "the clock of a test begins somewhere")]
    fn several_changes_have_it_asked_once() {
        let begin = Instant::now();
        let at = |ms| begin + Duration::from_millis(ms);
        let mut refresh = Refresh::default();
        assert_eq!(refresh.next(at(0)), None);
        refresh.request(at(0));
        refresh.request(at(400));
        assert_eq!(refresh.next(at(600)), None);
        let asked: Vec<Question> = std::iter::from_fn(|| refresh.next(at(900))).collect();
        assert_eq!(asked, how_it_is_set().collect::<Vec<_>>());
        assert!(asked.contains(&Question::Settings("ap_")) && asked.contains(&Question::Plan));
        assert_eq!(refresh.next(at(2000)), None);
    }
}
