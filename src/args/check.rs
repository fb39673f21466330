//! The options of `check`.

use std::path::PathBuf;

use super::value::{self, OutputFile};
use super::{FirmwareArgs, FirmwarePortArgs, PlanArg, help};
use crate::scenario::MAX_FLIGHTS;
use crate::telemetry::FirmwareProfile;

/// The options for a remote firmware. They conflict with options that fly only the embedded firmware, or do not fly.
const FIRMWARE_OPTIONS: [&str; 10] = [
    "firmware",
    "firmware_arg",
    "betaloop",
    "yes",
    "clock",
    "fdm_stamps",
    "tcp_port",
    "udp_ports",
    "fdm_dialect",
    "motor_order",
];

/// The greatest value of `--max-flights`.
pub const MAX_ALLOWED_FLIGHTS: i64 = 1_000_000;

/// The options of `check`.
#[derive(Debug, Clone, PartialEq, Default, clap::Args)]
#[command(after_help = help::CHECK)]
pub struct CheckArgs {
    /// Scenarios: built-in names, files, directories, - for standard input [default: all built-in ones but the slow]
    #[arg(value_name = "NAME|FILE|DIR|-")]
    pub what: Vec<String>,

    /// Lists the scenarios and their cases instead of flying them
    #[arg(long, conflicts_with_all = FIRMWARE_OPTIONS, help_heading = "Which")]
    pub list: bool,

    /// Only flights with this text in `SCENARIO CASE`
    #[arg(long, value_name = "TEXT", help_heading = "Which")]
    pub filter: Option<String>,

    /// Flies the scenarios marked slow, too
    #[arg(long, help_heading = "Which")]
    pub slow: bool,

    /// Lets a scenario name files that are not in its folder: plans, settings, airframes
    #[arg(long, help_heading = "Which")]
    pub any_folder: bool,

    /// Flies each case with these seeds, such as 1..20, instead of its own
    #[arg(long, value_name = "A..B", value_parser = value::seeds, help_heading = "Which")]
    pub seeds: Option<value::Seeds>,

    /// Laws of the embedded autopilot in each flight: guide, master [default: the scenario's, else guide]
    #[arg(long, value_name = "NAME", hide_possible_values = true, value_parser = value::profile, conflicts_with_all = FIRMWARE_OPTIONS, help_heading = "How")]
    pub profile: Option<FirmwareProfile>,

    /// Flies each flight this many times and compares the results to the last bit [default: 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000), help_heading = "How")]
    pub repeat: Option<u32>,

    /// The most flights of the run; more are refused before the start [default: 10000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=MAX_ALLOWED_FLIGHTS), help_heading = "How")]
    pub max_flights: Option<u32>,

    /// Number of flights at the same time [default: one per processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=256), help_heading = "How")]
    pub jobs: Option<u32>,

    /// Ends at the first flight that fails
    #[arg(long, help_heading = "How")]
    pub fail_fast: bool,

    /// Ends with 125 if the firmware cannot be flown, for `git bisect run` over builds of it
    ///
    /// `git bisect run` skips a commit at this exit code. 0 and 1 are a good and a bad commit, as without this option.
    #[arg(long, conflicts_with_all = ["list", "new", "watch"], help_heading = "How")]
    pub bisect: bool,

    /// Flies again after every change of one of the files, until Ctrl-C
    #[arg(long, conflicts_with_all = ["list", "new"], help_heading = "How")]
    pub watch: bool,

    /// Writes one line of JSON for each flight; - is standard output
    #[arg(long, value_name = "FILE|-", help_heading = "Output")]
    pub json: Option<OutputFile>,

    /// Writes a JUnit file with one testcase for each case and seed
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub junit: Option<PathBuf>,

    /// Writes a summary in Markdown, for a pull request
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub markdown: Option<PathBuf>,

    /// Writes a report as one HTML file: all expectations with their margins, and the flights, the failed ones first
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub report: Option<PathBuf>,

    /// Map under the tracks of --report: fields, roads, no-fly zones (GeoJSON, KML, KMZ, GPX); repeatable
    #[arg(long, value_name = "FILE", requires = "report", help_heading = "Output")]
    pub backdrop: Vec<PathBuf>,

    /// Writes the blackbox log of each flight of the embedded firmware into a folder; of one flight into a file, too
    #[arg(long, value_name = "FILE|DIR", value_parser = value::output_path, conflicts_with_all = ["list", "watch"], help_heading = "Output")]
    pub blackbox: Option<PathBuf>,

    /// Flies this plan and prints a scenario that expects the same behaviour, with sensible margins
    #[arg(long, value_name = "PLAN", conflicts_with_all = ["what", "list", "filter", "json", "junit", "markdown", "report", "blackbox"], conflicts_with_all = FIRMWARE_OPTIONS, help_heading = "Output")]
    pub new: Option<PlanArg>,

    /// The choice of the firmware.
    #[command(flatten)]
    pub firmware: FirmwareArgs,

    /// The ports of the firmware.
    #[command(flatten)]
    pub firmware_ports: FirmwarePortArgs,
}

impl CheckArgs {
    /// Returns the most flights of the run.
    pub fn most_flights(&self) -> usize {
        self.max_flights.map_or(MAX_FLIGHTS, |flights| flights as usize)
    }
}
