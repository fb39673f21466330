//! Where the results go: sentences on standard output, and the files that were asked for.

use std::io::{BufWriter, Write};
use std::path::PathBuf;

use super::Loaded;
use super::progress::Progress;
use crate::app::error::{self, AppError};
use crate::app::output_file::{self, KeptFiles};
use crate::args::{CheckArgs, OutputFile};
use crate::printable;
use crate::record::check::{
    CheckedFlight, Summary, flight_line, flight_lines, junit, markdown, summary_line, summary_lines,
};

/// Where the results go.
pub(super) struct Output {
    /// Sentences, unless JSON goes to standard output.
    sentences: bool,
    /// Somebody still reads standard output.
    is_read: bool,
    json: Option<BufWriter<Box<dyn Write>>>,
    junit: Option<PathBuf>,
    markdown: Option<PathBuf>,
    progress: Progress,
}

impl Output {
    /// Opens what the options name; no scenario may be among it.
    pub(super) fn open(args: &CheckArgs, loaded: &Loaded) -> Result<Self, AppError> {
        let mut kept = KeptFiles::default();
        for file in &loaded.files {
            kept.keep("a scenario's file", file);
        }
        if let Some(OutputFile::File(path)) = &args.json {
            kept.claim("--json", path)?;
        }
        for (option, path) in [("--junit", &args.junit), ("--markdown", &args.markdown)] {
            if let Some(path) = path {
                kept.claim(option, path)?;
                // Known before the flights, not after.
                output_file::create(path)?;
            }
        }
        let json: Option<Box<dyn Write>> = match &args.json {
            None => None,
            Some(OutputFile::Stdout) => Some(Box::new(std::io::stdout())),
            Some(OutputFile::File(path)) => Some(Box::new(output_file::create(path)?)),
        };
        Ok(Self {
            sentences: args.json != Some(OutputFile::Stdout),
            is_read: true,
            json: json.map(BufWriter::new),
            junit: args.junit.clone(),
            markdown: args.markdown.clone(),
            progress: Progress::new(),
        })
    }

    /// Tells of a flight.
    pub(super) fn flight(&mut self, flight: &CheckedFlight, done: usize, all: usize) -> Result<(), AppError> {
        self.progress.clear();
        self.lines(&flight_lines(flight))?;
        self.json_lines(&[flight_line(flight)])?;
        self.progress.show(done, all, &flight.scenario);
        Ok(())
    }

    /// Tells on standard error what is to be known meanwhile.
    pub(super) fn tell(&mut self, sentence: &str) {
        self.progress.clear();
        error::tell(sentence);
    }

    /// Tells how the run ended, and writes the files.
    pub(super) fn finish(&mut self, summary: &Summary) -> Result<(), AppError> {
        self.progress.clear();
        self.lines(&summary_lines(summary))?;
        self.json_lines(&summary_line(summary))?;
        for (path, text) in [(&self.junit, junit(summary)), (&self.markdown, markdown(summary))] {
            if let Some(path) = path {
                output_file::create(path)?.write_all(text.as_bytes()).map_err(|error| {
                    AppError::environment(format!("cannot write {}: {error}", path.display()))
                })?;
            }
        }
        Ok(())
    }

    fn lines(&mut self, lines: &[String]) -> Result<(), AppError> {
        if !self.sentences || !self.is_read {
            return Ok(());
        }
        let mut stdout = std::io::stdout().lock();
        let written = lines.iter().try_for_each(|line| writeln!(stdout, "{}", printable::line(line)));
        self.is_read = still_read(written.and_then(|()| stdout.flush()))?;
        Ok(())
    }

    fn json_lines(&mut self, lines: &[String]) -> Result<(), AppError> {
        let Some(json) = &mut self.json else { return Ok(()) };
        let written = lines.iter().try_for_each(|line| writeln!(json, "{}", printable::json(line)));
        if !still_read(written.and_then(|()| json.flush()))? {
            self.json = None;
        }
        Ok(())
    }
}

/// A reader that went away has seen enough; the run and its exit code go on.
fn still_read(written: std::io::Result<()>) -> Result<bool, AppError> {
    match written {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(false),
        Err(error) => Err(AppError::environment(format!("cannot write the results: {error}"))),
    }
}
