//! The result of a flight.

use crate::telemetry::{CrashCause, NavState, PlanSource};

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
    /// The craft crashed.
    Crashed,
    /// Not over before the timeout.
    Timeout,
    /// The simulation left the range in which its numbers are meaningful.
    Diverged,
    /// Stopped by the user.
    Interrupted,
}

/// The result of a flight, with its reason.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// The result.
    pub result: FlightResult,
    /// Reason, as a sentence.
    pub reason: String,
}

/// A crash, with all that is known of it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Crash {
    /// The cause, if it is known.
    pub cause: Option<CrashCause>,
    /// The state of the navigator at the crash; IDLE if it flew nothing.
    pub state: NavState,
    /// Index of the waypoint in the active plan.
    pub wp: u8,
    /// Origin of the active plan.
    pub source: PlanSource,
    /// True roll to the right and pitch up at the impact, degrees.
    pub attitude_deg: Option<[f64; 2]>,
}

impl std::fmt::Display for Crash {
    /// Writes the sentence of a verdict, without its full stop.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("the craft crashed")?;
        if self.state != NavState::Idle {
            write!(f, " {} at waypoint {}", self.state, self.wp)?;
            match self.source {
                PlanSource::Stored => {}
                PlanSource::Rth => f.write_str(" of the return home")?,
                PlanSource::Emergency => f.write_str(" of the emergency landing")?,
            }
        }
        if let Some(cause) = self.cause {
            write!(f, ": it {}", cause.of_it())?;
        }
        match self.attitude_deg {
            // Avoids `-0°`.
            Some([roll, pitch]) => {
                write!(f, ", roll {:.0}°, pitch {:.0}°", roll.round() + 0.0, pitch.round() + 0.0)
            }
            None => Ok(()),
        }
    }
}

impl Verdict {
    /// Returns a verdict with this reason, a sentence without its full stop.
    pub fn new(result: FlightResult, reason: impl Into<String>) -> Self {
        Self { result, reason: reason.into() }
    }
}
