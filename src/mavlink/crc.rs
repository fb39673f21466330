//! The checksum of MAVLink: CRC-16/MCRF4XX, which the definition of MAVLink calls X.25.

/// The checksum of no bytes.
pub(super) const START: u16 = 0xffff;

/// Returns the checksum after one more byte.
pub(super) const fn with_byte(crc: u16, byte: u8) -> u16 {
    let low = byte ^ crc as u8;
    let low = (low ^ (low << 4)) as u16;
    (crc >> 8) ^ (low << 8) ^ (low << 3) ^ (low >> 4)
}

/// Returns the checksum after more bytes.
pub(super) const fn with_bytes(mut crc: u16, bytes: &[u8]) -> u16 {
    let mut at = 0;
    while at < bytes.len() {
        crc = with_byte(crc, bytes[at]);
        at += 1;
    }
    crc
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_check_value_of_the_crc_catalogue_is_met() {
        assert_eq!(with_bytes(START, b"123456789"), 0x6f91);
    }
}
