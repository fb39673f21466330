//! The options of `rescue`.

use std::path::PathBuf;

use super::value::{self, OutputFile};
use crate::telemetry::FirmwareProfile;

/// The options of `rescue`.
#[derive(Debug, Clone, PartialEq, clap::Args)]
pub struct RescueArgs {
    /// The settings of the craft: the answer to `diff all` or `dump`; - for standard input
    #[arg(value_name = "FILE|-")]
    pub settings: PathBuf,

    /// A distance from home at which rescues begin, m; repeatable [default: 40, 150, 400 and 800]
    #[arg(long, value_name = "METRES", value_parser = clap::value_parser!(u16).range(20..=5000), help_heading = "Which")]
    pub distance: Vec<u16>,

    /// Number of directions from home in which they begin [default: 8]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=36), help_heading = "Which")]
    pub directions: Option<u16>,

    /// The wind of the flights that are not flown in calm air, m/s [default: 8]
    #[arg(long, value_name = "SPEED", value_parser = value::gust, help_heading = "Air")]
    pub wind: Option<f64>,

    /// Airframe: iris, five-inch, or a TOML file [default: iris]
    #[arg(long, value_name = "NAME|FILE", help_heading = "Craft")]
    pub airframe: Option<String>,

    /// Laws of the autopilot: guide, master [default: by the version in the file]
    #[arg(long, value_name = "NAME", hide_possible_values = true, value_parser = value::profile, help_heading = "Craft")]
    pub profile: Option<FirmwareProfile>,

    /// Number of flights at the same time [default: one per processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=256), help_heading = "How")]
    pub jobs: Option<u32>,

    /// Writes a scenario with the worst flights, for `check` and `open`
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub scenario: Option<PathBuf>,

    /// Writes the answer and all flights as one JSON object; - is standard output, in place of the sentences
    #[arg(long, value_name = "FILE|-", help_heading = "Output")]
    pub json: Option<OutputFile>,
}
