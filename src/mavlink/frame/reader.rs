//! Finds frames in a stream of bytes.

use std::collections::BTreeMap;

use super::{Found, Frame, MAX_FRAME, examine};

/// The number of senders whose losses are counted.
const MAX_SENDERS: usize = 32;
/// A gap of this length or more is an old frame that arrives late.
const LATE: u8 = 128;

/// The numbers of frames and bytes that a reader met.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ReaderCounts {
    /// Frames that were returned.
    pub frames: u64,
    /// Frames of messages that the table lacks.
    pub unknown: u64,
    /// Signed frames, which are refused.
    pub signed: u64,
    /// Frames with incompatibility flags that are not known.
    pub incompatible: u64,
    /// Beginnings of frames with a wrong checksum.
    pub bad_checksum: u64,
    /// Beginnings of frames whose length contradicts the message.
    pub bad_length: u64,
    /// Bytes outside of frames.
    pub garbage: u64,
}

/// The frames of one sender.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Loss {
    /// Frames that arrived.
    pub received: u64,
    /// Frames that are missing, by their sequence numbers.
    pub lost: u64,
    next: u8,
}

/// Finds frames in a stream of bytes, which may arrive in pieces of any size.
///
/// After garbage the reader looks for the next frame byte by byte. A frame of an unknown message is skipped as a whole if
/// it follows a frame directly: its checksum cannot be checked, and its payload may contain the bytes of another frame.
#[derive(Debug, Clone, Default)]
pub struct FrameReader {
    pub(super) buffer: Vec<u8>,
    /// The length of the frame at the beginning of the buffer that was returned last.
    returned: usize,
    /// `true` if the bytes before the buffer are no frame.
    is_lost: bool,
    counts: ReaderCounts,
    losses: BTreeMap<(u8, u8), Loss>,
}

impl FrameReader {
    /// Returns the next frame, and takes the bytes up to its end from the front of `bytes`. Returns `None` when all bytes
    /// are taken.
    pub fn next_frame(&mut self, bytes: &mut &[u8]) -> Option<Frame> {
        let returned = std::mem::take(&mut self.returned);
        self.drop_front(returned);
        loop {
            let skipped = match examine(&self.buffer).after_garbage(self.is_lost, self.buffer.len()) {
                Found::Incomplete(length) => {
                    // Not more than that, so that what is found does not depend on the pieces.
                    let missing = length.saturating_sub(self.buffer.len());
                    let (taken, rest) = bytes.split_at(missing.min(bytes.len()));
                    self.buffer.extend(taken);
                    *bytes = rest;
                    if taken.len() < missing {
                        return None;
                    }
                    continue;
                }
                Found::Frame(frame, length) => {
                    self.is_lost = false;
                    self.returned = length;
                    self.count(&frame);
                    return Some(frame);
                }
                Found::Signed(length) => {
                    self.counts.signed += 1;
                    length
                }
                Found::Incompatible(length) => {
                    self.counts.incompatible += 1;
                    length
                }
                Found::Unknown(length) => {
                    self.counts.unknown += 1;
                    length
                }
                Found::BadChecksum => {
                    self.counts.bad_checksum += 1;
                    self.garbage()
                }
                Found::BadLength => {
                    self.counts.bad_length += 1;
                    self.garbage()
                }
                Found::Garbage => self.garbage(),
            };
            self.drop_front(skipped);
        }
    }

    /// Returns the bytes of the frame that was returned last.
    pub fn frame_bytes(&self) -> &[u8] {
        &self.buffer[..self.returned]
    }

    /// Returns the numbers of frames and bytes so far.
    pub fn counts(&self) -> ReaderCounts {
        self.counts
    }

    /// Returns the frames that arrived and those that are missing, by system and component. Only the first 32 senders are
    /// counted.
    pub fn losses(&self) -> &BTreeMap<(u8, u8), Loss> {
        &self.losses
    }

    fn drop_front(&mut self, length: usize) {
        debug_assert!(self.buffer.len() <= MAX_FRAME);
        self.buffer.drain(..length.min(self.buffer.len()));
    }

    /// Counts a byte that begins no frame, and returns 1.
    fn garbage(&mut self) -> usize {
        self.counts.garbage += 1;
        self.is_lost = true;
        1
    }

    fn count(&mut self, frame: &Frame) {
        self.counts.frames += 1;
        let (sender, is_full) = ((frame.system, frame.component), self.losses.len() >= MAX_SENDERS);
        if is_full && !self.losses.contains_key(&sender) {
            return;
        }
        let loss = self.losses.entry(sender).or_insert(Loss { next: frame.sequence, ..Loss::default() });
        loss.received += 1;
        let gap = frame.sequence.wrapping_sub(loss.next);
        if gap < LATE {
            loss.lost += u64::from(gap);
            loss.next = frame.sequence.wrapping_add(1);
        }
    }
}
