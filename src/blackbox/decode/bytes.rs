//! Numbers from the bytes of a frame.

/// The reason for which no number can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stop {
    /// The input ends inside the number.
    Short,
    /// No writer makes such bytes.
    Wrong,
}

/// The most leading zeros of an Elias delta code: the length of a 32-bit number has at most six bits.
const MAX_LENGTH_BITS: u32 = 5;

/// The part of a frame that is not read yet.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bytes<'a> {
    rest: &'a [u8],
    /// The last byte of a bit code, and the number of its low bits that are not read yet.
    bits: (u8, u32),
}

impl<'a> Bytes<'a> {
    pub(super) fn new(rest: &'a [u8]) -> Self {
        Self { rest, bits: (0, 0) }
    }

    /// Returns the number of bytes that are not read yet.
    pub(super) fn remaining(&self) -> usize {
        self.rest.len()
    }

    pub(super) fn byte(&mut self) -> Result<u8, Stop> {
        let (first, rest) = self.rest.split_first().ok_or(Stop::Short)?;
        self.rest = rest;
        Ok(*first)
    }

    /// Reads bytes, the first one lowest.
    pub(super) fn little_endian(&mut self, count: usize) -> Result<u32, Stop> {
        let mut value = 0;
        for at in 0..count {
            value |= u32::from(self.byte()?) << (8 * at);
        }
        Ok(value)
    }

    /// Skips `expected`. Fails if other bytes are here.
    pub(super) fn literal(&mut self, expected: &[u8]) -> Result<(), Stop> {
        let common = self.rest.len().min(expected.len());
        if self.rest[..common] != expected[..common] {
            return Err(Stop::Wrong);
        }
        self.rest = self.rest.get(expected.len()..).ok_or(Stop::Short)?;
        Ok(())
    }

    pub(super) fn unsigned_vb(&mut self) -> Result<u32, Stop> {
        let mut value = 0;
        for shift in [0, 7, 14, 21, 28] {
            let byte = self.byte()?;
            value |= u32::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Ok(value);
            }
        }
        Err(Stop::Wrong)
    }

    pub(super) fn signed_vb(&mut self) -> Result<i32, Stop> {
        self.unsigned_vb().map(from_zigzag)
    }

    pub(super) fn neg_14_bit(&mut self) -> Result<i32, Stop> {
        Ok(-sign_extended(self.unsigned_vb()?, 14))
    }

    /// Starts a bit code at the next whole byte.
    pub(super) fn align(&mut self) {
        self.bits.1 = 0;
    }

    fn bit(&mut self) -> Result<u32, Stop> {
        if self.bits.1 == 0 {
            self.bits = (self.byte()?, 8);
        }
        self.bits.1 -= 1;
        Ok(u32::from(self.bits.0) >> self.bits.1 & 1)
    }

    fn bits(&mut self, count: u32) -> Result<u32, Stop> {
        let mut value = 0;
        for _ in 0..count {
            value = value << 1 | self.bit()?;
        }
        Ok(value)
    }

    /// Reads an Elias delta code of a number plus one. The two greatest numbers share a code; a bit tells them apart.
    pub(super) fn elias_delta(&mut self) -> Result<u32, Stop> {
        let mut length_bits = 0;
        while self.bit()? == 0 {
            length_bits += 1;
            if length_bits > MAX_LENGTH_BITS {
                return Err(Stop::Wrong);
            }
        }
        let length = (1 << length_bits | self.bits(length_bits)?) - 1;
        if length > 31 {
            return Err(Stop::Wrong);
        }
        let above = 1 << length | self.bits(length)?;
        if above == u32::MAX { Ok(above - 1 + self.bit()?) } else { Ok(above - 1) }
    }
}

/// Returns the number of which this is the zigzag code: 0, −1, 1, −2 …
pub(super) fn from_zigzag(code: u32) -> i32 {
    (code >> 1) as i32 ^ -((code & 1) as i32)
}

/// Returns the number in the lowest `bits` bits in two's complement.
pub(super) fn sign_extended(value: u32, bits: u32) -> i32 {
    let unused = 32 - bits;
    (value << unused) as i32 >> unused
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn worked_numbers() {
        assert_eq!(Bytes::new(&[0xac, 0x02]).unsigned_vb(), Ok(300));
        assert_eq!(Bytes::new(&[0x05]).signed_vb(), Ok(-3));
        assert_eq!(Bytes::new(&[0x14]).neg_14_bit(), Ok(-20));
        assert_eq!(Bytes::new(&[0xff, 0xff, 0xff, 0xff, 0x0f]).unsigned_vb(), Ok(u32::MAX));
        assert_eq!(Bytes::new(&[0xff, 0xff, 0xff, 0xff, 0x0f]).signed_vb(), Ok(i32::MIN));
    }

    #[test]
    fn a_number_that_goes_on_is_short_or_wrong() {
        assert_eq!(Bytes::new(&[0x80, 0x80]).unsigned_vb(), Err(Stop::Short));
        assert_eq!(Bytes::new(&[0x80; 6]).unsigned_vb(), Err(Stop::Wrong));
        assert_eq!(Bytes::new(b"End o").literal(b"End of"), Err(Stop::Short));
        assert_eq!(Bytes::new(b"Enx").literal(b"End of"), Err(Stop::Wrong));
    }

    #[test]
    fn elias_delta_codes_follow_each_other_bit_by_bit() {
        // 0 is "1", 1 is "0100", 2 is "0101", 4 is "01101".
        let mut bytes = Bytes::new(&[0b1010_0010, 0b1011_0100, 0xff]);
        let read: Vec<_> = (0..4).map(|_| bytes.elias_delta()).collect();
        assert_eq!(read, [Ok(0), Ok(1), Ok(2), Ok(4)]);
        bytes.align();
        assert_eq!(bytes.elias_delta(), Ok(0));
        assert_eq!(bytes.remaining(), 0);
        assert_eq!(Bytes::new(&[0; 9]).elias_delta(), Err(Stop::Wrong));
    }

    #[test]
    fn the_two_greatest_numbers_share_an_elias_delta_code() {
        // The length 32 is 00000 100000 in Elias gamma code; 31 bits and the one that tells them apart follow.
        let greatest = [0b0000_0100, 0b0001_1111, 0xff, 0xff, 0xff, 0b1100_0000];
        assert_eq!(Bytes::new(&greatest).elias_delta(), Ok(u32::MAX - 1));
        let mut one_more = greatest;
        one_more[5] |= 0b10_0000;
        assert_eq!(Bytes::new(&one_more).elias_delta(), Ok(u32::MAX));
    }
}
