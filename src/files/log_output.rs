//! `--blackbox`: the blackbox logs of headless flights as files, written while they fly.

mod files;

use std::io::Write as _;
use std::path::{Path, PathBuf};

use crate::blackbox::encode::LogBuffer;
use crate::files::output_file::{StreamedOutput, write_failed};
use crate::firmware::Firmware;
use crate::firmware::blackbox::LogStream;
use crate::process::error::AppError;
use crate::runner::{Flying, Subscriber};
use crate::signals::SimTime;
use crate::vehicle::Vehicle;
pub(crate) use files::{LogFiles, file_of_one};

/// The option.
pub(crate) const OPTION: &str = "--blackbox";
/// Simulated time between two writes, µs.
const FLUSH_US: u64 = 1_000_000;

/// The file of a flight. Several logs of the flight follow each other in it. It is written from the first arming on, and
/// a kill leaves what was flown.
#[derive(Debug)]
pub(crate) struct LogOutput {
    path: PathBuf,
    /// `None` after an error.
    file: Option<StreamedOutput>,
    /// `true` once there is a log, so that the file has its name.
    has_log: bool,
    stream: LogStream,
    buffer: LogBuffer,
    flushed_at: SimTime,
}

impl LogOutput {
    /// Begins to log the flight of an embedded firmware into a claimed path. Removes an existing file, which has the log
    /// of an earlier run.
    ///
    /// # Errors
    /// Returns the reason why the file cannot be written, or that the firmware is remote.
    pub(crate) fn begin(path: &Path, vehicle: &mut Vehicle) -> Result<Self, AppError> {
        if !vehicle.set_logs(true) {
            return Err(needs_embedded());
        }
        Ok(Self {
            path: path.to_owned(),
            file: Some(StreamedOutput::begin(path)?),
            has_log: false,
            stream: LogStream::default(),
            buffer: LogBuffer::default(),
            flushed_at: SimTime::ZERO,
        })
    }

    /// Writes what the last tick noted.
    ///
    /// # Errors
    /// Returns the reason why the file cannot be written.
    pub(crate) fn after_tick(&mut self, vehicle: &Vehicle) -> Result<(), AppError> {
        let step = vehicle.embedded().and_then(Firmware::log_step);
        let Some(step) = step.filter(|step| !step.is_empty()) else { return Ok(()) };
        self.buffer.clear();
        self.stream.step(&step, &mut self.buffer);
        let Some(mut file) = self.file.take() else { return Ok(()) };
        let mut written = file.write_all(self.buffer.bytes());
        if step.ends || vehicle.time().0 >= self.flushed_at.0 + FLUSH_US {
            self.flushed_at = vehicle.time();
            written = written.and_then(|()| file.flush());
        }
        written.map_err(write_failed)?;
        // It gets its name with its first bytes in it: a full disk leaves no empty log.
        self.file = Some(if std::mem::replace(&mut self.has_log, true) { file } else { file.named()? });
        Ok(())
    }

    /// Ends the file. Without a log there is none, and a sentence says so.
    ///
    /// # Errors
    /// Returns the reason why the file cannot be written.
    pub(crate) fn finish(self) -> Result<Option<String>, AppError> {
        match self.file {
            Some(file) if self.has_log => file.finish().map(|()| None),
            _ => {
                let path = self.path.display();
                Ok(Some(format!("{OPTION} {path}: there is no log, because the craft was not armed.")))
            }
        }
    }
}

/// Returns the error for a remote firmware.
pub(crate) fn needs_embedded() -> AppError {
    AppError::input(format!(
        "{OPTION} writes the log of the embedded firmware, and a remote one flies: leave out {OPTION} or the firmware"
    ))
}

/// Writes the log of a flight without other outputs, and stops the flight after an error.
#[derive(Debug)]
pub(crate) struct LogOnly {
    output: LogOutput,
    problem: Option<AppError>,
}

impl LogOnly {
    pub(crate) fn new(output: LogOutput) -> Self {
        Self { output, problem: None }
    }

    /// Ends the file. Without a log there is none.
    ///
    /// # Errors
    /// Returns the reason why the file cannot be written.
    pub(crate) fn finish(self) -> Result<(), AppError> {
        self.problem.map_or_else(|| self.output.finish().map(drop), Err)
    }
}

impl<F: Flying> Subscriber<F> for LogOnly {
    fn after_tick(&mut self, flight: &F) {
        if let Err(problem) = self.output.after_tick(flight.vehicle()) {
            self.problem.get_or_insert(problem);
        }
    }

    fn goes_on(&self) -> bool {
        self.problem.is_none()
    }
}
