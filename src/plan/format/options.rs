//! The choices of the user for a file that leaves something open.

use super::{HomePosition, SettingCheck};
use crate::plan::WaypointType;

/// Choices for reading.
#[derive(Debug, Clone)]
pub struct ReadOptions {
    /// The check of the settings in the file.
    pub check: SettingCheck,
    /// The home for a file that has none, or none with an altitude above sea level.
    pub home: Option<HomePosition>,
    /// The mission of a file with several, from 1.
    pub mission: usize,
    /// The line or route of a file with several: its number from 1, or its name.
    pub feature: Option<String>,
    /// Takes the outer ring of a polygon as a plan.
    pub ring: bool,
    /// The type of a plain waypoint of a file that does not say how it is passed: FLYBY or FLYOVER.
    pub waypoint_as: WaypointType,
    /// The altitude above home for points without one, m.
    pub altitude_m: Option<f64>,
    /// Leaves out points of a line that are nearer than this to the line without them, m.
    pub simplify_m: Option<f64>,
    /// The ground is flat: an altitude above ground is one above home.
    pub flat: bool,
    /// Reads more waypoints than a plan holds, too.
    pub long: bool,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self {
            check: |_, _| Ok(()),
            home: None,
            mission: 1,
            feature: None,
            ring: false,
            waypoint_as: WaypointType::Flyby,
            altitude_m: None,
            simplify_m: None,
            flat: false,
            long: false,
        }
    }
}

/// Choices for writing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WriteOptions {
    /// Writes altitudes above sea level where the format also has those above ground.
    pub absolute: bool,
}
