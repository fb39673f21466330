//! A file with a recording.

use std::io::BufReader;
use std::sync::Arc;

use super::bytes::Bytes;
use super::flight::PastRecording;
use crate::blackbox::decode::LogSource;
use crate::recording::Recording;
use crate::replay::{PastFlight, PastFlights, Progress};

/// The size of the parts in which a file is read, bytes.
const PART: usize = 64 << 10;
/// The latest picture that is shown, in days since boot.
const MAX_DAYS: u64 = 30;
const DAY_US: u64 = 86_400_000_000;

/// The flight of a file with a recording.
#[derive(Debug)]
pub struct RecordedFlights<S> {
    name: Arc<str>,
    source: S,
    recording: Option<Arc<Recording>>,
}

impl<S> RecordedFlights<S> {
    /// Returns the flight of a file that is not read yet. `name` is the name of the file, safe to print.
    pub fn new(name: &str, source: S) -> Self {
        Self { name: name.into(), source, recording: None }
    }

    /// Returns the recording that was read.
    ///
    /// # Errors
    /// Returns a sentence if it was not read, or if the file has no such flight. Flights are numbered from zero.
    pub fn recording(&self, number: usize) -> Result<Arc<Recording>, String> {
        match &self.recording {
            Some(recording) if number == 0 => Ok(Arc::clone(recording)),
            Some(_) => Err(format!("{} has only one flight.", self.name)),
            None => Err(format!("{} is not read yet.", self.name)),
        }
    }
}

impl<S: LogSource + Clone + Send> PastFlights for RecordedFlights<S> {
    fn name(&self) -> &str {
        &self.name
    }

    fn read(&mut self, progress: Progress<'_>) -> Result<bool, String> {
        if self.recording.is_some() {
            return Ok(true);
        }
        let mut is_stopped = false;
        let bytes = Bytes::new(self.source.clone(), progress, &mut is_stopped);
        let read = Recording::read(BufReader::with_capacity(PART, bytes));
        if is_stopped {
            return Ok(false);
        }
        let name = &self.name;
        let recording = read.map_err(|error| format!("{name} cannot be shown: {error}."))?;
        match recording.pictures.all().last() {
            None => return Err(format!("{name} has no picture of its flight, so there is nothing to show.")),
            Some(last) if last.time().0 > MAX_DAYS * DAY_US => {
                return Err(format!("{name} cannot be shown: it ends more than {MAX_DAYS} days after boot."));
            }
            Some(_) => {}
        }
        self.recording = Some(Arc::new(recording));
        Ok(true)
    }

    fn count(&self) -> usize {
        1
    }

    fn notices(&self) -> Vec<String> {
        Vec::new()
    }

    fn open(&mut self, number: usize) -> Result<Box<dyn PastFlight>, String> {
        Ok(Box::new(PastRecording::new(self.recording(number)?)))
    }
}
