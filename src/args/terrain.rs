//! The option for elevation tiles.

use std::path::PathBuf;

/// The directory of the elevation tiles.
#[derive(Debug, Clone, Default, PartialEq, Eq, clap::Args)]
pub struct TerrainArgs {
    /// Directory of elevation tiles: N40W080.hgt (also .hgt.zip and .hgt.gz) or Copernicus_DSM_COG_10_N40_00_W080_00_DEM.tif [default:
    /// betadeck/terrain in the user's data directory, if it exists]
    ///
    /// With tiles, plans are checked for their clearance above the ground (--clearance), the screen shows the ground, and
    /// --world ground=terrain makes the craft land on it. Nothing is downloaded.
    #[arg(long = "terrain", value_name = "DIR", help_heading = "Flight")]
    pub directory: Option<PathBuf>,
}
