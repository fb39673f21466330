//! The options of `compare`.

use std::path::PathBuf;

use super::firmware::{FirmwareChoice, FirmwareLinkArgs, FirmwarePortArgs};
use super::plan_arg::PlanArg;
use super::value::{self, OutputFile};
use super::{FlightArgs, MissionArgs, help};

/// Longest flight that is compared, s: its whole track is kept.
const LONGEST_S: f64 = 7200.0;

/// The options of `compare`.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(after_help = help::COMPARE)]
pub struct CompareArgs {
    /// Plan to fly: a built-in plan's name or a file (*.toml, *.txt, - for standard input)
    pub plan: PlanArg,

    /// What flies beside the embedded firmware, or with two the one beside the other: PATH, attach, embedded
    #[arg(long, value_name = "WHICH", required_unless_present = "betaloop", help_heading = "Firmware")]
    pub firmware: Vec<FirmwareChoice>,

    /// How they are started and fed.
    #[command(flatten)]
    pub link: FirmwareLinkArgs,

    /// How they are reached.
    #[command(flatten)]
    pub firmware_ports: FirmwarePortArgs,

    /// Flights of each firmware outside, which are never quite the same [default: 3]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100), help_heading = "Flight")]
    pub repeat: Option<u32>,

    /// Writes the comparison as JSON; - is standard output, in place of the table
    #[arg(long, value_name = "FILE|-", help_heading = "Output")]
    pub json: Option<OutputFile>,

    /// Draws both tracks, the legs and the waypoints
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub svg: Option<PathBuf>,

    /// How the plan is flown and judged.
    #[command(flatten)]
    pub mission: MissionArgs,

    /// What flies, where and in which air.
    #[command(flatten)]
    pub flight: FlightArgs,
}

impl CompareArgs {
    /// Flights of a firmware outside.
    #[must_use]
    pub fn repeat(&self) -> u32 {
        self.repeat.unwrap_or(3)
    }

    /// What is wrong with the combination of what was typed.
    pub(super) fn check(&self) -> Result<(), String> {
        if self.firmware.len() > 2 {
            return Err("--firmware is given once, to compare with the embedded one, or twice".to_owned());
        }
        if self.mission.timeout.is_some_and(|seconds| seconds > LONGEST_S) {
            return Err(format!("--timeout: allowed are 1 to {LONGEST_S} s here, for whole tracks are kept"));
        }
        Ok(())
    }
}
