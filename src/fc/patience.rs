//! The time limit until a remote firmware is ready.

use std::fmt;
use std::time::Duration;

/// The longest time between two answers, for a program that starts slowly, or a `save` and its restart.
const SILENCE: Duration = Duration::from_secs(15);
/// The most connections: one, and one more for each restart.
const MAX_CONNECTIONS: u32 = 5;

/// The wait for a firmware.
#[derive(Debug, Clone, Copy)]
pub struct Patience {
    answers: u64,
    /// The time of the last answer.
    since: Duration,
}

/// The reason for giving up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NotReady {
    /// It has never answered.
    NeverAnswered,
    /// It has answered before, but not any more.
    Silent,
    /// Its connections end immediately.
    EndsConnections,
}

impl Patience {
    /// Starts the wait now.
    pub fn new(now: Duration) -> Self {
        Self { answers: 0, since: now }
    }

    /// Returns the reason to give up, if any, for this number of answers and connections so far.
    pub fn look(&mut self, answers: u64, connections: u32, now: Duration) -> Option<NotReady> {
        if answers > self.answers {
            *self = Self { answers, since: now };
        }
        if connections > MAX_CONNECTIONS {
            return Some(NotReady::EndsConnections);
        }
        (now.saturating_sub(self.since) >= SILENCE).then_some(match answers {
            0 => NotReady::NeverAnswered,
            _ => NotReady::Silent,
        })
    }
}

/// The reason why a firmware is not ready. `Display` gives a sentence with a suggestion.
#[derive(Debug, Clone, Copy)]
pub struct Unready<'a> {
    /// The name of the firmware.
    pub name: &'a str,
    /// The port of its command line and MSP.
    pub tcp: u16,
    /// `true` if betadeck did not start it.
    pub is_attached: bool,
    pub why: NotReady,
}

impl fmt::Display for Unready<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, tcp, is_attached, why } = *self;
        let seconds = SILENCE.as_secs();
        match (why, is_attached) {
            (NotReady::NeverAnswered, true) => write!(
                f,
                "nothing has answered at TCP port {tcp} for {seconds} s: start the firmware first, or name the port of its \
                 command line and MSP with --tcp-port"
            ),
            (NotReady::NeverAnswered, false) => write!(
                f,
                "{name} has not answered at TCP port {tcp} for {seconds} s: name the port of its command line and MSP with \
                 --tcp-port"
            ),
            (NotReady::Silent, true) => write!(
                f,
                "{name} answered, but not in the last {seconds} s: a SITL ends when it saves; start it again and \
                 repeat the command, because the saved configuration is kept"
            ),
            (NotReady::Silent, false) => {
                write!(f, "{name} answered, but not in the last {seconds} s: its output may give the reason")
            }
            (NotReady::EndsConnections, true) => write!(
                f,
                "{name} closes every connection to TCP port {tcp}: it serves one program at a time, so close the one \
                 that is connected to it (the Betaflight App, another betadeck)"
            ),
            (NotReady::EndsConnections, false) => write!(
                f,
                "{name} closes every connection to TCP port {tcp} before it is ready: its output may give the reason"
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_answer_gives_it_more_time() {
        let start = Duration::ZERO;
        let at = Duration::from_secs;
        let mut patience = Patience::new(start);
        assert_eq!(patience.look(0, 0, at(14)), None);
        assert_eq!(patience.look(1, 1, at(14)), None);
        assert_eq!(patience.look(1, 1, at(28)), None);
        assert_eq!(patience.look(1, 1, at(29)), Some(NotReady::Silent));
        assert_eq!(patience.look(2, 2, at(40)), None, "it was only slow");
        assert_eq!(Patience::new(start).look(0, 0, at(15)), Some(NotReady::NeverAnswered));
    }

    #[test]
    fn connections_that_end_again_and_again_are_no_progress() {
        let start = Duration::ZERO;
        let mut patience = Patience::new(start);
        assert_eq!(patience.look(40, MAX_CONNECTIONS, start), None);
        assert_eq!(patience.look(41, MAX_CONNECTIONS + 1, start), Some(NotReady::EndsConnections));
    }

    #[test]
    fn the_sentence_says_what_to_do() {
        let say = |why, is_attached| {
            Unready { name: "the firmware at port 6000", tcp: 6000, is_attached, why }.to_string()
        };
        let never = say(NotReady::NeverAnswered, true);
        assert!(never.contains("TCP port 6000") && never.contains("--tcp-port"), "{never}");
        assert!(never.contains("start the firmware first"), "{never}");
        let saved = say(NotReady::Silent, true);
        assert!(saved.contains("start it again and repeat the command"), "{saved}");
        let taken = say(NotReady::EndsConnections, true);
        assert!(taken.contains("close the one that is connected to it"), "{taken}");
    }
}
