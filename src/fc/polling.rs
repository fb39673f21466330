//! Chooses the next message to poll so that the display is up to date and the link has room for everything
//! else.
//!
//! The message that is latest, measured in its own period, comes next. A slow link therefore slows everything
//! down alike, and nothing starves.

use std::time::Duration;

use super::client::{Answer, Ask, Unanswered};
use crate::msp::code;

/// The line that prints the mission's progress.
const MISSION_LINE: &str = "waypoint status";
/// The polling period of the mission while nothing is flown.
const MISSION_AT_REST: Duration = Duration::from_secs(2);
/// The polling period of a refused message. A setting may enable it later.
const REFUSED_PERIOD: Duration = Duration::from_secs(30);
/// The share of the link's bytes for polling. The user's own requests need the rest.
const SHARE: f64 = 0.6;
/// The bytes of a frame around its payload, including those of the request.
const FRAME_BYTES: usize = 15;

/// A request that is repeated periodically.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Poll {
    Message(u16),
    /// The progress of the mission, by MSP message.
    Mission,
}

impl Poll {
    /// Returns the request.
    pub fn ask(self) -> Ask {
        match self {
            Self::Message(code) => Ask::Msp { code, payload: Vec::new() },
            Self::Mission => Ask::MessageLine(MISSION_LINE.to_owned()),
        }
    }
}

/// The polls, most important first, and their periods on a link that can carry them, ms.
const PLAN: [(Poll, u64); 12] = [
    (Poll::Message(code::BOXIDS), 5000),
    (Poll::Message(code::STATUS_EX), 100),
    (Poll::Message(code::ATTITUDE), 50),
    (Poll::Message(code::ALTITUDE), 100),
    (Poll::Message(code::RAW_GPS), 200),
    (Poll::Mission, 200),
    (Poll::Message(code::RC), 200),
    (Poll::Message(code::MOTOR), 200),
    (Poll::Message(code::COMP_GPS), 500),
    (Poll::Message(code::BATTERY_STATE), 500),
    (Poll::Message(code::MODE_RANGES), 5000),
    (Poll::Message(code::MODE_RANGES_EXTRA), 5000),
];

/// The periods of the polls that show states and modes, for a flight controller in simulated time, ms. They are so short
/// that a state of one update of the navigator is seen.
const IN_STEPS: [(Poll, u64); 2] = [(Poll::Message(code::STATUS_EX), 10), (Poll::Mission, 10)];

/// The schedule of the polls.
#[derive(Debug, Clone)]
pub struct Schedule {
    entries: Vec<Entry>,
    /// The bytes per second that polling may use; `None` if the link exceeds every need.
    budget: Option<f64>,
    /// The time at which the last poll has used up its share of the link.
    free_at: Duration,
}

#[derive(Debug, Clone, Copy)]
struct Entry {
    poll: Poll,
    period: Duration,
    /// The time of the last poll; `None` if the value is outdated.
    asked: Option<Duration>,
    refused: bool,
}

impl Entry {
    fn current_period(&self, in_flight: bool) -> Duration {
        match self.poll {
            _ if self.refused => REFUSED_PERIOD,
            Poll::Mission if !in_flight => MISSION_AT_REST,
            Poll::Mission | Poll::Message(_) => self.period,
        }
    }
}

impl Schedule {
    /// Returns the same schedule for a flight controller in simulated time, whose link loses nothing.
    pub fn in_steps(mut self) -> Self {
        for (poll, ms) in IN_STEPS {
            if let Some(entry) = self.entries.iter_mut().find(|entry| entry.poll == poll) {
                entry.period = Duration::from_millis(ms);
            }
        }
        self
    }

    /// Creates a schedule for a link with this capacity in bytes per second; `None` if it exceeds every need.
    pub fn new(bytes_per_s: Option<u32>) -> Self {
        let entries = PLAN.map(|(poll, ms)| Entry {
            poll,
            period: Duration::from_millis(ms),
            asked: None,
            refused: false,
        });
        Self {
            entries: entries.to_vec(),
            budget: bytes_per_s.map(|bytes| SHARE * f64::from(bytes.max(1))),
            free_at: Duration::ZERO,
        }
    }

    /// Marks everything as outdated, after a new connection or a change.
    pub fn refresh(&mut self) {
        for entry in &mut self.entries {
            entry.asked = None;
            entry.refused = false;
        }
        self.free_at = Duration::ZERO;
    }

    /// Marks a poll as outdated. It comes next unless another one was never sent.
    pub fn hasten(&mut self, poll: Poll) {
        if let Some(entry) = self.entries.iter_mut().find(|entry| entry.poll == poll) {
            entry.asked = None;
        }
    }

    /// Returns the time at which the next poll is due.
    pub fn due(&self, in_flight: bool) -> Duration {
        let due = |entry: &Entry| {
            entry.asked.map_or(Duration::ZERO, |asked| asked + entry.current_period(in_flight))
        };
        self.entries.iter().map(due).min().unwrap_or_default().max(self.free_at)
    }

