//! Reads the settings of a flight controller again after they may have changed, or if they could not be read
//! before.

use std::collections::VecDeque;
use std::time::Duration;

use super::identify::{Question, how_it_is_set};

/// The time without further changes before the settings are read. The last of several changes counts.
const SETTLED: Duration = Duration::from_millis(500);

/// The questions to ask again.
#[derive(Debug, Clone, Default)]
pub(super) struct Refresh {
    due: Option<Duration>,
    left: VecDeque<Question>,
}

impl Refresh {
    /// Marks the settings as outdated.
    pub(super) fn request(&mut self, now: Duration) {
        self.due = Some(now + SETTLED);
    }

    /// Returns the next question that is due.
    pub(super) fn next(&mut self, now: Duration) -> Option<Question> {
        if self.due.take_if(|due| now >= *due).is_some() {
            self.left = how_it_is_set().collect();
        }
        self.left.pop_front()
    }

    /// Returns the time of the next question.
    pub(super) fn due(&self) -> Option<Duration> {
        if self.left.is_empty() { self.due } else { Some(Duration::ZERO) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn several_changes_have_it_asked_once() {
        let at = Duration::from_millis;
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
