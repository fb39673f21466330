//! The stored image of a configuration: conversion to and from bytes, without files.
//!
//! ```text
//! magic "BDCF" | format u16 | reserved u16 | payload length u32 | payload | CRC-32 over all before it
//! ```
//!
//! All numbers are little-endian. The payload is text, one record per line, with fields separated by tabs. Settings are
//! stored by name with all their profiles, so that adding, removing or reordering settings loses nothing. Records that
//! this version does not know are stored again unchanged.

use super::config::Configuration;

mod read;
mod write;

/// The first bytes of an image.
const MAGIC: [u8; 4] = *b"BDCF";
/// The first bytes of an image of the reference simulator.
const FOREIGN_MAGIC: [u8; 2] = [0xb2, 0xbe];
/// The version of the frame and of the record grammar.
const FORMAT: u16 = 1;
/// The number of bytes before the payload.
const HEADER: usize = 12;
/// The number of bytes after the payload.
const TRAILER: usize = 4;
/// The size of the largest image that is read, bytes.
pub const MAX_IMAGE: usize = 1 << 20;

const CHECKSUM: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);

/// The reason why bytes are not an image of this firmware.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum ImageError {
    /// It starts like an image of the reference simulator.
    #[error("it is the configuration of another Betaflight SITL")]
    Foreign,
    /// A later version of this program wrote it.
    #[error("a later version of betadeck wrote it (format {found}, this one reads {FORMAT})")]
    LaterFormat { found: u16 },
    /// It ends early, has bytes left over, or its checksum is wrong.
    #[error("it is damaged")]
    Damaged,
}

/// Writes the image of a configuration.
pub fn encode(configuration: &Configuration) -> Vec<u8> {
    let payload = write::payload(configuration);
    let mut image = Vec::with_capacity(HEADER + payload.len() + TRAILER);
    image.extend(MAGIC);
    image.extend(FORMAT.to_le_bytes());
    image.extend([0, 0]);
    image.extend((payload.len() as u32).to_le_bytes());
    image.extend(payload.as_bytes());
    image.extend(CHECKSUM.checksum(&image).to_le_bytes());
    image
}

/// Returns the records of a configuration, without the frame of an image.
pub fn to_text(configuration: &Configuration) -> String {
    write::payload(configuration)
}

/// Reads the records of a configuration. The second part lists the values that cannot be used, as in [`decode`].
///
/// # Errors
/// Fails if the text is longer than an image.
pub fn from_text(text: &str) -> Result<(Configuration, Vec<String>), ImageError> {
    if text.len() > MAX_IMAGE {
        return Err(ImageError::Damaged);
    }
    Ok(read::configuration(text))
}

/// Reads an image. The second part lists, in sentences, the stored values that cannot be used and were left at their
/// default.
pub fn decode(image: &[u8]) -> Result<(Configuration, Vec<String>), ImageError> {
    if image.starts_with(&FOREIGN_MAGIC) {
        return Err(ImageError::Foreign);
    }
    let damaged = ImageError::Damaged;
    if image.len() > MAX_IMAGE || !image.starts_with(&MAGIC) {
        return Err(damaged);
    }
    let (body, checksum) = image.split_last_chunk::<TRAILER>().ok_or(damaged)?;
    let (header, payload) = body.split_first_chunk::<HEADER>().ok_or(damaged)?;
    if CHECKSUM.checksum(body) != u32::from_le_bytes(*checksum) {
        return Err(damaged);
    }
    let &[_, _, _, _, format_low, format_high, _, _, length @ ..] = header;
    let found = u16::from_le_bytes([format_low, format_high]);
    if found > FORMAT {
        return Err(ImageError::LaterFormat { found });
    }
    if payload.len() != u32::from_le_bytes(length) as usize {
        return Err(damaged);
    }
    let payload = std::str::from_utf8(payload).map_err(|_| damaged)?;
    Ok(read::configuration(payload))
}
