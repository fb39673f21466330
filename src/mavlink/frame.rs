//! The frames of MAVLink 1 and 2.
//!
//! ```text
//! v1  FE len seq system component id:u8 payload… crc:u16
//! v2  FD len incompat compat seq system component id:u24 payload… crc:u16 [signature: 13 bytes, if incompat bit 0]
//! ```
//!
//! All integers are little-endian. The checksum covers everything after the first byte, and the CRC_EXTRA byte of the message
//! after it. Version 2 cuts zeros at the end of the payload; version 1 has no extension fields.

mod examine;
mod reader;

pub(super) use examine::{Found, examine};
pub use reader::{FrameReader, Loss, ReaderCounts};

use super::crc;
use super::message::Message;

/// The first byte of a version 1 frame.
const START_V1: u8 = 0xfe;
/// The first byte of a version 2 frame.
const START_V2: u8 = 0xfd;
/// Bytes of a version 1 frame before the payload.
const HEADER_V1: usize = 6;
/// Bytes of a version 2 frame before the payload.
const HEADER_V2: usize = 10;
/// Bytes of the checksum.
const CHECKSUM: usize = 2;
/// Bytes of a signature.
const SIGNATURE: usize = 13;
/// The length of the longest frame, bytes.
pub const MAX_FRAME: usize = HEADER_V2 + 255 + CHECKSUM + SIGNATURE;

/// Returns `true` if a frame can begin with this byte.
pub fn is_start(byte: u8) -> bool {
    [START_V1, START_V2].contains(&byte)
}

/// The version of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum Version {
    /// MAVLink 1: message numbers to 255, no extension fields.
    V1,
    /// MAVLink 2.
    #[default]
    V2,
}

/// A message with its sender.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// The version on the wire.
    pub version: Version,
    /// The number of the frame among those of its sender, modulo 256.
    pub sequence: u8,
    /// The system of the sender.
    pub system: u8,
    /// The component of the sender.
    pub component: u8,
    /// The message.
    pub message: Message,
}

impl Frame {
    /// Returns the bytes of the frame, or `None` if version 1 cannot carry the message.
    pub fn encode(&self) -> Option<Vec<u8>> {
        let info = self.message.info();
        let [id, id_middle, id_high, _] = info.id.to_le_bytes();
        let mut frame = match self.version {
            Version::V1 if info.id > 0xff => return None,
            Version::V1 => vec![START_V1, 0, self.sequence, self.system, self.component, id],
            Version::V2 => {
                vec![START_V2, 0, 0, 0, self.sequence, self.system, self.component, id, id_middle, id_high]
            }
        };
        let begin = frame.len();
        self.message.encode(&mut frame);
        match self.version {
            Version::V1 => frame.truncate(begin + info.base_length),
            Version::V2 => {
                let used = frame[begin..].iter().rposition(|byte| *byte != 0).unwrap_or(0) + 1;
                frame.truncate(begin + used);
            }
        }
        frame[1] = (frame.len() - begin) as u8;
        let sum = crc::with_byte(crc::with_bytes(crc::START, &frame[1..]), info.crc_extra);
        frame.extend(sum.to_le_bytes());
        Some(frame)
    }
}

#[cfg(test)]
mod tests;
