//! The options for warnings about waypoints.

use super::value;
use crate::plan::estimate::MAX_ALTITUDE_M;
use crate::plan::review::CLEARANCE_M;

/// The limits for warnings about a plan.
#[derive(Debug, Clone, Copy, Default, PartialEq, clap::Args)]
pub struct ReviewArgs {
    /// Altitude above home that gives a warning about a waypoint, m [default: 120]
    #[arg(long, value_name = "METRES", allow_negative_numbers = true, value_parser = value::max_altitude, help_heading = "Flight")]
    pub max_altitude_m: Option<f64>,

    /// Clearance above the ground of the elevation tiles below which a leg gets a warning, m [default: 15]
    #[arg(long, value_name = "METRES", allow_negative_numbers = true, value_parser = value::clearance, help_heading = "Flight")]
    pub clearance: Option<f64>,
}

impl ReviewArgs {
    /// Returns the altitude above home above which a waypoint gets a warning, m.
    pub fn max_altitude_m(self) -> f64 {
        self.max_altitude_m.unwrap_or(MAX_ALTITUDE_M)
    }

    /// Returns the clearance above the ground below which a leg gets a warning, m.
    pub fn clearance_m(self) -> f64 {
        self.clearance.unwrap_or(CLEARANCE_M)
    }
}
