//! The options of `compare`.

use std::path::PathBuf;

use super::firmware::{FirmwareChoice, FirmwareLinkArgs, FirmwarePortArgs};
use super::plan_arg::PlanArg;
use super::value::{self, OutputFile};
use super::{FlightArgs, MissionArgs, help};
use crate::link::conventions::FirmwareClock;

/// The longest flight of a comparison, s. Its whole track is kept.
const MAX_S: f64 = 7200.0;

/// The options of `compare`.
#[derive(Debug, Clone, PartialEq, clap::Args)]
// Each flight starts from defaults in any case.
#[command(
    after_help = help::COMPARE,
    mut_arg("state_dir", |option| option.hide(true)),
    mut_arg("fresh", |option| option.hide(true))
)]
pub struct CompareArgs {
    /// Plan to fly: a built-in plan's name or a file (*.toml, *.txt, - for standard input)
    pub plan: PlanArg,

    /// Firmware to compare with the embedded one; given twice, the two to compare: PATH, attach, embedded
    /// [default: that of --betaloop]
    #[arg(long, value_name = "WHICH", help_heading = "Firmware")]
    pub firmware: Vec<FirmwareChoice>,

    /// Blackbox log of a flight of the plan to compare with the same flight in the simulation: its home, settings, sticks and
    /// switches; of several logs in the file the longest
    #[arg(
        long,
        value_name = "FILE",
        conflicts_with_all = ["firmware", "betaloop", "seeds", "repeat", "jobs", "blackbox"],
        help_heading = "Flight"
    )]
    pub log: Option<PathBuf>,

    /// Records the simulated flight beside the log, to show both with betadeck replay LOG FILE
    #[arg(long, value_name = "FILE", requires = "log", value_parser = value::output_path, help_heading = "Output")]
    pub record: Option<PathBuf>,

    /// The start of the firmwares and the packets to them.
    #[command(flatten)]
    pub link: FirmwareLinkArgs,

    /// The ports of the firmwares.
    #[command(flatten)]
    pub firmware_ports: FirmwarePortArgs,

    /// Flies each firmware with these seeds, such as 1..20, and marks what is beyond their spread [default: --seed]
    #[arg(long, value_name = "A..B", value_parser = value::seeds, conflicts_with_all = ["seed", "repeat"], help_heading = "Flight")]
    pub seeds: Option<value::Seeds>,

    /// Number of flights at the same time [default: one per processor; on the wall clock: 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=256), help_heading = "Flight")]
    pub jobs: Option<u32>,

    /// Flights of each firmware on the wall clock, which are never quite the same [default: 3; attach: 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100), help_heading = "Flight")]
    pub repeat: Option<u32>,

    /// Writes the comparison as JSON; - is standard output, in place of the table
    #[arg(long, value_name = "FILE|-", help_heading = "Output")]
    pub json: Option<OutputFile>,

    /// Draws both tracks, the legs and the waypoints
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub svg: Option<PathBuf>,

    /// Writes a report as one HTML file: the table, both tracks, their altitudes
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub report: Option<PathBuf>,

    /// Writes the table as Markdown, for a pull request: before and after
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub markdown: Option<PathBuf>,

    /// Map under the tracks of --report: fields, roads, no-fly zones (GeoJSON, KML, KMZ, GPX); repeatable
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub backdrop: Vec<PathBuf>,

    /// Writes the blackbox log of each flight of the embedded firmware into a folder; of one flight into a file, too
    #[arg(long, value_name = "FILE|DIR", value_parser = value::output_path, help_heading = "Output")]
    pub blackbox: Option<PathBuf>,

    /// The flight and the judgement of the plan.
    #[command(flatten)]
    pub mission: MissionArgs,

    /// The craft, its position and the air.
    #[command(flatten)]
    pub flight: FlightArgs,
}

impl CompareArgs {
    /// Returns the number of flights of a firmware with one seed. The embedded one, and an executable in simulated time,
    /// fly the same each time. A firmware that is already running cannot be made to forget the previous flight.
    ///
    /// # Errors
    /// Returns the reason why it cannot be flown the requested number of times.
    pub fn flights_of(&self, firmware: &FirmwareChoice, clock: FirmwareClock) -> Result<u32, String> {
        match (firmware, clock, self.repeat) {
            (FirmwareChoice::Embedded, _, _)
            | (FirmwareChoice::Attach, _, None | Some(1))
            | (FirmwareChoice::Executable(_), FirmwareClock::Sim, _) => Ok(1),
            (FirmwareChoice::Executable(_), FirmwareClock::Real, times) => Ok(times.unwrap_or(3)),
            (FirmwareChoice::Attach, _, Some(times)) => Err(format!(
                "--repeat {times}: a firmware that is running already (--firmware attach) is not restarted for each \
                 flight, so it flies once; write --repeat 1, or name its executable"
            )),
        }
    }

    /// Checks the combination of the typed options.
    pub(super) fn check(&self) -> Result<(), String> {
        if self.firmware.len() > 2 {
            return Err("--firmware is given once, to compare with the embedded one, or twice".to_owned());
        }
        if !self.backdrop.is_empty() && self.report.is_none() {
            return Err(value::BACKDROP_NEEDS_REPORT.to_owned());
        }
        if self.flight.state_dir.is_some() {
            return Err("--state-dir: in compare each flight starts from defaults, so that all start alike; give the \
                        differences with --settings FILE"
                .to_owned());
        }
        if self.mission.timeout.is_some_and(|seconds| seconds > MAX_S) {
            return Err(format!("--timeout: allowed are 1 to {MAX_S} s here, because whole tracks are kept"));
        }
        Ok(())
    }
}
