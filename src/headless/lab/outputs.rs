//! The outputs of the programme.

use std::path::{Path, PathBuf};

use crate::args::{LabArgs, OutputFile};
use crate::files::output_file::{FinalOutput, KeptFiles};
use crate::headless::check::{Bar, Stopwatch};
use crate::headless::report;
use crate::process::error;
use crate::process::error::AppError;
use crate::report::check::{Summary, junit};
use crate::report::html;
use crate::report::lab::Lab;

/// The outputs of the programme.
#[derive(Debug)]
pub(super) struct Outputs {
    /// `true` if JSON goes to standard output instead of the text.
    json_on_stdout: bool,
    json: Option<FinalOutput>,
    junit: Option<FinalOutput>,
    markdown: Option<FinalOutput>,
    html: Option<FinalOutput>,
    likeness: Option<FinalOutput>,
    /// The command that gives the answer again.
    command: String,
}

impl Outputs {
    /// Checks that the files can be written, so that no flight is wasted. The files stay unchanged.
    pub(super) fn prepare(args: &LabArgs, repeat: &[String]) -> Result<Self, AppError> {
        let json = match &args.json {
            Some(OutputFile::File(path)) => Some(path),
            Some(OutputFile::Stdout) | None => None,
        };
        let mut kept = KeptFiles::default();
        args.alone
            .iter()
            .chain(&args.base)
            .chain(&args.head)
            .for_each(|path| kept.keep("an executable", path));
        args.with.iter().for_each(|path| kept.keep("--with", path));
        for (option, path) in [
            ("--json", json),
            ("--junit", args.junit.as_ref()),
            ("--markdown", args.markdown.as_ref()),
            ("--html", args.html.as_ref()),
            ("--likeness", args.likeness.as_ref()),
        ] {
            path.map_or(Ok(()), |path| kept.claim(option, path))?;
        }
        let prepare = |path: Option<&Path>| path.map(FinalOutput::prepare).transpose();
        Ok(Self {
            json_on_stdout: args.json == Some(OutputFile::Stdout),
            json: prepare(json.map(PathBuf::as_path))?,
            junit: prepare(args.junit.as_deref())?,
            markdown: prepare(args.markdown.as_deref())?,
            html: prepare(args.html.as_deref())?,
            likeness: prepare(args.likeness.as_deref())?,
            command: report::command(repeat),
        })
    }

    /// Writes all outputs, even if one of them fails.
    pub(super) fn write(self, lab: &Lab) -> Result<(), AppError> {
        let json = format!("{}\n", lab.json());
        let shown = match self.json_on_stdout {
            true => error::write_stdout(json.as_bytes()),
            false => error::print(&lab.text()),
        };
        let to = |file: Option<FinalOutput>, text: &dyn Fn() -> String| {
            file.map_or(Ok(()), |file| file.write(text().as_bytes()))
        };
        let command = Some(self.command.as_str());
        let summary = || Summary {
            flights: lab.heads().cloned().collect(),
            compared: Vec::new(),
            wanted: lab.wanted(),
            left_out: 0,
            wall_s: lab.wall_s(),
        };
        let written = [
            to(self.json, &|| json.clone()),
            to(self.junit, &|| junit(&summary())),
            to(self.markdown, &|| lab.markdown(command)),
            to(self.likeness, &|| lab.likeness(command)),
            to(self.html, &|| html::lab_page(lab, command, &report::program())),
        ];
        shown?;
        written.into_iter().collect()
    }
}

/// The progress of the programme, on a terminal only.
pub(super) struct Progress<'a> {
    bar: Bar,
    started: &'a Stopwatch,
    budget_s: f64,
}

impl<'a> Progress<'a> {
    pub(super) fn new(started: &'a Stopwatch, budget_s: f64) -> Self {
        Self { bar: Bar::new(), started, budget_s }
    }

    pub(super) fn clear(&mut self) {
        self.bar.clear();
    }

    /// Shows the number of finished flights. The bar is as long as the time or the flights, whichever ends first.
    pub(super) fn show(&mut self, done: usize, all: usize, scenario: &str) {
        let by_time = (self.started.seconds() / self.budget_s * 1000.0) as usize;
        let by_flights = done * 1000 / all.max(1);
        let left_s = (self.budget_s - self.started.seconds()).max(0.0);
        let text = format!("{done} of {all} flights, at most {left_s:.0} s more, {scenario}");
        self.bar.show(by_time.max(by_flights), 1000, &text);
    }
}
