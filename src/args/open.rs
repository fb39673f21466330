//! The options of `open`.

use std::path::PathBuf;

use super::firmware::{FirmwareArgs, FirmwarePortArgs};
use super::{DisplayArgs, value};
use crate::telemetry::FirmwareProfile;

/// The options of `open`.
#[derive(Debug, Clone, PartialEq, clap::Args)]
pub struct OpenArgs {
    /// A built-in scenario's name or a file, a flight of a campaign, RUN.jsonl:1234, or a recording, FILE.flight
    #[arg(value_name = "SCENARIO|RUN:N|RECORDING")]
    pub scenario: String,

    /// The instant to show: seconds after the engagement, or boot+SECONDS [default: the end]
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = value::instant)]
    pub at: Option<value::Instant>,

    /// The case, or a part of its name that only one has [default: the first]
    #[arg(long, value_name = "NAME")]
    pub case: Option<String>,

    /// The seed [default: the case's first]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = value::seed)]
    pub seed: Option<u64>,

    /// Laws of the embedded autopilot: guide, master [default: the scenario's, else guide]
    #[arg(long, value_name = "NAME", hide_possible_values = true, value_parser = value::profile, conflicts_with = "firmware")]
    pub profile: Option<FirmwareProfile>,

    /// Lets a scenario name files that are not in its folder: plans, settings, airframes
    #[arg(long)]
    pub any_folder: bool,

    /// No screen: the events as sentences on standard output, commands of the `:` line on standard input
    ///
    /// Needs no terminal. After the end of the input the flight waits, until `quit` or a signal ends it.
    #[arg(long, help_heading = "Screen")]
    pub plain: bool,

    /// Start with a clean screen: not with the panels and the map of the last run, and the place in this flight
    #[arg(long, help_heading = "Screen")]
    pub fresh_screen: bool,

    /// State directory: the screen comes back as it was left [default: the one of the user]
    #[arg(long, value_name = "DIR", help_heading = "Screen")]
    pub state_dir: Option<PathBuf>,

    /// The choice of the firmware.
    #[command(flatten)]
    pub firmware: FirmwareArgs,

    /// The ports of the firmware.
    #[command(flatten)]
    pub firmware_ports: FirmwarePortArgs,

    /// The screen.
    #[command(flatten)]
    pub display: DisplayArgs,
}
