//! The outputs of a comparison.

use std::path::{Path, PathBuf};

use crate::args::{CompareArgs, OutputFile};
use crate::files::log_output::LogFiles;
use crate::files::output_file::FinalOutput;
use crate::geo::LocalFrame;
use crate::headless::{report, setup};
use crate::plan::feature::Feature;
use crate::process::error;
use crate::process::error::AppError;
use crate::report::compare::Comparison;
use crate::report::html;

/// The outputs of a comparison.
#[derive(Debug)]
pub(super) struct Outputs {
    /// `true` if JSON goes to standard output instead of the table.
    json_on_stdout: bool,
    json: Option<FinalOutput>,
    svg: Option<FinalOutput>,
    report: Option<FinalOutput>,
    markdown: Option<FinalOutput>,
    logs: Option<LogFiles>,
    /// The map under the tracks of the report.
    backdrop: Vec<Feature>,
    /// The command that gives the comparison again.
    command: String,
}

impl Outputs {
    /// Checks that the files can be written, so that no flight is wasted. The files stay unchanged. `logged` are the names
    /// of the flights that can have a blackbox log.
    pub(super) fn prepare(
        args: &CompareArgs,
        repeat: &[String],
        logged: &[String],
    ) -> Result<Self, AppError> {
        let json = match &args.json {
            Some(OutputFile::File(path)) => Some(path),
            Some(OutputFile::Stdout) | None => None,
        };
        let mut kept = setup::kept_files(&args.flight, Some(&args.plan));
        args.backdrop.iter().for_each(|path| kept.keep("--backdrop", path));
        args.log.iter().for_each(|path| kept.keep("--log", path));
        for (option, path) in [
            ("--json", json),
            ("--svg", args.svg.as_ref()),
            ("--report", args.report.as_ref()),
            ("--markdown", args.markdown.as_ref()),
            ("--record", args.record.as_ref()),
        ] {
            path.map_or(Ok(()), |path| kept.claim(option, path))?;
        }
        let backdrop = if args.report.is_some() { report::backdrop(&args.backdrop)? } else { Vec::new() };
        let prepare = |path: &Option<PathBuf>| path.as_deref().map(FinalOutput::prepare).transpose();
        Ok(Self {
            json_on_stdout: args.json == Some(OutputFile::Stdout),
            json: json.map(|path| FinalOutput::prepare(path)).transpose()?,
            svg: prepare(&args.svg)?,
            report: prepare(&args.report)?,
            markdown: prepare(&args.markdown)?,
            logs: args.blackbox.as_deref().map(|path| LogFiles::claim(path, logged, &kept)).transpose()?,
            backdrop,
            command: report::command(repeat),
        })
    }

    /// Returns the file of the log of a flight, by its place among the flights with a log.
    pub(super) fn log(&self, flight: usize) -> Option<&Path> {
        self.logs.as_ref()?.of(flight)
    }

    /// Writes all outputs, even if one of them fails.
    pub(super) fn write(self, comparison: &Comparison, frame: &LocalFrame) -> Result<(), AppError> {
        let json = format!("{}\n", comparison.json());
        let shown = match self.json_on_stdout {
            true => error::write_stdout(json.as_bytes()),
            false => error::print(&comparison.text()),
        };
        let to = |file: Option<FinalOutput>, text: &dyn Fn() -> String| {
            file.map_or(Ok(()), |file| file.write(text().as_bytes()))
        };
        let command = Some(self.command.as_str());
        let page = || html::compare_page(comparison, (&self.backdrop, frame), command, &report::program());
        let written = [
            to(self.json, &|| json.clone()),
            to(self.svg, &|| comparison.svg()),
            to(self.report, &page),
            to(self.markdown, &|| comparison.markdown(command)),
        ];
        shown?;
        written.into_iter().collect()
    }
}
