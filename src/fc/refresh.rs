//! Reads the settings of a flight controller again after they may have changed, or if they could not be read
//! before.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use super::identify::{Question, how_it_is_set};
use super::{RemoteLink, RemoteNotice};
use crate::fc::client::{Answer, Unanswered};

/// The time without further changes before the settings are read. The last of several changes counts.
const SETTLED: Duration = Duration::from_millis(500);

/// The questions to ask again.
#[derive(Debug, Default)]
pub(super) struct Refresh {
    due: Option<Instant>,
    left: VecDeque<Question>,
}

impl Refresh {
    /// Marks the settings as outdated.
    pub(super) fn request(&mut self, now: Instant) {
        self.due = Some(now + SETTLED);
    }

    /// Returns the next question that is due.
    fn next(&mut self, now: Instant) -> Option<Question> {
        if self.due.take_if(|due| now >= *due).is_some() {
            self.left = how_it_is_set().collect();
        }
        self.left.pop_front()
    }
}

impl RemoteLink {
    /// Returns the next question that is due. Questions are only asked while the craft is disarmed, because
    /// the command line does not open in flight, and only if a line does not leave the command line open.
    pub(super) fn next_to_refresh(&mut self, now: Instant) -> Option<Question> {
        let can_tell = self.observer.armed() == Some(false) && !self.permission.opens_cli();
        if can_tell { self.refresh.next(now) } else { None }
    }

    /// Retries the questions that were not answered in flight, after the craft has disarmed.
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
            let reported = format!("{}: {}.", self.ends.name, self.observer.about_altitudes());
            self.notices.push(RemoteNotice::Reported(reported));
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
