//! The events and samples of a flight as lines: JSON, or sentences.

use std::io::Write as _;

use crate::args::FlyArgs;
use crate::events::Event;
use crate::headless::fly::output::pace::Pace;
use crate::headless::fly::output::stream::{Stream, if_read};
use crate::process::error::AppError;
use crate::report::{End, json, sentence, truth};
use crate::signals::SimTime;
use crate::text::printable;
use crate::vehicle::Vehicle;

/// The output for the lines.
pub(super) struct Lines {
    /// `None` after the reader went away.
    stream: Option<Stream>,
    /// `true` for JSON lines, `false` for sentences.
    json: bool,
    /// `None` = no samples.
    samples: Option<Pace>,
}

impl Lines {
    /// Opens the lines of the options; `None` if the rows of `--csv` go to standard output instead.
    ///
    /// # Errors
    /// Returns the reason why the file cannot be written.
    pub(super) fn open(args: &FlyArgs) -> Result<Option<Self>, AppError> {
        let stream = match &args.json {
            Some(output) => Stream::open(output)?,
            None if args.has_sentences() => Stream::stdout(),
            None => return Ok(None),
        };
        let samples = args.samples.filter(|hz| args.json.is_some() && *hz > 0.0).map(Pace::from_hz);
        Ok(Some(Self { stream: Some(stream), json: args.json.is_some(), samples }))
    }

    /// Writes an event.
    ///
    /// # Errors
    /// Returns the error of the output.
    pub(super) fn event(&mut self, event: &Event) -> Result<(), AppError> {
        let line = if self.json { json::event_line(event) } else { sentence::line(event) };
        line.map_or(Ok(()), |line| self.line(&line))
    }

    /// Writes a sample if one is due.
    ///
    /// # Errors
    /// Returns the error of the output.
    pub(super) fn sample(&mut self, vehicle: &Vehicle) -> Result<(), AppError> {
        match self.samples {
            Some(samples) if samples.is_due(vehicle) => self.line(&json::sample_line(&vehicle.snapshot())),
            _ => Ok(()),
        }
    }

    /// Writes the end of the flight.
    ///
    /// # Errors
    /// Returns the error of the output.
    pub(super) fn end(&mut self, time: SimTime, end: &End) -> Result<(), AppError> {
        if self.json {
            return self.line(&json::end_line(time, end));
        }
        truth::lines(time, &end.truth).iter().try_for_each(|line| self.line(line))
    }

    fn line(&mut self, line: &str) -> Result<(), AppError> {
        let Some(stream) = &mut self.stream else { return Ok(()) };
        let line = if self.json { printable::json(line) } else { printable::line(line) };
        if if_read(writeln!(stream, "{line}"))?.is_none() {
            self.stream = None;
        }
        Ok(())
    }

    /// Passes the lines on to the reader.
    ///
    /// # Errors
    /// Returns the error of the output.
    pub(super) fn flush(&mut self) -> Result<(), AppError> {
        let Some(stream) = &mut self.stream else { return Ok(()) };
        if if_read(stream.flush())?.is_none() {
            self.stream = None;
        }
        Ok(())
    }

    /// Gives a file its name.
    ///
    /// # Errors
    /// Returns the error of the output.
    pub(super) fn finish(mut self) -> Result<(), AppError> {
        self.flush()?;
        self.stream.map_or(Ok(()), Stream::finish)
    }
}
