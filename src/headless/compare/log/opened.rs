//! The log of a comparison.

use std::io;
use std::path::Path;

use crate::files::input_file;
use crate::files::log_source::FileSource;
use crate::flight_log::{Indexer, LogFile, LogFlight, LogHome, LogSample, LogSticks};
use crate::process::error::AppError;
use crate::replay::{log_assumptions, log_end_notices};
use crate::text::printable;

/// A log and the bytes of its file.
#[derive(Debug)]
pub(super) struct OpenLog {
    name: String,
    source: FileSource,
    flight: LogFlight,
}

impl OpenLog {
    /// Opens the longest log of a file.
    ///
    /// # Errors
    /// Returns the reason why no log of it can be compared.
    pub(super) fn open(path: &Path, notices: &mut Vec<String>) -> Result<Self, AppError> {
        let name = printable::name(&path.display().to_string());
        let (file, size) = input_file::open_log(path)?;
        let mut source = FileSource::new(file, size);
        let found = Indexer::new(&mut source).run().map_err(|error| cannot_read(&name, &error))?;
        let LogFile { flights, refused, .. } = found;
        let reason =
            refused.first().map(|refused| format!("{name}: log {}: {}", refused.number, refused.error));
        let count = flights.len();
        let longest =
            flights.into_iter().max_by_key(|flight| flight.counts().main).filter(|flight| !flight.is_empty());
        let Some(flight) = longest else {
            let reason = reason.unwrap_or_else(|| format!("{name} has no blackbox log with frames"));
            return Err(AppError::input(reason));
        };
        if count > 1 {
            notices.push(format!(
                "{name} has {count} logs: log {} is the longest, and is compared.",
                flight.number()
            ));
        }
        notices.extend(log_assumptions(&flight).into_iter().chain(log_end_notices(flight.end())));
        Ok(Self { name, source, flight })
    }

    pub(super) fn name(&self) -> String {
        self.name.clone()
    }

    pub(super) fn flight(&self) -> &LogFlight {
        &self.flight
    }

    /// Reads from the log.
    ///
    /// # Errors
    /// Returns an error if the file can no longer be read.
    pub(super) fn read<T>(
        &self,
        read: impl FnOnce(&LogFlight, FileSource) -> io::Result<T>,
    ) -> Result<T, AppError> {
        read(&self.flight, self.source.clone()).map_err(|error| cannot_read(&self.name, &error))
    }

    /// Returns the home of the log.
    ///
    /// # Errors
    /// Returns an error if the log has no places.
    pub(super) fn home(&self) -> Result<LogHome, AppError> {
        self.flight.home().ok_or_else(|| {
            AppError::input(format!(
                "{}: the log has no GPS, so it has no track to compare: `betadeck replay` shows it",
                self.name
            ))
        })
    }

    /// Returns the firmware that wrote the log, safe to print.
    pub(super) fn firmware(&self) -> String {
        let name = self.flight.header().value("Firmware revision").filter(|name| !name.is_empty());
        printable::name(name.unwrap_or("an unknown firmware"))
    }

    /// Returns the first sample.
    ///
    /// # Errors
    /// Returns an error if the file can no longer be read.
    pub(super) fn start(&self) -> Result<LogSample, AppError> {
        self.read(|flight, source| flight.sample(source, flight.first())).map(Option::unwrap_or_default)
    }

    /// Returns the sticks.
    ///
    /// # Errors
    /// Returns an error if the log does not have them.
    pub(super) fn sticks(&self) -> Result<LogSticks, AppError> {
        let sticks = self.read(LogSticks::of)?;
        sticks.ok_or_else(|| {
            AppError::input(format!(
                "{}: the log has no rcCommand, so it cannot be flown again: log it with blackbox_disable_rc = OFF",
                self.name
            ))
        })
    }
}

fn cannot_read(name: &str, error: &io::Error) -> AppError {
    AppError::environment(format!("cannot read {name}: {error}"))
}
