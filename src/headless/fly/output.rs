//! The outputs of a headless flight: lines, rows, tracks, a report, and the last lines on standard error.

mod claim;
mod lines;
mod pace;
mod prelude;
mod report;
mod stream;
mod table;
mod tracks;

use crate::args::FlyArgs;
use crate::events::Event;
use crate::files::log_output::LogOutput;
use crate::files::recording_file::Recorder;
use crate::headless::fly::watched::WatchedFlight;
use crate::plan::format::PlanFile;
use crate::process::error;
use crate::process::error::AppError;
use crate::recording;
use crate::report::End;
use crate::runner::{Flying as _, Subscriber};
use crate::signals::SimTime;
use crate::vehicle::Vehicle;
pub(super) use claim::{claim, log_file};
use lines::Lines;
pub(super) use prelude::Prelude;
pub(super) use report::Beside;
use report::Report;
use table::Table;
use tracks::Tracks;

/// The files of the flight that begin with its vehicle.
pub(super) struct Recorded {
    pub(super) recorder: Option<Recorder>,
    pub(super) log: Option<LogOutput>,
}

/// The outputs of the flight.
pub(super) struct Output {
    lines: Option<Lines>,
    table: Option<Table>,
    tracks: Tracks,
    recorder: Option<Recorder>,
    report: Option<Report>,
    log: Option<LogOutput>,
    /// `true` after the end of the flight: only its end remains to be reported.
    is_over: bool,
    /// The first error. The flight stops.
    problem: Option<AppError>,
}

impl Output {
    /// Opens the outputs of the options.
    pub(super) fn open(
        args: &FlyArgs,
        vehicle: &Vehicle,
        plan: &PlanFile,
        beside: Beside,
        Recorded { recorder, log }: Recorded,
    ) -> Result<Self, AppError> {
        Ok(Self {
            lines: Lines::open(args)?,
            table: Table::open(args)?,
            tracks: Tracks::open(args, vehicle, plan)?,
            recorder,
            report: Report::open(args, vehicle, plan, beside)?,
            log,
            is_over: false,
            problem: None,
        })
    }

    /// Returns the error that stopped the flight.
    pub(super) fn into_problem(self) -> AppError {
        self.problem.unwrap_or_else(|| AppError::internal("the output stopped without an error"))
    }

    /// Writes an event.
    pub(super) fn write(&mut self, event: &Event) -> Result<(), AppError> {
        self.record(event);
        self.lines.as_mut().map_or(Ok(()), |lines| lines.event(event))
    }

    /// Records an event without writing it.
    fn record(&mut self, event: &Event) {
        if let Some(recorder) = &mut self.recorder {
            recorder.event(event);
        }
        if let Some(report) = &mut self.report {
            report.event(event);
        }
    }

    /// Writes the samples that are due.
    fn sample(&mut self, flight: &WatchedFlight) -> Result<(), AppError> {
        if let Some(lines) = &mut self.lines {
            lines.sample(flight.vehicle())?;
        }
        if let Some(table) = &mut self.table {
            table.sample(flight)?;
        }
        if let Some(recorder) = &mut self.recorder {
            recorder.after_tick(flight.vehicle(), flight.end().is_some())?;
        }
        if let Some(report) = &mut self.report {
            report.after_tick(flight.vehicle());
        }
        if let Some(log) = &mut self.log {
            log.after_tick(flight.vehicle())?;
        }
        self.tracks.offer(flight.vehicle())
    }

    /// Passes everything on to the reader.
    fn flush(&mut self) -> Result<(), AppError> {
        if let Some(lines) = &mut self.lines {
            lines.flush()?;
        }
        self.table.as_mut().map_or(Ok(()), Table::flush)
    }

    /// Keeps the error of `done`, if there is one.
    fn keep(&mut self, done: Result<(), AppError>) {
        if let Err(problem) = done {
            self.problem.get_or_insert(problem);
        }
    }

    /// Ends the files and reports the end of the flight.
    pub(super) fn finish(self, time: SimTime, end: &End) -> Result<(), AppError> {
        let Self { lines, table, tracks, recorder, report, log, .. } = self;
        if let Some(mut lines) = lines {
            lines.end(time, end)?;
            lines.finish()?;
        }
        table.map_or(Ok(()), Table::finish)?;
        tracks.finish()?;
        if let Some(recorder) = recorder {
            let (result, reason) = (end.result.clone(), end.reason.clone());
            recorder.finish(recording::End { t: time, result, reason, flown_s: end.flown_s, hash: None })?;
        }
        report.map_or(Ok(()), |report| report.finish(end))?;
        if let Some(sentence) = log.map(LogOutput::finish).transpose()?.flatten() {
            error::tell(&sentence);
        }
        error::tell(&end.result_line());
        error::tell(&end.flown_line());
        Ok(())
    }
}

impl Subscriber<WatchedFlight> for Output {
    fn before_tick(&mut self, vehicle: &mut Vehicle) {
        if let Some(recorder) = &mut self.recorder
            && !self.is_over
        {
            recorder.before_tick(vehicle);
        }
    }

    fn event(&mut self, event: &Event) {
        if !self.is_over {
            let done = self.write(event);
            self.keep(done);
        }
    }

    fn after_tick(&mut self, flight: &WatchedFlight) {
        if !self.is_over {
            let done = self.sample(flight);
            self.keep(done);
        }
        self.is_over = flight.end().is_some();
    }

    /// A person may be watching the output.
    fn before_rest(&mut self) {
        let done = self.flush();
        self.keep(done);
    }

    fn goes_on(&self) -> bool {
        self.problem.is_none()
    }
}
