//! The waypoints of a mission, and the items that cannot be taken.

use crate::plan::format::long::hint;
use crate::plan::format::loss::Finding;
use crate::plan::{MAX_WAYPOINTS, Waypoint};

/// The waypoints of a mission.
#[derive(Debug, Clone, PartialEq, Default)]
pub(in crate::plan::format) struct Mapping {
    /// Each waypoint, with the index of its item.
    pub(in crate::plan::format) waypoints: Vec<(Waypoint, usize)>,
    pub(in crate::plan::format) findings: Vec<Finding>,
    pub(in crate::plan::format) faults: Vec<Fault>,
    /// The index of the first jump that is flown.
    pub(super) jump: Option<usize>,
}

impl Mapping {
    /// Returns the fault of a mission with too many waypoints.
    pub(in crate::plan::format) fn too_many(&self) -> Option<Fault> {
        let count = self.waypoints.len();
        let &(_, first) = self.waypoints.get(MAX_WAYPOINTS)?;
        let (item, message) = match self.jump {
            Some(jump) => (jump, format!("with its jumps the mission has {count} waypoints")),
            None => (first, format!("waypoint {MAX_WAYPOINTS} does not fit: the file has {count}")),
        };
        Some(Fault { item, message, hint: hint() })
    }
}

/// An item that cannot be taken.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::plan::format) struct Fault {
    /// The index of the item.
    pub(in crate::plan::format) item: usize,
    pub(in crate::plan::format) message: String,
    pub(in crate::plan::format) hint: String,
}
