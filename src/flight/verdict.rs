//! The result of a flight.

/// The result of a flight. `Display` gives the word of the `end` event.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display)]
#[strum(serialize_all = "lowercase")]
pub enum FlightResult {
    /// The mission reached COMPLETE, landed and disarmed if the plan ends in LAND, and the truth agrees.
    Complete,
    /// The firmware reports COMPLETE, but the truth does not agree.
    Missed,
    /// Landed by an emergency landing or a return home, not by the plan.
    Landed,
    /// The autopilot refused to engage.
    Refused,
    /// The mission was given up and stayed IDLE.
    Aborted,
    /// Disarmed for another reason.
    Disarmed,
    Crashed,
    /// Not over before the timeout.
    Timeout,
    /// The simulation left the range in which its numbers are meaningful.
    Diverged,
    /// Stopped by the user.
    Interrupted,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    pub result: FlightResult,
    /// Reason, as a sentence.
    pub reason: String,
}

impl Verdict {
    pub fn new(result: FlightResult, reason: impl Into<String>) -> Self {
        Self { result, reason: reason.into() }
    }
}
