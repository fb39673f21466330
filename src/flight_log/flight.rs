//! One log of a file: what is in it, and any instant of it.

use std::io;
use std::ops::Range;
use std::sync::Arc;

use super::block::{Block, Extents};
use super::cursor::FlightCursor;
use super::mark::LogMark;
use super::place::{LogHome, TrackFix};
use super::sample::LogSample;
use super::signal::{Extent, LogSignal, SignalTable};
use crate::blackbox::decode::{Header, HeaderFinding, LogSource};
use crate::signals::SimTime;

/// The numbers of frames and bytes in a log.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LogCounts {
    /// Main frames that can be used.
    pub main: u64,
    pub slow: u64,
    pub gps: u64,
    /// Frames between damaged bytes and the next whole frame, which cannot be used.
    pub skipped_frames: u64,
    /// Bytes that were skipped between two main frames.
    pub skipped_bytes: u64,
}

/// The findings that need a log to be read to its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LogEnd {
    pub counts: LogCounts,
    /// The bytes after the last whole frame that belong to no frame.
    pub cut_bytes: u64,
    /// `true` if the log ends with the event of its end, and `false` if it is cut.
    pub is_complete: bool,
}

/// One log of a file. Times are those of the craft's clock, from [`Self::first`] to [`Self::last`].
#[derive(Debug)]
pub struct LogFlight {
    pub(super) number: usize,
    pub(super) header: Arc<Header>,
    pub(super) findings: Vec<HeaderFinding>,
    pub(super) first: SimTime,
    pub(super) last: SimTime,
    pub(super) table: SignalTable,
    pub(super) marks: Vec<LogMark>,
    pub(super) track: Vec<TrackFix>,
    pub(super) home: Option<LogHome>,
    /// The frames and bytes skipped before the first main frame.
    pub(super) start: LogCounts,
    pub(super) end: LogEnd,
    pub(super) blocks: Vec<Block>,
    pub(super) extents: Extents,
}

impl LogFlight {
    /// Returns the number of the log in its file, from 1.
    pub fn number(&self) -> usize {
        self.number
    }

    pub fn header(&self) -> &Header {
        &self.header
    }

    /// Returns what is wrong with the header, and what is assumed.
    pub fn findings(&self) -> &[HeaderFinding] {
        &self.findings
    }

    /// Returns the time of the first main frame.
    pub fn first(&self) -> SimTime {
        self.first
    }

    /// Returns the time of the last main frame.
    pub fn last(&self) -> SimTime {
        self.last
    }

    /// Returns `true` if the log has no main frame, so that there is nothing to show.
    pub fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// Returns the signals: derived ones first, then the fields of main, slow and GPS frames.
    pub fn signals(&self) -> &[LogSignal] {
        &self.table.signals
    }

    /// Returns the marks, oldest first; at most 10 000.
    pub fn marks(&self) -> &[LogMark] {
        &self.marks
    }

    /// Returns samples a few milliseconds to a few seconds apart, without reading the log: more bytes lie between those of
    /// a larger file. They have no values of signals.
    pub fn coarse_samples(&self) -> impl ExactSizeIterator<Item = &LogSample> {
        self.blocks.iter().map(|block| &block.state.sample)
    }

    /// Returns the number of parts of a range of time whose extents are known without reading the log.
    pub fn coarse_parts(&self, range: &Range<SimTime>) -> usize {
        self.block_at(range.end) - self.block_at(range.start).min(self.block_at(range.end))
    }

    /// Returns the places of the GPS frames, at most 20 000, evenly thinned out.
    pub fn track(&self) -> &[TrackFix] {
        &self.track
    }

    /// Returns the last home of the log; without one the first place with a fix.
    pub fn home(&self) -> Option<LogHome> {
        self.home
    }

    pub fn counts(&self) -> LogCounts {
        self.end.counts
    }

    /// Returns what is known at the end of the log.
    pub fn end(&self) -> LogEnd {
        self.end
    }

    /// Returns a cursor at the last main frame not after `time`, or at the first one. Returns `None` if the log is empty.
    ///
    /// # Errors
    ///
    /// Returns the error of the source.
    pub fn cursor<S: LogSource>(&self, source: S, time: SimTime) -> io::Result<Option<FlightCursor<'_, S>>> {
        let at = self.block_at(time);
        let Some(block) = self.blocks.get(at) else { return Ok(None) };
        let before = if at == 0 { self.start } else { LogCounts::default() };
        let mut cursor = FlightCursor::new(&self.header, &self.table, block, source, before)?;
        cursor.advance_to(time)?;
        Ok(Some(cursor))
    }

    /// Returns the sample of the last main frame not after `time`, or of the first one. Returns `None` if the log is empty.
    ///
    /// # Errors
    ///
    /// Returns the error of the source.
    pub fn sample<S: LogSource>(&self, source: S, time: SimTime) -> io::Result<Option<LogSample>> {
        Ok(self.cursor(source, time)?.map(|cursor| cursor.sample()))
    }

    /// Returns the place of a signal in [`Self::signals`].
    pub fn find(&self, name: &str) -> Option<usize> {
        self.table.find(name)
    }

    /// Returns the extents of a signal in equal parts of a range of time. A part without a frame has none.
    ///
    /// If the parts are long, they reach up to a block of the index beyond their ends: some milliseconds to a few seconds.
    ///
    /// # Errors
    ///
    /// Returns the error of the source.
    pub fn series<S: LogSource>(
        &self,
        source: S,
        signal: usize,
        range: Range<SimTime>,
        parts: usize,
    ) -> io::Result<Vec<Option<Extent>>> {
        let mut extents = vec![Extent::NONE; parts];
        let (first, last) = (self.block_at(range.start), self.block_at(range.end));
        let part = Parts { range: range.clone(), count: parts };
        if last - first >= parts {
            for block in first..=last {
                let end = self.blocks.get(block + 1).map_or(self.last, |next| next.time);
                let Some(begin) = self.blocks.get(block).map(|block| block.time) else { break };
                for at in part.of(begin)..=part.of(end) {
                    extents
                        .iter_mut()
                        .skip(at)
                        .take(1)
                        .for_each(|extent| extent.merge(self.extents.get(block, signal)));
                }
            }
        } else if let Some(mut cursor) = self.cursor(source, range.start)? {
            while cursor.time() < range.end {
                if let (Some(value), true) = (cursor.value(signal), cursor.time() >= range.start) {
                    extents
                        .iter_mut()
                        .skip(part.of(cursor.time()))
                        .take(1)
                        .for_each(|extent| extent.include(value));
                }
                if !cursor.advance()? {
                    break;
                }
            }
        }
        Ok(extents.into_iter().map(Extent::known).collect())
    }

    /// Returns the last block that does not begin after `time`, or the first one.
    fn block_at(&self, time: SimTime) -> usize {
        self.blocks.partition_point(|block| block.time <= time).saturating_sub(1)
    }
}

/// Equal parts of a range of time.
#[derive(Debug, Clone)]
struct Parts {
    range: Range<SimTime>,
    count: usize,
}

impl Parts {
    /// Returns the part that a time belongs to, or the nearest one.
    fn of(&self, time: SimTime) -> usize {
        let length = u128::from(self.range.end.0.saturating_sub(self.range.start.0)).max(1);
        let since = u128::from(time.0.saturating_sub(self.range.start.0));
        let part = since * self.count as u128 / length;
        usize::try_from(part).unwrap_or(usize::MAX).min(self.count.saturating_sub(1))
    }
}
