//! Decides whether bytes begin with a frame.

use super::super::crc;
use super::super::message::{Message, MessageInfo};
use super::{CHECKSUM, Frame, HEADER_V1, HEADER_V2, SIGNATURE, START_V1, START_V2, Version};

/// The bit of the incompatibility flags that announces a signature.
const SIGNED: u8 = 1;

/// The beginning of some bytes. Lengths are those of the whole frame, bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "a box would cost an allocation a frame")]
pub(in super::super) enum Found {
    /// More bytes decide, at least up to this length.
    Incomplete(usize),
    /// A frame with its length.
    Frame(Frame, usize),
    /// The frame of a message that the table lacks, so that nothing can be said about its checksum. It may be incomplete.
    Unknown(usize),
    /// A frame with a signature, which nobody here can check.
    Signed(usize),
    /// A frame with other incompatibility flags.
    Incompatible(usize),
    /// The length contradicts the message.
    BadLength,
    /// The checksum is wrong.
    BadChecksum,
    /// The first byte begins no frame.
    Garbage,
}

impl Found {
    /// Returns what it is if an unknown frame is only believed after a frame or at the beginning of a stream: then the whole
    /// frame is awaited. Elsewhere its header is garbage, more likely than not.
    pub(in super::super) fn after_garbage(self, is_lost: bool, available: usize) -> Self {
        match self {
            Self::Unknown(_) if is_lost => Self::Garbage,
            Self::Unknown(length) if available < length => Self::Incomplete(length),
            other => other,
        }
    }
}

/// Examines the beginning of bytes.
pub(in super::super) fn examine(bytes: &[u8]) -> Found {
    let (version, header) = match bytes.first() {
        None => return Found::Incomplete(1),
        Some(&START_V1) => (Version::V1, HEADER_V1),
        Some(&START_V2) => (Version::V2, HEADER_V2),
        Some(_) => return Found::Garbage,
    };
    let Some((head, rest)) = bytes.split_at_checked(header) else { return Found::Incomplete(header) };
    let length = usize::from(head[1]);
    let (flags, sequence, system, component, id) = match *head {
        [_, _, sequence, system, component, id] => (0, sequence, system, component, u32::from(id)),
        [_, _, flags, _, sequence, system, component, low, middle, high] => {
            (flags, sequence, system, component, u32::from_le_bytes([low, middle, high, 0]))
        }
        _ => return Found::Garbage,
    };
    let whole = header + length + CHECKSUM + if flags & SIGNED != 0 { SIGNATURE } else { 0 };
    let Some(info) = MessageInfo::find(id) else {
        return Found::Unknown(whole);
    };
    if version == Version::V1 && length != info.base_length {
        return Found::BadLength;
    }
    if bytes.len() < whole {
        return Found::Incomplete(whole);
    }
    let (payload, rest) = rest.split_at(length);
    let sum = crc::with_bytes(crc::with_bytes(crc::START, &head[1..]), payload);
    if !rest.starts_with(&crc::with_byte(sum, info.crc_extra).to_le_bytes()) {
        return Found::BadChecksum;
    }
    if flags & SIGNED != 0 {
        return Found::Signed(whole);
    }
    if flags != 0 {
        return Found::Incompatible(whole);
    }
    match Message::decode(id, payload) {
        Some(message) => Found::Frame(Frame { version, sequence, system, component, message }, whole),
        None => Found::Unknown(whole),
    }
}
