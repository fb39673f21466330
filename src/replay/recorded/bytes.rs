//! The bytes of a file, read from the beginning to the end.

use std::io::{self, Read};

use crate::blackbox::decode::LogSource;
use crate::replay::Progress;

/// Reads a file and reports how much was read. Ends early if nobody waits for it.
pub(super) struct Bytes<'p, S> {
    source: S,
    at: u64,
    progress: Progress<'p>,
    is_stopped: &'p mut bool,
}

impl<'p, S: LogSource> Bytes<'p, S> {
    /// Sets `is_stopped` if the progress stops the reading.
    pub(super) fn new(source: S, progress: Progress<'p>, is_stopped: &'p mut bool) -> Self {
        Self { source, at: 0, progress, is_stopped }
    }
}

impl<S: LogSource> Read for Bytes<'_, S> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let size = self.source.size();
        if *self.is_stopped || !(self.progress)(self.at as f64 / size.max(1) as f64) {
            *self.is_stopped = true;
            return Ok(0);
        }
        let count = self.source.read_at(self.at, buffer)?;
        self.at += count as u64;
        Ok(count)
    }
}
