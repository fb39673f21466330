//! The stored image. The bytes are read as a complete file and as the records of an image with a good
//! checksum.

use betadeck::firmware::config::Configuration;
use betadeck::firmware::storage::{ImageError, MAX_IMAGE, decode, encode};

use super::craft;

/// The number of bytes before and after the records.
const FRAME: usize = 16;

/// Reads the bytes as an image, and as the records of one.
pub fn run(data: &[u8]) {
    match decode(data) {
        Ok((configuration, _)) => {
            let (body, checksum) = data.split_last_chunk().expect("a checksum");
            assert_eq!(checksum_of(body), u32::from_le_bytes(*checksum), "a wrong checksum is accepted");
            assert_damage_is_seen(data);
            assert_good(&configuration);
        }
        Err(reason) => assert_eq!(reason == ImageError::Foreign, data.starts_with(&[0xb2, 0xbe])),
    }
    let sealed = seal(data);
    match decode(&sealed) {
        Ok((configuration, findings)) => {
            assert!(findings.len() <= data.len());
            assert_good(&configuration);
        }
        Err(_) => assert!(sealed.len() > MAX_IMAGE || std::str::from_utf8(data).is_err()),
    }
}

/// Returns an image of these records.
pub fn seal(records: &[u8]) -> Vec<u8> {
    let mut image = Vec::with_capacity(records.len() + FRAME);
    image.extend(b"BDCF\x01\x00\x00\x00");
    image.extend((records.len() as u32).to_le_bytes());
    image.extend(records);
    image.extend(checksum_of(&image).to_le_bytes());
    image
}

fn assert_good(configuration: &Configuration) {
    let (again, findings) = decode(&encode(configuration)).expect("what was read can be stored");
    assert_eq!((&again, findings), (configuration, Vec::new()));
    // The configuration may differ from any that can be typed: a stored image may keep lines that this
    // version would run.
    craft::assert_flyable(configuration);
}

/// Asserts that a changed byte anywhere, a lost end and a longer end are noticed. A long image is changed at
/// some places only.
fn assert_damage_is_seen(image: &[u8]) {
    let mut damaged = image.to_vec();
    for at in (0..image.len()).step_by(image.len() / 16 + 1) {
        damaged[at] ^= 1 << (at % 8);
        assert!(decode(&damaged).is_err(), "a change at {at} went unnoticed");
        damaged[at] = image[at];
        assert!(decode(&image[..at]).is_err(), "an end at {at} went unnoticed");
    }
    damaged.push(0);
    assert!(decode(&damaged).is_err());
}

/// Computes the CRC-32 of zip and Ethernet. It is a second implementation.
fn checksum_of(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |sum, byte| {
        (0..8).fold(sum ^ u32::from(*byte), |sum, _| (sum >> 1) ^ (0xedb8_8320 & (sum & 1).wrapping_neg()))
    })
}
