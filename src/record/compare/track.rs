//! Where a craft truly flew.

use nalgebra::{Vector2, Vector3};

/// A flight of the plan from its engagement on, which is when the pilot switched the autopilot on.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Track {
    /// Where the craft was, at a steady rhythm.
    pub samples: Vec<TrackSample>,
    /// The last touchdown: seconds after the engagement, and where, m north and east of home.
    pub touchdown: Option<(f64, Vector2<f64>)>,
    /// Result of the flight in a word.
    pub result: String,
    /// Why, as a sentence; may be empty.
    pub reason: String,
    /// Seconds from the engagement to the end; `None` when it did not engage.
    pub flown_s: Option<f64>,
}

/// The craft at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackSample {
    /// Seconds after the engagement.
    pub time_s: f64,
    /// North and east of home, m.
    pub ne: Vector2<f64>,
    /// Above where the craft stood at home, m.
    pub alt_m: f64,
}

impl TrackSample {
    /// North, east, up of home, m.
    pub(super) fn position(&self) -> Vector3<f64> {
        Vector3::new(self.ne.x, self.ne.y, self.alt_m)
    }
}

/// Distance from a point to the line between two others, to its ends beyond them.
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
