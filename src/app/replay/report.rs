//! The page about a recorded flight.

use std::path::Path;

use crate::args::ReplayArgs;
use crate::files::output_file::StreamedOutput;
use crate::flight::setup::{LoggedSetting, logged_settings};
use crate::flight_log::LogFlight;
use crate::headless::{report, setup};
use crate::plan::FlightPlan;
use crate::plan::feature::Feature;
use crate::process::error::AppError;
use crate::recording::Recording;
use crate::replay::Overview;
use crate::report::flight::{FlightReport, ReportedSettings};
use crate::report::html;
use crate::vehicle::VehicleCommand;

/// The beginnings of the lines of a header that describe the format.
const FORMAT: [&str; 3] = ["Field ", "Product", "Data version"];

/// The page and what it needs besides the flight.
pub(super) struct Report<'a> {
    path: &'a Path,
    backdrop: Vec<Feature>,
    command: String,
}

impl<'a> Report<'a> {
    /// Reads the maps under the track of a report, if one is wanted. `repeat` are the words of the command without its
    /// outputs.
    ///
    /// # Errors
    /// Returns the error in a map.
    pub(super) fn prepare(args: &'a ReplayArgs, repeat: &[String]) -> Result<Option<Self>, AppError> {
        let Some(path) = args.report.as_deref() else { return Ok(None) };
        Ok(Some(Self { path, backdrop: report::backdrop(&args.backdrop)?, command: report::command(repeat) }))
    }

    /// Writes the page about a log.
    ///
    /// # Errors
    /// Returns the error of the output.
    pub(super) fn write_log(self, name: &str, log: &LogFlight, overview: &Overview) -> Result<(), AppError> {
        let mut report = FlightReport::from_past(name, overview);
        let is_setting = |name: &str| !FORMAT.iter().any(|format| name.starts_with(format));
        let lines = log.header().lines().filter(|(name, _)| is_setting(name));
        let (changed, others) = logged_settings(lines).into_iter().partition(LoggedSetting::is_changed);
        let rows = |settings: Vec<LoggedSetting>| {
            settings
                .into_iter()
                .map(|LoggedSetting { name, value, default }| [name, value, default.unwrap_or_default()])
                .collect()
        };
        report.settings = Some(ReportedSettings::Logged { changed: rows(changed), others: rows(others) });
        self.write(report)
    }

    /// Writes the page about a recording.
    ///
    /// # Errors
    /// Returns the error of the output.
    pub(super) fn write_recording(
        self,
        name: &str,
        recording: &Recording,
        overview: &Overview,
    ) -> Result<(), AppError> {
        let settings = settings(recording);
        self.write(FlightReport { settings, ..FlightReport::from_past(name, overview) })
    }

    fn write(self, report: FlightReport) -> Result<(), AppError> {
        let Self { path, backdrop, command } = self;
        let report = FlightReport { backdrop, command: Some(command), ..report };
        let mut file = StreamedOutput::begin(path)?;
        file.add(html::flight_page(&report, &report::program()).as_bytes())?;
        file.finish()
    }
}

/// Returns the settings of a recorded craft that differ from their defaults, with all that lines, messages and uploads have
/// changed; `None` if the recording has no inputs.
fn settings(recording: &Recording) -> Option<ReportedSettings> {
    let mut craft = setup::build(recording.flight().ok()?, &mut Vec::new()).ok()?;
    for input in recording.inputs() {
        if let VehicleCommand::Line(_)
        | VehicleCommand::Message(_)
        | VehicleCommand::Upload(_)
        | VehicleCommand::BeginCli(..)
        | VehicleCommand::EndCli(_)
        | VehicleCommand::EndAllCli
        | VehicleCommand::Restart(_) = input
        {
            craft.apply(input);
        }
    }
    report::about(&craft, "", &FlightPlan::default()).settings
}
