//! The options of commands that fly one plan by the scripted pilot.

use super::value;

/// How the plan is flown and judged.
#[derive(Debug, Clone, PartialEq, clap::Args)]
pub struct MissionArgs {
    /// Altitude of the pilot's climb before the autopilot is engaged, m [default: 10]
    ///
    /// With 0 the pilot raises the throttle and engages at once: the autopilot does the climb.
    #[arg(long, value_name = "METRES", allow_negative_numbers = true, value_parser = value::takeoff, help_heading = "Flight")]
    pub takeoff: Option<f64>,

    /// How far beyond its own radius a waypoint may truly be missed, and beside its altitude, m [default: 10]
    ///
    /// More makes the result `missed`: whatever the firmware believes, the truth decides.
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
    /// Altitude of the pilot's climb, m.
    pub fn takeoff_m(&self) -> f64 {
        self.takeoff.unwrap_or(10.0)
    }

    /// How far truth may be off beyond a waypoint's own radius, m.
    pub fn tolerance_m(&self) -> f64 {
        self.tolerance.unwrap_or(10.0)
    }

    /// Simulated seconds after boot at which a flight is given up.
    pub fn timeout_s(&self) -> f64 {
        self.timeout.unwrap_or(1800.0)
    }
}
