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
    /// The last touchdown: seconds after the engagement, and the place, m north and east of home.
    pub touchdown: Option<(f64, Vector2<f64>)>,
    /// Result of the flight in one word.
    pub result: String,
    /// The reason as a sentence; may be empty.
    pub reason: String,
    /// Seconds from the engagement to the end; `None` if the autopilot did not engage.
    pub flown_s: Option<f64>,
}

/// Returns the distance from a point to the segment between two others.
pub(super) fn distance_to_segment<const D: usize>(
    point: nalgebra::SVector<f64, D>,
    from: nalgebra::SVector<f64, D>,
    to: nalgebra::SVector<f64, D>,
) -> f64 {
    let along = to - from;
    let length = along.norm_squared();
    let share = if length > 0.0 { ((point - from).dot(&along) / length).clamp(0.0, 1.0) } else { 0.0 };
    (point - (from + along * share)).norm()
}
