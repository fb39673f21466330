//! The logs of a file, from one pass over its bytes.

use std::io;

use super::builder::FlightBuilder;
use super::flight::LogFlight;
use crate::blackbox::decode::{HeaderError, Item, LogReader, LogSource};

/// The most logs of a file that are kept, readable or not.
const MAX_LOGS: usize = 500;
/// The items of a file that are read in one step.
const ITEMS_IN_STEP: usize = 20_000;

/// The logs of a file.
#[derive(Debug, Default)]
pub struct LogFile {
    /// The logs in their order in the file, also those without any frame.
    pub flights: Vec<LogFlight>,
    pub refused: Vec<RefusedLog>,
    /// The number of logs beyond the first 500.
    pub left_out: usize,
}

/// A log that cannot be read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RefusedLog {
    /// Its number in the file, from 1.
    pub number: usize,
    pub error: HeaderError,
}

/// The progress of an [`Indexer`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct IndexProgress {
    /// Bytes that were read, and all bytes of the file.
    pub read: u64,
    pub of: u64,
    pub is_done: bool,
}

/// Reads a file of logs once, in steps, and collects what a display needs to show them and to find any instant. Takes at
/// most some 50 MB, whatever the file.
#[derive(Debug)]
pub struct Indexer<S> {
    reader: LogReader<S>,
    size: u64,
    building: Option<FlightBuilder>,
    /// The number of logs that have begun.
    begun: usize,
    found: LogFile,
}

impl<S: LogSource> Indexer<S> {
    pub fn new(source: S) -> Self {
        let size = source.size();
        Self { reader: LogReader::new(source), size, building: None, begun: 0, found: LogFile::default() }
    }

    /// Reads on.
    ///
    /// # Errors
    ///
    /// Returns the error of the source.
    pub fn step(&mut self) -> io::Result<IndexProgress> {
        let mut is_done = false;
        for _ in 0..ITEMS_IN_STEP {
            if !self.item()? {
                is_done = true;
                break;
            }
        }
        Ok(IndexProgress { read: self.reader.offset(), of: self.size, is_done })
    }

    /// Returns the logs found so far; the one being read is not among them.
    pub fn finish(self) -> LogFile {
        self.found
    }

    /// Reads only until a log can be read with a cursor: the one with this number, from 1, or the first one with a frame. What is
    /// known at the end of that log is missing. Returns `None` once `is_stopped` says so.
    ///
    /// # Errors
    ///
    /// Returns the error of the source.
    pub fn run_to_start(
        mut self,
        number: Option<usize>,
        is_stopped: impl Fn() -> bool,
    ) -> io::Result<Option<LogFile>> {
        while self.item()? {
            if is_stopped() {
                return Ok(None);
            }
            let is_wanted = number.is_none_or(|number| number == self.begun);
            if is_wanted && let Some(building) = self.building.take_if(|building| building.has_begun()) {
                self.found.flights.push(building.finish(self.begun));
                break;
            }
        }
        Ok(Some(self.found))
    }

    /// Reads the whole file.
    ///
    /// # Errors
    ///
    /// Returns the error of the source.
    pub fn run(mut self) -> io::Result<LogFile> {
        while !self.step()?.is_done {}
        Ok(self.found)
    }

    /// Reads an item. Returns `false` at the end of the file.
    fn item(&mut self) -> io::Result<bool> {
        let mut taken = None;
        match self.reader.next_item()? {
            None => return Ok(false),
            Some(Item::Log { header, .. }) => {
                self.begun += 1;
                self.building = (self.begun <= MAX_LOGS).then(|| FlightBuilder::new(header, self.size));
            }
            Some(Item::Refused { error, .. }) => {
                self.begun += 1;
                if self.begun <= MAX_LOGS {
                    self.found.refused.push(RefusedLog { number: self.begun, error });
                }
            }
            Some(Item::Frame(frame)) => {
                if let Some(building) = &mut self.building {
                    let begins = building.frame(&frame);
                    taken = Some((frame.kind, begins.then_some(frame.offset)));
                }
            }
            Some(Item::Event { event: Some(event), time_us, .. }) => {
                self.building.iter_mut().for_each(|building| building.event(event, time_us));
            }
            Some(Item::Event { .. }) => {}
            Some(Item::Skipped { bytes, frames, .. }) => {
                self.building.iter_mut().for_each(|building| building.skip(bytes, frames));
            }
            Some(Item::LogEnd) => {
                let finished = self.building.take().map(|building| building.finish(self.begun));
                self.found.flights.extend(finished);
            }
        }
        self.found.left_out = self.begun.saturating_sub(MAX_LOGS);
        if let (Some((kind, begins)), Some(building)) = (taken, &mut self.building) {
            let point = begins.and_then(|offset| self.reader.resume_point(offset));
            let is_start = point.is_some();
            point.into_iter().for_each(|point| building.begin_block(point));
            building.widen(kind, is_start, &self.reader);
        }
        Ok(true)
    }
}
