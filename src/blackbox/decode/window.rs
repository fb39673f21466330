//! The part of a source that is in memory.

use std::io;

use memchr::memmem;

use super::super::FIRST_LINE;
use super::source::LogSource;

/// The most bytes in memory.
const SIZE: usize = 256 * 1024;

/// A window that moves over a source, and the start of the next log in it.
#[derive(Debug)]
pub(super) struct Window<S> {
    source: S,
    buffer: Box<[u8]>,
    /// The bytes in the buffer that are not passed yet.
    from: usize,
    to: usize,
    /// The offset of the buffer in the source.
    base: u64,
    /// `true` if the source has no bytes after the buffer.
    is_last: bool,
    /// The place in the buffer before which no log begins.
    clear: usize,
    /// `true` if a log begins at `clear`.
    is_found: bool,
    /// The end of the part of the buffer that was searched.
    searched: usize,
}

impl<S: LogSource> Window<S> {
    pub(super) fn new(source: S, offset: u64) -> Self {
        let buffer = vec![0; SIZE].into_boxed_slice();
        Self {
            source,
            buffer,
            from: 0,
            to: 0,
            base: offset,
            is_last: false,
            clear: 0,
            is_found: false,
            searched: 0,
        }
    }

    /// Returns the offset of the first byte in the source.
    pub(super) fn offset(&self) -> u64 {
        self.base + self.from as u64
    }

    /// Passes bytes. They must be in memory.
    pub(super) fn advance(&mut self, count: usize) {
        self.from = (self.from + count).min(self.to);
    }

    /// Returns the bytes before the start of the next log, as far as they are in memory, and `true` if they are all.
    pub(super) fn before_next_log(&mut self) -> (&[u8], bool) {
        if self.clear < self.from {
            self.clear = self.from;
            self.is_found = false;
            self.searched = self.from;
        }
        if !self.is_found && self.searched < self.to {
            let found = memmem::find(&self.buffer[self.clear..self.to], FIRST_LINE.as_bytes());
            self.is_found = found.is_some();
            self.searched = self.to;
            // The end of the buffer may be the start of the line.
            let unfinished = (self.to + 1).saturating_sub(FIRST_LINE.len());
            self.clear = found.map_or(self.clear.max(unfinished), |at| self.clear + at);
        }
        let end = if self.is_last && !self.is_found { self.to } else { self.clear };
        (&self.buffer[self.from..end], self.is_found || self.is_last)
    }

    /// Returns `true` if the next log begins here.
    pub(super) fn is_at_log(&self) -> bool {
        self.buffer[self.from..self.to].starts_with(FIRST_LINE.as_bytes())
    }

    /// Passes the first line of a log.
    pub(super) fn pass_first_line(&mut self) {
        let rest = &self.buffer[self.from..self.to];
        let line = rest.iter().take(FIRST_LINE.len() + 2).position(|byte| *byte == b'\n');
        self.advance(line.map_or(FIRST_LINE.len(), |end| end + 1));
    }

    /// Reads as many bytes as there is room for.
    pub(super) fn fill(&mut self) -> io::Result<()> {
        self.buffer.copy_within(self.from..self.to, 0);
        self.base += self.from as u64;
        self.clear = self.clear.saturating_sub(self.from);
        self.searched = self.searched.saturating_sub(self.from);
        self.to -= self.from;
        self.from = 0;
        while self.to < SIZE && !self.is_last {
            let count = self.source.read_at(self.base + self.to as u64, &mut self.buffer[self.to..])?;
            self.is_last = count == 0;
            self.to += count;
        }
        Ok(())
    }
}
