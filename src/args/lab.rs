//! The options of `lab`.

use std::path::PathBuf;

use super::value::{self, OutputFile};
use super::{FirmwarePortArgs, help};

/// The options of `lab`.
#[derive(Debug, Clone, PartialEq, Default, clap::Args)]
#[command(after_help = help::LAB)]
pub struct LabArgs {
    /// The executable to judge alone, or embedded for the embedded firmware in the profile master
    #[arg(value_name = "EXECUTABLE", required_unless_present_any = ["base", "list"], conflicts_with_all = ["base", "head"])]
    pub alone: Option<PathBuf>,

    /// The executable before the change, or embedded
    #[arg(long, value_name = "EXECUTABLE", requires = "head", help_heading = "Firmware")]
    pub base: Option<PathBuf>,

    /// The executable with the change, or embedded
    #[arg(long, value_name = "EXECUTABLE", requires = "base", help_heading = "Firmware")]
    pub head: Option<PathBuf>,

    /// An argument for both executables; repeatable
    #[arg(long, value_name = "ARG", allow_hyphen_values = true, help_heading = "Firmware")]
    pub firmware_arg: Vec<String>,

    /// The ports of the executables.
    #[command(flatten)]
    pub firmware_ports: FirmwarePortArgs,

    /// Lists the flights of the programme instead of flying them
    #[arg(long, help_heading = "Which")]
    pub list: bool,

    /// Only flights with this text in `SCENARIO CASE`
    #[arg(long, value_name = "TEXT", help_heading = "Which")]
    pub filter: Option<String>,

    /// A plan or a scenario to fly beside the programme, first; repeatable
    #[arg(long, value_name = "FILE", help_heading = "Which")]
    pub with: Vec<PathBuf>,

    /// Other seeds and other random missions
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1_000_000), help_heading = "Which")]
    pub seed: u32,

    /// Flies each case with these seeds, such as 1..20, instead of its own
    #[arg(long, value_name = "A..B", value_parser = value::seeds, conflicts_with = "seed", help_heading = "Which")]
    pub seeds: Option<value::Seeds>,

    /// Time after which no further flight begins, such as 120s or 10min [default: 170s, for an answer in three minutes]
    #[arg(long, value_name = "TIME", value_parser = value::wall_time, help_heading = "How")]
    pub budget: Option<f64>,

    /// Number of flights at the same time [default: one per processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=256), help_heading = "How")]
    pub jobs: Option<u32>,

    /// Writes the signals of each flight into a folder, a CSV file each
    #[arg(long, value_name = "DIR", value_parser = value::output_path, help_heading = "Output")]
    pub keep: Option<PathBuf>,

    /// Writes the whole answer and all flights as JSON; - is standard output, in place of the text
    #[arg(long, value_name = "FILE|-", help_heading = "Output")]
    pub json: Option<OutputFile>,

    /// Writes a JUnit file with one testcase for each flight of the executable to judge
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub junit: Option<PathBuf>,

    /// Writes the answer in Markdown, for a pull request
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub markdown: Option<PathBuf>,

    /// Writes for each flight and measure the median and the spread of both, in Markdown
    #[arg(long, value_name = "FILE", value_parser = value::output_path, requires = "base", help_heading = "Output")]
    pub likeness: Option<PathBuf>,

    /// Writes the answer as one HTML file
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub html: Option<PathBuf>,
}
