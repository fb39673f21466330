//! A place in a log that moves from main frame to main frame.

use std::io;
use std::sync::Arc;

use super::block::Block;
use super::flight::{LogCounts, LogEnd};
use super::sample::LogSample;
use super::signal::{Newest, SignalTable};
use super::tracker::Tracker;
use crate::blackbox::decode::{Frame, Header, Item, LogReader, LogSource};
use crate::blackbox::{FrameKind, LogEvent};
use crate::signals::SimTime;

/// Reads a log from main frame to main frame. Between two main frames it knows the other frames before the second one.
#[derive(Debug)]
pub struct FlightCursor<'a, S> {
    reader: LogReader<S>,
    table: &'a SignalTable,
    tracker: Tracker,
    /// The values of the main frame at which the cursor is.
    main: Vec<i32>,
    /// The next main frame and its values; `None` at the end of the log.
    next: Option<NextFrame>,
    next_main: Vec<i32>,
    /// The counts up to here; of frames, main frames only.
    end: LogEnd,
}

/// A main frame without its values.
#[derive(Debug, Clone, Copy)]
struct NextFrame {
    time_us: u64,
    offset: u64,
    has_home: bool,
}

impl<'a, S: LogSource> FlightCursor<'a, S> {
    /// Returns a cursor at the first frame of a block. `before` counts what was skipped before it.
    pub(super) fn new(
        header: &Arc<Header>,
        table: &'a SignalTable,
        block: &Block,
        source: S,
        before: LogCounts,
    ) -> io::Result<Self> {
        let mut tracker = Tracker::from_header(header);
        tracker.state = block.state.clone();
        let reader = LogReader::resumed(source, Arc::clone(header), &block.point);
        let (main, next_main) = (Vec::new(), Vec::new());
        let end = LogEnd { counts: before, ..LogEnd::default() };
        let mut cursor = Self { reader, table, tracker, main, next: None, next_main, end };
        cursor.read_ahead()?;
        cursor.advance()?;
        Ok(cursor)
    }

    /// Returns the time of the frame at which the cursor is.
    pub fn time(&self) -> SimTime {
        self.tracker.state.sample.time
    }

    /// Moves to the next main frame. Returns `false` at the end of the log.
    ///
    /// # Errors
    ///
    /// Returns the error of the source.
    pub fn advance(&mut self) -> io::Result<bool> {
        let Some(NextFrame { time_us, offset, has_home }) = self.next.take() else { return Ok(false) };
        std::mem::swap(&mut self.main, &mut self.next_main);
        let kind = FrameKind::Inter;
        self.tracker.take(&Frame { kind, values: &self.main, time_us, has_home, offset });
        self.read_ahead()?;
        Ok(true)
    }

    /// Moves to the last main frame not after `time`, or does nothing if the next one is later.
    ///
    /// # Errors
    ///
    /// Returns the error of the source.
    pub fn advance_to(&mut self, time: SimTime) -> io::Result<()> {
        while self.next.is_some_and(|next| next.time_us <= time.0) {
            self.advance()?;
        }
        Ok(())
    }

    /// Returns the sample with the values of all signals.
    pub fn sample(&self) -> LogSample {
        let values = self.values().collect();
        LogSample { values, ..self.tracker.state.sample.clone() }
    }

    /// Returns the values of all signals, in the order of the list of the log; NaN for an unknown one.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        self.table.values(self.newest())
    }

    /// Returns what was found from the start of the cursor on, once it is at the end of the log.
    pub fn end(&self) -> LogEnd {
        self.end
    }

    /// Returns the number of logs after this one, readable or not: those before `is_stopped` says so.
    ///
    /// # Errors
    ///
    /// Returns the error of the source.
    pub fn count_logs_after(mut self, is_stopped: impl Fn() -> bool) -> io::Result<usize> {
        let mut count = 0;
        self.reader.leave_log();
        while !is_stopped() && self.reader.next_item()?.is_some() {
            count += 1;
            self.reader.leave_log();
        }
        Ok(count)
    }

    /// Returns the sample without the values of the signals.
    pub fn latest(&self) -> &LogSample {
        &self.tracker.state.sample
    }

    /// Returns the value of a signal, by its place in the list of the log.
    pub fn value(&self, signal: usize) -> Option<f64> {
        self.table.read(signal, &self.newest())
    }

    fn newest(&self) -> Newest<'_> {
        Newest {
            main: &self.main,
            slow: self.reader.newest(FrameKind::Slow),
            gps: self.reader.newest(FrameKind::Gps),
            state: &self.tracker.state,
        }
    }

    /// Reads up to the next main frame.
    fn read_ahead(&mut self) -> io::Result<()> {
        loop {
            match self.reader.next_item()? {
                None | Some(Item::Log { .. } | Item::Refused { .. } | Item::LogEnd) => return Ok(()),
                Some(Item::Frame(Frame {
                    kind: FrameKind::Intra | FrameKind::Inter,
                    values,
                    time_us,
                    has_home,
                    offset,
                })) => {
                    self.next_main.clear();
                    self.next_main.extend_from_slice(values);
                    self.next = Some(NextFrame { time_us, offset, has_home });
                    self.end.counts.main += 1;
                    self.end.counts.skipped_bytes += std::mem::take(&mut self.end.cut_bytes);
                    return Ok(());
                }
                Some(Item::Frame(frame)) => self.tracker.take(&frame),
                Some(Item::Event { event: Some(LogEvent::FlightMode { new, .. }), .. }) => {
                    self.tracker.take_flags(new);
                }
                Some(Item::Event { event, .. }) => self.end.is_complete |= event == Some(LogEvent::End),
                Some(Item::Skipped { bytes, frames, .. }) => {
                    self.end.cut_bytes += bytes;
                    self.end.counts.skipped_frames += frames;
                }
            }
        }
    }
}
