//! The data that a display needs to draw the timeline.

use std::sync::Arc;

use super::{IdleSpan, Mark};
use crate::signals::SimTime;

/// The reach of the recording, its marks, and the shown instant, which is the time of the vehicle.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct TimelineView {
    /// The earliest instant that can be shown.
    pub first: SimTime,
    /// Newest instant, from which the flight continues.
    pub head: SimTime,
    /// `true` if the craft is armed at the newest instant.
    pub head_is_armed: bool,
    /// `true` while an earlier instant is shown and the flight waits.
    pub rewound: bool,
    /// `true` if the flight is recorded as pictures.
    pub is_pictures: bool,
    /// `true` if the flight cannot be continued from an earlier instant.
    pub cannot_continue: bool,
    /// While a firmware that has ended flies the flight again: the instant that it has reached, and the one that it goes
    /// to.
    pub flying_again: Option<(SimTime, SimTime)>,
    /// Number of times that the flight was continued from an earlier instant.
    pub branch: u32,
    /// Instant from which it was last continued.
    pub branched_at: SimTime,
    /// Events, oldest first.
    pub marks: Arc<Vec<Mark>>,
    /// Long parts without events, oldest first. A display draws them folded.
    pub folds: Vec<IdleSpan>,
}
