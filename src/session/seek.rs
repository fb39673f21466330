//! The instants to which seeks lead.

use super::command::Seek;
use crate::signals::SimTime;
use crate::timeline::Marks;

/// The time before the first alarm of a mishap at which the view starts, µs: a link is cut before its loss is
/// detected.
const MISHAP_LEAD_US: u64 = 2_000_000;

/// The target of a seek.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Target {
    /// The newest instant.
    Newest,
    /// This instant, which may be before or after all that was recorded.
    At(SimTime),
    /// There is none. The sentence says why.
    Nowhere(&'static str),
}

/// Returns the target of a seek from the shown instant. `head` is the newest instant.
pub(super) fn target(seek: Seek, shown: SimTime, head: SimTime, marks: &Marks) -> Target {
    let before = |states_only| marks.before(shown, states_only).map(|mark| mark.time);
    let found = match seek {
        Seek::Newest => return Target::Newest,
        Seek::Time(time) => Some(time),
        Seek::Seconds(seconds) => {
            let us = (seconds * 1e6) as i64;
            Some(SimTime(shown.0.saturating_add_signed(us)))
        }
        Seek::Back { states_only } => before(states_only),
        Seek::BeforeMishap => {
            let mishap = marks.mishap_before(shown);
            let lead = mishap.map(|mark| SimTime(mark.time.0.saturating_sub(MISHAP_LEAD_US)));
            lead.or_else(|| before(true))
        }
        Seek::Forward { states_only } => Some(marks.after(shown, states_only).map_or(head, |mark| mark.time)),
    };
    match (found, seek) {
        (Some(time), _) => Target::At(time),
        (None, Seek::Back { states_only: true }) => {
            Target::Nowhere("The autopilot was in no other state before this instant.")
        }
        (None, _) => Target::Nowhere("Nothing happened before this instant."),
    }
}
