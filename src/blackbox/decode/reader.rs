//! The logs of a file, item by item.

use std::io;
use std::sync::Arc;

use super::super::event::LogEvent;
use super::super::field::FrameKind;
use super::decoder::{Decoder, DecoderState, Step};
use super::header::{Header, HeaderError};
use super::source::LogSource;
use super::window::Window;

/// The next thing in a file of logs.
#[derive(Debug)]
pub enum Item<'a> {
    /// A log begins.
    Log {
        header: Arc<Header>,
    },
    /// A log begins that cannot be read. Its frames are passed.
    Refused {
        error: HeaderError,
    },
    Frame(Frame<'a>),
    /// An event and the time of the last main frame, µs; `None` for an event that only old firmwares or those for developers
    /// write.
    Event {
        event: Option<LogEvent>,
        time_us: u64,
    },
    /// Bytes without a frame, or frames whose values cannot be used, were passed.
    Skipped {
        bytes: u64,
        frames: u64,
    },
    /// The log ends: after its last event, at the next log, or with the file.
    LogEnd,
}

/// A frame with its values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frame<'a> {
    pub kind: FrameKind,
    /// A value for each field of the header, in two's complement also for unsigned fields.
    pub values: &'a [i32],
    /// The time of this main frame, or of the last one before this frame, µs. It never goes back, and goes on where the 32 bits
    /// of a log are full.
    pub time_us: u64,
    /// `true` if the place of home, to which coordinates are relative, is known.
    pub has_home: bool,
    /// The place of the frame in the file.
    pub offset: u64,
}

/// A place in a log at which reading can go on: that of a whole main frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ResumePoint {
    pub offset: u64,
    state: DecoderState,
}

/// What was found, without its values.
#[derive(Debug, Clone, Copy)]
enum Found {
    Frame { kind: FrameKind, offset: u64 },
    Event { event: Option<LogEvent> },
    LogEnd,
}

/// Bytes that were passed and not reported yet.
#[derive(Debug, Clone, Copy, Default)]
struct Passed {
    bytes: u64,
    frames: u64,
}

/// Reads the logs of a file.
#[derive(Debug)]
pub struct LogReader<S> {
    window: Window<S>,
    /// The log being read; `None` between logs.
    log: Option<Decoder>,
    passed: Passed,
    /// What was found after the passed bytes.
    waiting: Option<Found>,
    /// `true` after the end of the log.
    is_over: bool,
}

impl<S: LogSource> LogReader<S> {
    /// Reads from the start of a source.
    pub fn new(source: S) -> Self {
        Self::within(Window::new(source, 0), None)
    }

    /// Goes on in a log at a whole main frame, up to the end of the file.
    pub fn resumed(source: S, header: Arc<Header>, point: &ResumePoint) -> Self {
        let decoder = Decoder::resumed(header, point.state.clone());
        Self::within(Window::new(source, point.offset), Some(decoder))
    }

    fn within(window: Window<S>, log: Option<Decoder>) -> Self {
        Self { window, log, passed: Passed::default(), waiting: None, is_over: false }
    }

    /// Returns the place of a frame that was just read, for [`Self::resumed`]. `None` outside a log. The frame must be a whole
    /// main frame.
    pub fn resume_point(&self, frame_offset: u64) -> Option<ResumePoint> {
        self.log.as_ref().map(|log| ResumePoint { offset: frame_offset, state: log.state().clone() })
    }

    /// Returns the newest values of a kind of frame in the log being read; right after its end, of that one.
    pub fn newest(&self, kind: FrameKind) -> &[i32] {
        self.log.as_ref().map_or(&[], |log| log.values(kind))
    }

    /// Returns the offset of the first byte that is not read yet.
    pub fn offset(&self) -> u64 {
        self.window.offset()
    }

    /// Leaves the log being read: the next item is in the next log.
    pub fn leave_log(&mut self) {
        (self.log, self.waiting, self.is_over) = (None, None, false);
        self.passed = Passed::default();
    }

    /// Returns the next item; `None` at the end of the file.
    ///
    /// # Errors
    ///
    /// Returns the error of the source.
    pub fn next_item(&mut self) -> io::Result<Option<Item<'_>>> {
        if std::mem::take(&mut self.is_over) {
            self.log = None;
        }
        let found = match self.waiting.take() {
            Some(found) => found,
            None if self.log.is_none() => return self.next_log(),
            None => self.find()?,
        };
        if self.passed.bytes > 0 {
            self.waiting = Some(found);
            let Passed { bytes, frames } = std::mem::take(&mut self.passed);
            return Ok(Some(Item::Skipped { bytes, frames }));
        }
        let Some(log) = &self.log else { return Ok(None) };
        let time_us = log.time_us();
        Ok(Some(match found {
            Found::Frame { kind, offset } => {
                let (values, has_home) = (log.values(kind), log.has_home());
                Item::Frame(Frame { kind, values, time_us, has_home, offset })
            }
            Found::Event { event } => {
                if event == Some(LogEvent::End) {
                    self.waiting = Some(Found::LogEnd);
                }
                Item::Event { event, time_us }
            }
            Found::LogEnd => {
                self.is_over = true;
                Item::LogEnd
            }
        }))
    }

    /// Passes the bytes up to the next log and reads its header.
    fn next_log(&mut self) -> io::Result<Option<Item<'_>>> {
        loop {
            let (rest, is_all) = self.window.before_next_log();
            let count = rest.len();
            self.window.advance(count);
            if is_all && self.window.is_at_log() {
                break;
            }
            if is_all {
                return Ok(None);
            }
            self.window.fill()?;
        }
        // The window is larger than the largest header.
        self.window.fill()?;
        self.window.pass_first_line();
        let (bytes, is_all) = self.window.before_next_log();
        match Header::read(bytes, is_all) {
            Ok((header, length)) => {
                let header = Arc::new(header);
                self.window.advance(length);
                self.log = Some(Decoder::new(Arc::clone(&header)));
                Ok(Some(Item::Log { header }))
            }
            Err(error) => Ok(Some(Item::Refused { error })),
        }
    }

    /// Finds the next frame, event or end of the log.
    fn find(&mut self) -> io::Result<Found> {
        loop {
            let offset = self.window.offset();
            let Some(log) = &mut self.log else { return Ok(Found::LogEnd) };
            let (bytes, is_all) = self.window.before_next_log();
            if bytes.is_empty() && is_all {
                return Ok(Found::LogEnd);
            }
            let step = if bytes.is_empty() { Step::More } else { log.step(bytes, is_all) };
            let (length, found) = match step {
                Step::Frame { kind, length } => (length, Some(Found::Frame { kind, offset })),
                Step::Event { event, length } => (length, Some(Found::Event { event })),
                Step::UselessFrame { length } => (length, None),
                Step::StrayByte => (1, None),
                Step::UndefinedFrame { length } => {
                    self.window.advance(length);
                    continue;
                }
                Step::More => {
                    self.window.fill()?;
                    continue;
                }
            };
            self.window.advance(length);
            if let Some(found) = found {
                return Ok(found);
            }
            self.passed.bytes += length as u64;
            self.passed.frames += u64::from(matches!(step, Step::UselessFrame { .. }));
        }
    }
}