    /// Returns the poll to send now, if any, and counts it as sent. `in_flight` means armed or flying a
    /// mission.
    pub fn next(&mut self, in_flight: bool, now: Duration) -> Option<Poll> {
        if now < self.free_at {
            return None;
        }
        let lateness = |entry: &Entry| match entry.asked {
            None => f64::INFINITY,
            Some(asked) => {
                now.saturating_sub(asked).as_secs_f64() / entry.current_period(in_flight).as_secs_f64()
            }
        };
        let mut latest: Option<(f64, &mut Entry)> = None;
        for entry in &mut self.entries {
            let late = lateness(entry);
            if late >= 1.0 && latest.as_ref().is_none_or(|(most, _)| late > *most) {
                latest = Some((late, entry));
            }
        }
        let (_, entry) = latest?;
        entry.asked = Some(now);
        Some(entry.poll)
    }

    /// Records the result of a poll.
    pub fn answered(&mut self, poll: Poll, answer: &Answer) {
        let (refused, bytes) = match answer {
            Answer::Msp(payload) => (payload.is_none(), payload.as_ref().map_or(0, Vec::len)),
            Answer::Line { text, .. } => (false, text.len()),
            Answer::NotAnswered(why) => (*why == Unanswered::CliClosed, 0),
        };
        if let Some(entry) = self.entries.iter_mut().find(|entry| entry.poll == poll) {
            entry.refused = refused;
            if let (Some(budget), Some(asked)) = (self.budget, entry.asked) {
                self.free_at = asked + Duration::from_secs_f64((bytes + FRAME_BYTES) as f64 / budget);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    /// Returns the number of times each poll was sent in ten seconds, for replies of `reply` bytes that take
    /// `takes_ms`.
    fn asked(
        mut schedule: Schedule,
        reply: usize,
        takes_ms: u64,
        in_flight: bool,
    ) -> BTreeMap<String, usize> {
        let mut counts = BTreeMap::new();
        let mut now = Duration::from_secs(100);
        let end = now + Duration::from_secs(10);
        while now < end {
            match schedule.next(in_flight, now) {
                Some(poll) => {
                    *counts.entry(format!("{poll:?}")).or_default() += 1;
                    now += Duration::from_millis(takes_ms);
                    schedule.answered(poll, &Answer::Msp(Some(vec![0; reply])));
                }
                None => now += Duration::from_millis(1),
            }
        }
        counts
    }

    fn count(counts: &BTreeMap<String, usize>, poll: Poll) -> usize {
        counts.get(&format!("{poll:?}")).copied().unwrap_or_default()
    }

    #[test]
    fn a_link_with_room_carries_every_message_at_its_rate() {
        let counts = asked(Schedule::new(None), 20, 2, true);
        for (poll, ms) in PLAN {
            let wanted = 10_000 / ms as usize;
            let got = count(&counts, poll);
            assert!(got * 10 >= wanted * 9 && got <= wanted + 1, "{poll:?}: {got} of {wanted}");
        }
        let at_rest = asked(Schedule::new(None), 20, 2, false);
        assert_eq!(count(&at_rest, Poll::Mission), 5);
    }

    #[test]
    fn in_simulated_time_states_and_modes_are_asked_for_each_update_or_two() {
        let counts = asked(Schedule::new(None).in_steps(), 20, 2, true);
        for (poll, _) in IN_STEPS {
            assert!(count(&counts, poll) >= 450, "{poll:?}: {}", count(&counts, poll));
        }
        assert!(PLAN.iter().all(|(poll, _)| count(&counts, *poll) >= 2), "{counts:?}");
    }

    #[test]
    fn a_slow_flight_controller_slows_everything_alike_and_starves_nothing() {
        let counts = asked(Schedule::new(None), 20, 40, true);
        let rates: Vec<f64> =
            PLAN.iter().map(|(poll, ms)| count(&counts, *poll) as f64 * *ms as f64 / 10_000.0).collect();
        assert!(rates.iter().all(|rate| *rate > 0.25), "{rates:?}");
        assert!(counts.values().sum::<usize>() <= 250);
    }

    #[test]
    fn the_bytes_of_the_link_are_not_used_up() {
        for bytes_per_s in [960, 1920, 5760, 11_520] {
            let counts = asked(Schedule::new(Some(bytes_per_s)), 40, 2, true);
            let bytes = counts.values().sum::<usize>() * (40 + FRAME_BYTES);
            assert!(bytes as f64 <= SHARE * 10.0 * f64::from(bytes_per_s) + 60.0, "{bytes_per_s}: {bytes}");
            assert!(bytes as f64 >= 0.4 * SHARE * 10.0 * f64::from(bytes_per_s), "{bytes_per_s}: {bytes}");
        }
    }

    #[test]
    fn what_is_refused_is_asked_rarely_until_somebody_changes_something() {
        let mut schedule = Schedule::new(None);
        let refuse = |schedule: &mut Schedule, from: u64, to: u64| {
            let mut asked = 0;
            for ms in (from * 1000..to * 1000).step_by(10) {
                let now = Duration::from_millis(ms);
                while let Some(poll) = schedule.next(true, now) {
                    let answer = match poll {
                        Poll::Mission => Answer::NotAnswered(Unanswered::CliClosed),
                        Poll::Message(_) => Answer::Msp(None),
                    };
                    schedule.answered(poll, &answer);
                    asked += 1;
                }
            }
            asked
        };
        assert_eq!(refuse(&mut schedule, 0, 29), PLAN.len());
        assert_eq!(refuse(&mut schedule, 29, 59), PLAN.len());
        schedule.refresh();
        assert_eq!(refuse(&mut schedule, 59, 60), PLAN.len());
    }
}
