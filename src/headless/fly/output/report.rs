//! The report about a flight, written at its end.

use std::path::PathBuf;

use crate::args::FlyArgs;
use crate::events::Event;
use crate::files::output_file::StreamedOutput;
use crate::headless::report;
use crate::plan::feature::Feature;
use crate::plan::format::PlanFile;
use crate::process::error::AppError;
use crate::report::flight::{self, FlightReport, ReportedSettings, Verdict};
use crate::report::{End, html};
use crate::terrain::Relief;
use crate::vehicle::Vehicle;

/// The facts of a report that the flight does not have.
#[derive(Debug, Default)]
pub(in crate::headless::fly) struct Beside {
    /// The command that gives the flight again.
    pub(in crate::headless::fly) command: String,
    pub(in crate::headless::fly) backdrop: Vec<Feature>,
    pub(in crate::headless::fly) relief: Option<Relief>,
    /// The name of a remote firmware, and the lines that it got.
    pub(in crate::headless::fly) firmware: Option<(String, Vec<String>)>,
}

/// The report and its files.
pub(super) struct Report {
    report: FlightReport,
    relief: Option<Relief>,
    html: Option<StreamedOutput>,
    markdown: Option<StreamedOutput>,
}

impl Report {
    /// Opens the files of the options, if there are any.
    ///
    /// # Errors
    /// Returns the reason why a file cannot be written.
    pub(super) fn open(
        args: &FlyArgs,
        vehicle: &Vehicle,
        plan: &PlanFile,
        beside: Beside,
    ) -> Result<Option<Self>, AppError> {
        if args.report.is_none() && args.markdown.is_none() {
            return Ok(None);
        }
        let open = |path: &Option<PathBuf>| path.as_deref().map(StreamedOutput::begin).transpose();
        let (html, markdown) = (open(&args.report)?, open(&args.markdown)?);
        let Beside { command, backdrop, relief, firmware } = beside;
        let mut report = report::about(vehicle, &plan.name, &plan.plan);
        let (name, lines) =
            firmware.map_or(("embedded".to_owned(), None), |(name, lines)| (name, Some(lines)));
        report.facts = vec![("firmware".to_owned(), name)];
        report.settings = lines.map(ReportedSettings::Sent).or(report.settings);
        report.tolerance_m = Some(args.mission.tolerance_m());
        report.command = Some(command);
        report.backdrop = backdrop;
        Ok(Some(Self { report, relief, html, markdown }))
    }

    /// Records an event.
    pub(super) fn event(&mut self, event: &Event) {
        self.report.record.note(event);
    }

    /// Records the state after a tick.
    pub(super) fn after_tick(&mut self, vehicle: &Vehicle) {
        report::sample(&mut self.report.record, vehicle);
    }

    /// Writes the files.
    ///
    /// # Errors
    /// Returns the error of the output.
    pub(super) fn finish(self, end: &End) -> Result<(), AppError> {
        let Self { mut report, relief, html, markdown } = self;
        report.verdict = Verdict {
            passed: Some(end.result == "complete"),
            word: end.result.clone(),
            reason: end.reason.clone(),
        };
        report.flown_s = Some(end.flown_s);
        report.truth = end.truth.clone();
        report.facts.extend(end.hash.map(|hash| ("hash".to_owned(), format!("{hash:016x}"))));
        if let Some(relief) = relief {
            report::add_ground(&mut report, &relief);
        }
        let write = |file: Option<StreamedOutput>, text: &dyn Fn() -> String| {
            let Some(mut file) = file else { return Ok(()) };
            file.add(text().as_bytes())?;
            file.finish()
        };
        write(html, &|| html::flight_page(&report, &report::program()))?;
        write(markdown, &|| flight::markdown(&report))
    }
}
