//! The options of `replay`.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use super::DisplayArgs;
use super::value::{self, OutputFile, RecordInstant};

/// The options of `replay`.
#[derive(Debug, Clone, PartialEq, clap::Args)]
pub struct ReplayArgs {
    /// A blackbox log (*.bbl, *.bfl, *.txt) or a recording of betadeck; a second one is shown beside the first
    ///
    /// The contents of a file decide its kind, not its name.
    #[arg(required = true, num_args = 1..=2, value_name = "FILE")]
    pub files: Vec<PathBuf>,

    /// The instant to show, with time paused: seconds since the record begins, or boot+SECONDS, the time on the screen
    /// [default: plays from the beginning]
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_parser = value::record_instant)]
    pub at: Option<RecordInstant>,

    /// The flight of a file with several logs, counted from 1 [default: the first that can be shown]
    #[arg(long, value_name = "N", value_parser = value::log_number)]
    pub log: Option<NonZeroUsize>,

    /// No screen: the events as sentences on standard output, commands of the `:` line on standard input
    ///
    /// Needs no terminal. Ends with the input.
    #[arg(long, help_heading = "Screen")]
    pub plain: bool,

    /// Start with a clean screen: not with the panels and the map of the last run, and the place in this flight
    #[arg(long, help_heading = "Screen")]
    pub fresh_screen: bool,

    /// State directory: the screen comes back as it was left [default: the one of the user]
    #[arg(long, value_name = "DIR", help_heading = "Screen")]
    pub state_dir: Option<PathBuf>,

    /// Writes the values as CSV instead of showing them, with units in the header; - is standard output
    #[arg(long, value_name = "FILE|-", help_heading = "Output")]
    pub csv: Option<OutputFile>,

    /// Rows a second in the table [default: a row for each frame of the log]
    #[arg(long, value_name = "HZ", allow_negative_numbers = true, value_parser = value::table_rate, help_heading = "Output")]
    pub samples: Option<f64>,

    /// Writes the track as GPX instead of showing it
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub gpx: Option<PathBuf>,

    /// Writes the track as KML instead of showing it
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub kml: Option<PathBuf>,

    /// Writes a report as one HTML file instead of showing the flight: map, charts, modes, events
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub report: Option<PathBuf>,

    /// Map under the track of --report: fields, roads, no-fly zones (GeoJSON, KML, KMZ, GPX); repeatable
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub backdrop: Vec<PathBuf>,

    /// The screen.
    #[command(flatten)]
    pub display: DisplayArgs,
}

impl ReplayArgs {
    /// Returns the number of the wanted flight of a file, from zero.
    pub fn number(&self) -> Option<usize> {
        self.log.map(|log| log.get() - 1)
    }

    /// Returns `true` if a file is to be written.
    pub fn exports(&self) -> bool {
        self.csv.is_some() || self.gpx.is_some() || self.kml.is_some() || self.report.is_some()
    }

    /// Returns the interval of the rows of a table, µs; `None` for a row for each frame.
    pub fn row_every_us(&self) -> Option<u64> {
        self.samples.map(|hz| ((1e6 / hz).round() as u64).max(1))
    }

    /// Checks the combination of the typed options.
    pub(super) fn check(&self) -> Result<(), String> {
        if self.samples.is_some() && self.csv.is_none() {
            return Err("--samples is the number of rows of a table: add --csv FILE or --csv -".to_owned());
        }
        if !self.backdrop.is_empty() && self.report.is_none() {
            return Err(value::BACKDROP_NEEDS_REPORT.to_owned());
        }
        if self.plain && self.csv == Some(OutputFile::Stdout) {
            return Err("--plain and --csv - both write to standard output: leave one of them out".to_owned());
        }
        if self.exports() && self.files.len() > 1 {
            return Err(
                "--csv, --gpx, --kml and --report write one recorded flight: name one file".to_owned()
            );
        }
        if self.exports() && self.at.is_some() && !self.plain {
            return Err(
                "--at is an instant of the screen, which --csv, --gpx, --kml and --report do not open"
                    .to_owned(),
            );
        }
        Ok(())
    }
}
