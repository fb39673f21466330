//! The options of `fly`.

use std::path::PathBuf;

use super::plan_arg::PlanArg;
use super::value::{self, OutputFile};
use super::{FirmwareArgs, FirmwarePortArgs, FlightArgs, MissionArgs, ReviewArgs, Speed, TroubleArgs};

/// The options of `fly`.
#[derive(Debug, Clone, PartialEq, clap::Args)]
pub struct FlyArgs {
    /// Plan to fly: a built-in plan's name or a file (*.toml, *.txt, - for standard input)
    pub plan: PlanArg,

    /// Writes events (and samples) as JSON lines; - is standard output
    #[arg(long, value_name = "FILE|-", help_heading = "Output")]
    pub json: Option<OutputFile>,

    /// Writes samples of all signals as CSV; - is standard output, in place of the sentences
    #[arg(long, value_name = "FILE|-", help_heading = "Output")]
    pub csv: Option<OutputFile>,

    /// Samples a second of simulated time [default: none in JSON lines, 10 in CSV]
    #[arg(long, value_name = "HZ", allow_negative_numbers = true, value_parser = value::samples, help_heading = "Output")]
    pub samples: Option<f64>,

    /// Writes the track as GPX
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub gpx: Option<PathBuf>,

    /// Writes the track as KML, with lines in the colours of the autopilot's states
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub kml: Option<PathBuf>,

    /// Writes the track as GeoJSON, with a line for each state of the autopilot
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub geojson: Option<PathBuf>,

    /// Records the flight, to open it again on the screen with betadeck open
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub record: Option<PathBuf>,
    /// Writes a report as one HTML file: verdict, map, charts, states with their guards, margins
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub report: Option<PathBuf>,

    /// Writes the verdict, the margins and the states as Markdown, for a pull request
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub markdown: Option<PathBuf>,

    /// Map under the track of --report: fields, roads, no-fly zones (GeoJSON, KML, KMZ, GPX); repeatable
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub backdrop: Vec<PathBuf>,

    /// Writes the blackbox log of the embedded firmware; in a folder it gets the name of the plan
    #[arg(long, value_name = "FILE|DIR", value_parser = value::output_path, help_heading = "Output")]
    pub blackbox: Option<PathBuf>,

    /// Replaces files that are not outputs of an earlier flight, too
    #[arg(long, help_heading = "Output")]
    pub force: bool,

    /// Points a second of simulated time in the KML and GeoJSON tracks [default: 1]
    #[arg(long, value_name = "HZ", value_parser = value::track_rate, help_heading = "Output")]
    pub track_hz: Option<f64>,

    /// The flight and the judgement of the plan.
    #[command(flatten)]
    pub mission: MissionArgs,

    /// The limits for warnings about waypoints.
    #[command(flatten)]
    pub review: ReviewArgs,

    /// The sticks and the faults.
    #[command(flatten)]
    pub trouble: TroubleArgs,

    /// The choice of the firmware.
    #[command(flatten)]
    pub firmware: FirmwareArgs,

    /// The ports of the firmware.
    #[command(flatten)]
    pub firmware_ports: FirmwarePortArgs,

    /// The craft, its position and the air.
    #[command(flatten)]
    pub flight: FlightArgs,
}

impl FlyArgs {
    /// Returns the speed as a multiple of real time; infinite = as fast as the machine allows, the default.
    pub fn speed(&self) -> f64 {
        self.flight.speed.map_or(f64::INFINITY, |Speed(speed)| speed)
    }

    /// Returns `true` if the events go to standard output as sentences.
    pub fn has_sentences(&self) -> bool {
        self.json.is_none() && self.csv != Some(OutputFile::Stdout)
    }

    /// Returns the interval of the points of the KML and GeoJSON tracks, µs.
    pub fn track_every_us(&self) -> u64 {
        ((1e6 / self.track_hz.unwrap_or(1.0)).round() as u64).max(1)
    }

    /// Checks the combination of the typed options.
    pub(super) fn check(&self) -> Result<(), String> {
        if self.samples.is_some_and(|hz| hz > 0.0) && self.json.is_none() && self.csv.is_none() {
            return Err(
                "--samples needs --json or --csv: samples are JSON lines or rows; add --json FILE or \
                        --csv FILE"
                    .to_owned(),
            );
        }
        if self.samples.is_some_and(|hz| hz <= 0.0) && self.csv.is_some() {
            return Err(
                "--samples 0 leaves no rows for --csv: leave it out, or write a number above 0".to_owned()
            );
        }
        if !self.backdrop.is_empty() && self.report.is_none() {
            return Err(value::BACKDROP_NEEDS_REPORT.to_owned());
        }
        if self.track_hz.is_some() && self.kml.is_none() && self.geojson.is_none() {
            return Err("--track-hz needs a track: add --kml FILE or --geojson FILE".to_owned());
        }
        Ok(())
    }
}
