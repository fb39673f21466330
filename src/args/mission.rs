//! The options of commands in which the scripted pilot flies one plan.

use super::value;

/// The flight and the judgement of a plan.
#[derive(Debug, Clone, Default, PartialEq, clap::Args)]
pub struct MissionArgs {
    /// Altitude of the pilot's climb before the autopilot is engaged, m [default: 10]
    ///
    /// With 0 the pilot raises the throttle and engages at once: the autopilot does the climb.
    #[arg(long, value_name = "METRES", allow_negative_numbers = true, value_parser = value::takeoff, help_heading = "Flight")]
    pub takeoff: Option<f64>,

    /// Allowed true miss of a waypoint, beyond its own radius and in altitude, m [default: 10]
    ///
    /// A larger miss makes the result `missed`: the truth decides, not the estimate of the firmware.
    #[arg(long, value_name = "METRES", allow_negative_numbers = true, value_parser = value::tolerance, help_heading = "Flight")]
    pub tolerance: Option<f64>,

    /// Gives up after this many simulated seconds since boot [default: 1800]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = value::timeout, help_heading = "Flight")]
    pub timeout: Option<f64>,

    /// Sets a setting after all other sources, such as ap_max_angle=25; repeatable
    #[arg(long, value_name = "NAME=VALUE", value_parser = value::setting, help_heading = "Flight")]
    pub set: Vec<String>,
}

impl MissionArgs {
    /// Returns the altitude of the pilot's climb, m.
    pub fn takeoff_m(&self) -> f64 {
        self.takeoff.unwrap_or(10.0)
    }

    /// Returns the allowed true miss beyond a waypoint's own radius, m.
    pub fn tolerance_m(&self) -> f64 {
        self.tolerance.unwrap_or(10.0)
    }

    /// Returns the simulated seconds after boot at which a flight is given up.
    pub fn timeout_s(&self) -> f64 {
        self.timeout.unwrap_or(1800.0)
    }
}
