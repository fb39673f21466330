//! The option for files under the plan on the map.

use std::path::PathBuf;

/// The files of the backdrop.
#[derive(Debug, Clone, Default, PartialEq, Eq, clap::Args)]
pub struct BackdropArgs {
    /// Map under the plan: fields, roads, no-fly zones (GeoJSON, KML, KMZ, GPX); repeatable
    ///
    /// Waypoints and legs in a no-fly zone, or outside the zone that the flight must not leave, are findings. The screen
    /// remembers the files with the file of the plan.
    #[arg(long, value_name = "FILE", help_heading = "Screen")]
    pub backdrop: Vec<PathBuf>,
}
