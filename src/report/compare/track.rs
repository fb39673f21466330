//! The true track of a craft.

use nalgebra::Vector2;

use crate::report::route::TrackSample;

/// A flight of the plan from its engagement on, the instant at which the pilot switched the autopilot on.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Track {
    /// The seed of its air and its sensors.
    pub seed: u64,
    /// The positions of the craft, at equal intervals.
    pub samples: Vec<TrackSample>,
    /// The last touchdown.
    pub touchdown: Option<Landing>,
    /// Result of the flight in one word.
    pub result: String,
    /// The reason as a sentence; may be empty.
    pub reason: String,
    /// Seconds from the engagement to the end; `None` if the autopilot did not engage.
    pub flown_s: Option<f64>,
}

/// A touchdown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Landing {
    /// Seconds after the engagement.
    pub time_s: f64,
    /// North and east of home, m.
    pub ne: Vector2<f64>,
    /// Speed at the contact, m/s; `None` in a log.
    pub impact_mps: Option<f64>,
    /// Seconds until the craft was disarmed; `None` if it was not, or in a log.
    pub disarmed_after_s: Option<f64>,
}

impl Landing {
    /// Returns the landing of a log: the time and the place at which the craft was disarmed.
    pub fn from_disarming(time_s: f64, ne: Vector2<f64>) -> Self {
        Self { time_s, ne, impact_mps: None, disarmed_after_s: None }
    }
}
