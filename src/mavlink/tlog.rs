//! Telemetry logs, `.tlog`: each frame after its time in microseconds since 1970, 8 bytes, big-endian.

use std::time::Duration;

use super::frame::{Found, Frame, FrameReader, MAX_FRAME, examine};

/// Bytes of a time.
const STAMP: usize = 8;
/// Times of records are before the year 2200. Others are garbage.
const LATEST: Duration = Duration::from_secs(230 * 31_556_952);

/// A frame of a log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Record {
    /// Time since 1970.
    pub time: Duration,
    /// The frame.
    pub frame: Frame,
}

/// Appends a frame to a log. `frame` has the bytes of one frame.
pub fn write(time: Duration, frame: &[u8], log: &mut Vec<u8>) {
    log.extend((time.as_micros() as u64).to_be_bytes());
    log.extend(frame);
}

/// Makes a log of a stream of bytes.
#[derive(Debug, Clone, Default)]
pub struct LogWriter {
    reader: FrameReader,
}

impl LogWriter {
    /// Takes bytes that arrived at a time, and appends the frames in them to a log. Everything else is left out.
    pub fn write(&mut self, time: Duration, mut bytes: &[u8], log: &mut Vec<u8>) {
        while self.reader.next_frame(&mut bytes).is_some() {
            write(time, self.reader.frame_bytes(), log);
        }
    }
}

/// The result of reading the beginning of a buffer.
#[allow(clippy::large_enum_variant, reason = "a box would cost an allocation a record")]
enum Step {
    Record(Record),
    /// Bytes were dropped.
    Skipped,
    /// The buffer must have at least this length.
    Needs(usize),
}

/// Reads a log that arrives in pieces of any size. A record that is cut off at the end is left out; after garbage the reader
/// looks for the next record.
#[derive(Debug, Clone, Default)]
pub struct LogReader {
    buffer: Vec<u8>,
    skipped: u64,
    is_lost: bool,
}

impl LogReader {
    /// Returns the next record, and takes the bytes up to its end from the front of `bytes`. Returns `None` when all bytes
    /// are taken.
    pub fn next_record(&mut self, bytes: &mut &[u8]) -> Option<Record> {
        loop {
            match self.step() {
                Step::Record(record) => return Some(record),
                Step::Skipped => {}
                Step::Needs(length) => {
                    let missing = length.saturating_sub(self.buffer.len());
                    let (taken, later) = bytes.split_at(missing.min(bytes.len()));
                    self.buffer.extend(taken);
                    *bytes = later;
                    if taken.len() < missing {
                        return None;
                    }
                }
            }
        }
    }

    /// Returns the next record at the end of the log, when no more bytes follow. What looked like the beginning of a record
    /// and has no end may have hidden others.
    pub fn last_record(&mut self) -> Option<Record> {
        while !self.buffer.is_empty() {
            match self.step() {
                Step::Record(record) => return Some(record),
                Step::Skipped => {}
                Step::Needs(_) => self.skip(1),
            }
        }
        None
    }

    /// Reads the beginning of the buffer.
    fn step(&mut self) -> Step {
        let (stamp, rest) = self.buffer.split_at(self.buffer.len().min(STAMP));
        let micros = stamp.try_into().map(u64::from_be_bytes).unwrap_or_default();
        let time = Duration::from_micros(micros);
        let found = examine(rest).after_garbage(self.is_lost, rest.len());
        match found {
            Found::Incomplete(length) => return Step::Needs(STAMP + length),
            _ if time > LATEST => self.skip(1),
            Found::Frame(frame, length) => {
                self.is_lost = false;
                self.drop_front(STAMP + length);
                return Step::Record(Record { time, frame });
            }
            // Frames that are not read are passed over as a whole.
            Found::Unknown(length) | Found::Signed(length) | Found::Incompatible(length) => {
                self.skip(STAMP + length);
                self.is_lost = false;
            }
            Found::BadLength | Found::BadChecksum | Found::Garbage => self.skip(1),
        }
        Step::Skipped
    }

    fn skip(&mut self, length: usize) {
        self.is_lost = true;
        self.skipped += length as u64;
        self.drop_front(length);
    }

    /// Returns the number of bytes that were passed over: garbage, and frames of unknown messages.
    pub fn skipped(&self) -> u64 {
        self.skipped
    }

    fn drop_front(&mut self, length: usize) {
        debug_assert!(self.buffer.len() <= STAMP + MAX_FRAME);
        self.buffer.drain(..length.min(self.buffer.len()));
    }
}

#[cfg(test)]
mod tests;
