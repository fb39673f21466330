//! The state of the map: its window, and the edit with the cursor or the mouse.

use std::time::Duration;

use crate::ui::model::map_point::MapPoint;
use crate::ui::model::plan_id::PlanId;

/// The mode that selects the window of the map.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub enum MapMode {
    /// The map shows the whole plan and the craft.
    #[default]
    Fit,
    /// The craft stays in the middle, at this many metres per column.
    Follow(f64),
    /// The user has chosen the window.
    Free {
        /// The middle, north, m.
        n: f64,
        /// The middle, east, m.
        e: f64,
        /// Metres per column.
        scale: f64,
    },
    /// The user has chosen the window, and it moves as far as keeps the craft in it.
    Near {
        /// The middle, north, m.
        n: f64,
        /// The middle, east, m.
        e: f64,
        /// Metres per column.
        scale: f64,
    },
}

/// The largest distance of the middle of the map from the boot place, m: half around the Earth.
const FARTHEST_M: f64 = 20_100_000.0;

impl MapMode {
    /// Returns the mode, or the default one if its numbers are impossible, as a file can have them.
    pub(in crate::ui) fn possible(self) -> Self {
        let is_place = |value: f64| value.abs() <= FARTHEST_M;
        let is_possible = match self {
            Self::Fit => true,
            Self::Follow(scale) => scale.is_finite(),
            Self::Free { n, e, scale } | Self::Near { n, e, scale } => {
                is_place(n) && is_place(e) && scale.is_finite()
            }
        };
        if is_possible { self } else { Self::default() }
    }
}

/// The state of the map panel.
#[derive(Debug, Default)]
pub struct MapState {
    pub mode: MapMode,
    /// The cursor, while the user edits with it.
    pub(in crate::ui) edit: Option<MapCursor>,
    /// The item being moved.
    pub(in crate::ui) moving: Option<Moving>,
    /// The measure tool, while it is used.
    pub(in crate::ui) measure: Option<Measure>,
    /// `true` to show the grid of coordinates.
    pub(in crate::ui) grid: bool,
    /// `true` if the course of the craft is up instead of north.
    pub(in crate::ui) course_up: bool,
    /// `true` to leave out the tracks of earlier flights.
    pub(in crate::ui) hides_past: bool,
    /// The time at which another revision of the plan was chosen, wall clock. The map shows it for a while.
    pub(in crate::ui) revision_at: Option<Duration>,
}

/// A line whose length and bearing are measured.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in crate::ui) struct Measure {
    /// The place of the cursor, m.
    pub cursor: MapPoint,
    /// The first point, m.
    pub from: Option<MapPoint>,
    /// The second point, m; `None` while the cursor is its place.
    pub to: Option<MapPoint>,
}

/// An item of the plan that has a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MapItem {
    Waypoint(usize),
    /// Home of the plan.
    Home,
    /// The fence, which is picked up at its ring.
    Fence,
}

/// The item being moved, and its current place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::ui) struct Moving {
    pub item: MapItem,
    /// The place, m.
    pub place: MapPoint,
    /// `true` once it has left the place where it was picked up.
    pub moved: bool,
    /// `true` if the mouse moves it: it is put down when the button is released.
    pub by_mouse: bool,
    /// The plan and revision in which it was picked up.
    pub of: (PlanId, usize),
}

/// The keyboard's cursor on the map.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in crate::ui) struct MapCursor {
    /// The place, m.
    pub place: MapPoint,
}
