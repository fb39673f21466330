//! How a flight ended.

/// How a flight ended; `Display` gives the word of the `end` event.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display)]
#[strum(serialize_all = "lowercase")]
pub enum FlightResult {
    /// The mission reached COMPLETE, landed and disarmed where the plan ends in LAND, and the truth agrees.
    Complete,
    /// The firmware says complete, the truth does not.
    Missed,
    /// Landed by an emergency landing or a return home, not by the plan.
    Landed,
    /// The autopilot refused to engage.
    Refused,
    /// The mission was given up and stayed IDLE.
    Aborted,
    /// Disarmed by something else.
    Disarmed,
    Crashed,
    /// Not over in time.
    Timeout,
    /// The simulation left the range where its numbers mean something.
    Diverged,
    /// Stopped by the user.
    Interrupted,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// How the flight ended.
    pub result: FlightResult,
    /// Why, as a sentence.
    pub reason: String,
}

impl Verdict {
    /// A verdict with its reason.
    pub fn new(result: FlightResult, reason: impl Into<String>) -> Self {
        Self { result, reason: reason.into() }
    }
}
