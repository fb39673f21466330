//! A file of blackbox logs.

use std::io;
use std::sync::Arc;

use super::flight::PastLog;
use crate::blackbox::decode::LogSource;
use crate::flight_log::{Indexer, LogFile, LogFlight, RefusedLog};
use crate::replay::{PastFlight, PastFlights, Progress};

/// The most logs that are named in the sentence about a file.
const MAX_NAMED: usize = 12;

/// A log that can be shown, or the reason why it cannot.
#[derive(Debug)]
enum Found {
    Log(Arc<LogFlight>),
    Refused(RefusedLog),
}

/// The logs of a file.
#[derive(Debug)]
pub struct LogFlights<S> {
    name: Arc<str>,
    source: S,
    logs: Vec<Found>,
    left_out: usize,
}

impl<S> LogFlights<S> {
    /// Returns the logs of a file that is not read yet. `name` is the name of the file, safe to print.
    pub fn new(name: &str, source: S) -> Self {
        Self { name: name.into(), source, logs: Vec::new(), left_out: 0 }
    }

    /// Returns a log that was read, numbered from zero.
    ///
    /// # Errors
    /// Returns a sentence if it cannot be shown.
    pub fn log(&self, number: usize) -> Result<Arc<LogFlight>, String> {
        let (name, count) = (&self.name, self.logs.len());
        match self.logs.get(number) {
            None if count == 1 => Err(format!("{name} has only one log.")),
            None => Err(format!("{name} has {count} logs: choose one from 1 to {count}.")),
            Some(Found::Refused(log)) => {
                Err(format!("Log {} of {name} cannot be shown: {}.", log.number, log.error))
            }
            Some(Found::Log(log)) if log.is_empty() => {
                Err(format!("Log {} of {name} has no frame, so there is nothing to show.", log.number()))
            }
            Some(Found::Log(log)) => Ok(Arc::clone(log)),
        }
    }

    fn unreadable(&self, error: &io::Error) -> String {
        format!("{} cannot be read: {error}.", self.name)
    }

    /// Returns a sentence that names the logs of a file with several, with the length of each.
    fn list(&self) -> Option<String> {
        if self.logs.len() < 2 {
            return None;
        }
        let one = |(index, found): (usize, &Found)| match found {
            Found::Log(log) if !log.is_empty() => {
                format!("{} of {:.1} s", index + 1, log.last().seconds_since(log.first()))
            }
            Found::Log(_) | Found::Refused(_) => format!("{} cannot be shown", index + 1),
        };
        let mut named: Vec<_> = self.logs.iter().enumerate().take(MAX_NAMED).map(one).collect();
        let more = self.logs.len().saturating_sub(MAX_NAMED);
        if more > 0 {
            named.push(format!("and {more} more"));
        }
        Some(format!("{} has {} logs: {}.", self.name, self.logs.len(), named.join(", ")))
    }

    /// Returns the log with this number, from zero, or the first one that can be shown.
    ///
    /// # Errors
    /// Returns a sentence if it cannot be shown.
    pub fn chosen(&self, number: Option<usize>) -> Result<Arc<LogFlight>, String> {
        if let Some(number) = number {
            return self.log(number);
        }
        let first = (0..self.logs.len()).find_map(|number| self.log(number).ok());
        first.map_or_else(|| self.log(0), Ok)
    }

    fn take(&mut self, found: LogFile) -> Result<(), String> {
        self.left_out = found.left_out;
        let logs = found.flights.into_iter().map(|log| (log.number(), Found::Log(Arc::new(log))));
        let refused = found.refused.into_iter().map(|log| (log.number, Found::Refused(log)));
        let mut all: Vec<_> = logs.chain(refused).collect();
        all.sort_by_key(|(number, _)| *number);
        self.logs = all.into_iter().map(|(_, found)| found).collect();
        if self.logs.is_empty() { Err(format!("{} has no blackbox log.", self.name)) } else { Ok(()) }
    }

    /// Returns the bytes of the file.
    pub fn source(&self) -> &S {
        &self.source
    }
}

impl<S: LogSource + Clone> LogFlights<S> {
    /// Returns the log with this number, from zero, or the first one that can be shown, as soon as a cursor can read it. The rest
    /// of the file is not read, so what is known at the end of the log is missing. Returns `None` once `is_stopped` says so.
    ///
    /// # Errors
    /// Returns a sentence if the file cannot be read, or the log cannot be shown.
    pub fn start(
        &self,
        number: Option<usize>,
        is_stopped: impl Fn() -> bool,
    ) -> Result<Option<Arc<LogFlight>>, String> {
        let found = Indexer::new(self.source.clone())
            .run_to_start(number.map(|number| number + 1), is_stopped)
            .map_err(|error| self.unreadable(&error))?;
        let Some(found) = found else { return Ok(None) };
        let mut start = LogFlights::new(&self.name, ());
        start.take(found)?;
        start.chosen(number).map(Some)
    }
}

impl<S: LogSource + Clone + Send + 'static> PastFlights for LogFlights<S> {
    fn name(&self) -> &str {
        &self.name
    }

    fn read(&mut self, progress: Progress<'_>) -> Result<bool, String> {
        if !self.logs.is_empty() {
            return Ok(true);
        }
        let mut indexer = Indexer::new(self.source.clone());
        loop {
            let step = indexer.step().map_err(|error| self.unreadable(&error))?;
            if step.is_done {
                break;
            }
            if !progress(step.read as f64 / step.of.max(1) as f64) {
                return Ok(false);
            }
        }
        self.take(indexer.finish())?;
        Ok(true)
    }

    fn count(&self) -> usize {
        self.logs.len()
    }

    fn notices(&self) -> Vec<String> {
        let left_out = match self.left_out {
            0 => None,
            count => Some(format!("{count} more logs of {} are left out.", self.name)),
        };
        self.list().into_iter().chain(left_out).collect()
    }

    fn open(&mut self, number: usize) -> Result<Box<dyn PastFlight>, String> {
        let past = PastLog::new(Arc::clone(&self.name), self.log(number)?, self.source.clone())?;
        Ok(Box::new(past))
    }
}
