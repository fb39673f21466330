//! What a display needs to draw the timeline.

use std::sync::Arc;

use super::{IdleSpan, Mark};
use crate::signals::SimTime;

/// How far the recording reaches, what happened in it, and where in it the shown instant is: the time of the vehicle.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct TimelineView {
    /// The earliest instant that can be shown.
    pub first: SimTime,
    /// The newest instant, from where the flight goes on.
    pub head: SimTime,
    /// The craft is armed at the newest instant.
    pub head_is_armed: bool,
    /// An earlier instant is shown, while the flight waits.
    pub rewound: bool,
    /// How often the flight was flown on from an earlier instant.
    pub branch: u32,
    /// The instant from which it was last flown on.
    pub branched_at: SimTime,
    /// What happened, the oldest first.
    pub marks: Arc<Vec<Mark>>,
    /// Long parts in which nothing happens, the oldest first: they are drawn folded.
    pub folds: Vec<IdleSpan>,
}
