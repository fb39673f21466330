//! The options that say which waypoints are warned of.

use super::value;
use crate::plan::estimate::MAX_ALTITUDE_M;

/// What a user finds worth a warning.
#[derive(Debug, Clone, Copy, Default, PartialEq, clap::Args)]
pub struct ReviewArgs {
    /// Altitude above home above which a waypoint is warned of, m [default: 120]
    #[arg(long, value_name = "METRES", allow_negative_numbers = true, value_parser = value::max_altitude, help_heading = "Flight")]
    pub max_altitude_m: Option<f64>,
}

impl ReviewArgs {
    /// Altitude above home above which a waypoint is warned of, m.
    pub fn max_altitude_m(self) -> f64 {
        self.max_altitude_m.unwrap_or(MAX_ALTITUDE_M)
    }
}
