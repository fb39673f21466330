//! The outputs for the results: sentences on standard output, and the requested files.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use super::Loaded;
use crate::args::{CheckArgs, OutputFile};
use crate::files::log_output::LogFiles;
use crate::files::output_file;
use crate::files::output_file::{FinalOutput, KeptFiles, Writer};
use crate::headless::check::progress::Bar;
use crate::headless::{report, setup};
use crate::plan::feature::Feature;
use crate::process::error;
use crate::process::error::AppError;
use crate::process::patient_output::PatientOutput;
use crate::report::check::{
    CheckedFlight, Summary, flight_line, flight_lines, junit, markdown, summary_line, summary_lines,
};
use crate::report::flight::FlightReport;
use crate::report::html::CheckPage;
use crate::text::printable;

/// The outputs for the results.
pub(super) struct Output {
    /// `true` for sentences, unless JSON goes to standard output.
    sentences: bool,
    /// `true` while standard output has a reader.
    is_read: bool,
    json: Option<Json>,
    junit: Option<FinalOutput>,
    markdown: Option<FinalOutput>,
    report: Option<Report>,
    progress: Bar,
}

/// The page about the run.
struct Report {
    file: FinalOutput,
    page: CheckPage,
    /// The map under the tracks.
    backdrop: Vec<Feature>,
    /// The command that gives the run again.
    command: String,
}

/// The output for the JSON lines.
enum Json {
    Stdout,
    /// A file that gets all lines at the end.
    File(FinalOutput, String),
}

/// Returns the output files of the options, with their options.
fn files(args: &CheckArgs) -> impl Iterator<Item = (&'static str, &Path)> {
    let json = match &args.json {
        Some(OutputFile::File(path)) => Some(path),
        Some(OutputFile::Stdout) | None => None,
    };
    let whole = [("--junit", &args.junit), ("--markdown", &args.markdown), ("--report", &args.report)];
    let whole = whole.map(|(option, path)| (option, path.as_ref()));
    let all = std::iter::once(("--json", json)).chain(whole);
    all.filter_map(|(option, path)| Some((option, path?.as_path())))
}

/// Checks that no output replaces a file that must be kept. Returns the files that a log must not replace.
fn claim(args: &CheckArgs, inputs: &[PathBuf]) -> Result<KeptFiles, AppError> {
    let mut kept = KeptFiles::default();
    args.backdrop.iter().for_each(|path| kept.keep("--backdrop", path));
    for file in inputs {
        kept.keep("a scenario's file", file);
    }
    setup::keep_own_files(&mut kept);
    files(args).try_for_each(|(option, path)| kept.claim(option, path))?;
    Ok(kept)
}

/// Returns the files of the blackbox logs, if they are wanted, for flights with these names.
pub(super) fn log_files(
    args: &CheckArgs,
    loaded: &Loaded,
    flights: impl FnOnce() -> Vec<String>,
) -> Result<Option<LogFiles>, AppError> {
    let Some(path) = &args.blackbox else { return Ok(None) };
    LogFiles::claim(path, &flights(), &claim(args, &loaded.files)?).map(Some)
}

/// Removes the results of an earlier run, because this run may fail before it flies.
pub(super) fn remove_earlier(args: &CheckArgs) -> Result<(), AppError> {
    let inputs: Vec<PathBuf> = args.what.iter().map(PathBuf::from).collect();
    claim(args, &inputs)?;
    files(args).for_each(|(option, path)| output_file::remove_results(Writer::Check, option, path));
    Ok(())
}

impl Output {
    /// Opens the outputs of the options; an output must not be a scenario.
    pub(super) fn open(args: &CheckArgs, repeat: &[String], loaded: &Loaded) -> Result<Self, AppError> {
        claim(args, &loaded.files)?;
        let backdrop = report::backdrop(&args.backdrop)?;
        // Problems are reported before the flights.
        let begin = |path: &Option<PathBuf>| path.as_deref().map(FinalOutput::begin).transpose();
        let json = match &args.json {
            None => None,
            Some(OutputFile::Stdout) => Some(Json::Stdout),
            Some(OutputFile::File(path)) => Some(Json::File(FinalOutput::begin(path)?, String::new())),
        };
        Ok(Self {
            sentences: args.json != Some(OutputFile::Stdout),
            is_read: true,
            json,
            junit: begin(&args.junit)?,
            markdown: begin(&args.markdown)?,
            report: begin(&args.report)?.map(|file| Report {
                file,
                page: CheckPage::default(),
                backdrop,
                command: report::command(repeat),
            }),
            progress: Bar::new(),
        })
    }

    /// Adds a flight to the page about the run.
    pub(super) fn report(&mut self, flight: &CheckedFlight, report: FlightReport) {
        if let Some(Report { page, backdrop, .. }) = &mut self.report {
            page.add(flight, &FlightReport { backdrop: backdrop.clone(), ..report });
        }
    }

    /// Reports a flight.
    pub(super) fn flight(&mut self, flight: &CheckedFlight, done: usize, all: usize) -> Result<(), AppError> {
        self.progress.clear();
        self.lines(&flight_lines(flight))?;
        self.json_lines(&[flight_line(flight)])?;
        self.progress.show(done, all, &format!("{done} of {all} flights, {}", flight.scenario));
        Ok(())
    }

    /// Prints a sentence on standard error during the run.
    pub(super) fn tell(&mut self, sentence: &str) {
        self.progress.clear();
        error::tell(sentence);
    }

    /// Reports the end of the run, and writes the files.
    pub(super) fn finish(&mut self, summary: &Summary) -> Result<(), AppError> {
        self.progress.clear();
        self.lines(&summary_lines(summary))?;
        self.json_lines(&summary_line(summary))?;
        let json = match self.json.take() {
            Some(Json::File(file, lines)) => file.write(lines.as_bytes()),
            Some(Json::Stdout) | None => Ok(()),
        };
        let to =
            |file: Option<FinalOutput>, text: String| file.map_or(Ok(()), |file| file.write(text.as_bytes()));
        // Each file is written, even if another one fails.
        let page = self.report.take().map_or(Ok(()), |Report { file, page, command, .. }| {
            file.write(page.html(summary, Some(&command), &report::program()).as_bytes())
        });
        let reports =
            [json, to(self.junit.take(), junit(summary)), to(self.markdown.take(), markdown(summary)), page];
        reports.into_iter().collect()
    }

    fn lines(&mut self, lines: &[String]) -> Result<(), AppError> {
        if !self.sentences || !self.is_read {
            return Ok(());
        }
        self.is_read = print(lines.iter().map(|line| printable::line(line)))?;
        Ok(())
    }

    fn json_lines(&mut self, lines: &[String]) -> Result<(), AppError> {
        let shown = lines.iter().map(|line| printable::json(line));
        match &mut self.json {
            None => {}
            Some(Json::File(_, text)) => shown.for_each(|line| {
                text.push_str(&line);
                text.push('\n');
            }),
            Some(Json::Stdout) => {
                let is_read = print(shown)?;
                self.json.take_if(|_| !is_read);
            }
        }
        Ok(())
    }
}

/// Prints lines. Returns `true` while there is a reader. If the reader went away, the run continues and keeps its exit
/// code.
fn print<'a>(lines: impl Iterator<Item = std::borrow::Cow<'a, str>>) -> Result<bool, AppError> {
    let text: String = lines.flat_map(|line| [line, "\n".into()]).collect();
    match PatientOutput(std::io::stdout()).write_all(text.as_bytes()) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(false),
        Err(error) => Err(AppError::environment(format!("cannot write the results: {error}"))),
    }
}
