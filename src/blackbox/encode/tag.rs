//! Encodings of several values at once, behind a byte that says how many bits each has.

use super::LogWriter;

/// The most values behind one byte of flags.
const FLAGGED: usize = 8;

impl LogWriter<'_> {
    /// Writes any number of values: for each eight a byte of flags, then each value that is not zero. A value without
    /// companions has no flags.
    pub fn tag8_8svb(&mut self, values: &[i32]) {
        for group in values.chunks(FLAGGED) {
            if let &[value] = group {
                self.signed_vb(value);
                continue;
            }
            let mut flags = 0;
            for (bit, value) in group.iter().enumerate() {
                flags |= u8::from(*value != 0) << bit;
            }
            self.byte(flags);
            group.iter().filter(|value| **value != 0).for_each(|value| self.signed_vb(*value));
        }
    }

    /// Writes three values of 2, 4 or 6 bits each, or of whole bytes.
    pub fn tag2_3s32(&mut self, values: [i32; 3]) {
        let low = |value: i32, bits: u32| value as u8 & ((1 << bits) - 1);
        let [a, b, c] = values;
        match values.map(bits_of).into_iter().fold(0, u32::max) {
            0..=2 => self.byte(low(a, 2) << 4 | low(b, 2) << 2 | low(c, 2)),
            3..=4 => self.all(&[1 << 6 | low(a, 4), low(b, 4) << 4 | low(c, 4)]),
            5..=6 => self.all(&[2 << 6 | low(a, 6), low(b, 6), low(c, 6)]),
            _ => {
                let lengths = values.map(|value| bits_of(value).div_ceil(8));
                let [first, second, third] = lengths.map(|length| length as u8 - 1);
                self.byte(3 << 6 | third << 4 | second << 2 | first);
                for (value, length) in values.iter().zip(lengths) {
                    self.first(value.to_le_bytes(), length as usize);
                }
            }
        }
    }

    /// Writes four values of 0, 4, 8 or 16 bits. Values beyond 16 bits lose their upper bits.
    pub fn tag8_4s16(&mut self, values: [i32; 4]) {
        let nibbles = values.map(|value| match value {
            0 => 0,
            -8..=7 => 1,
            -128..=127 => 2,
            _ => 4,
        });
        let code = |nibbles: u32| nibbles.min(3) as u8;
        let [a, b, c, d] = nibbles.map(code);
        self.byte(d << 6 | c << 4 | b << 2 | a);
        let (mut bits, mut count) = (0_u64, 0);
        for (value, nibbles) in values.iter().zip(nibbles) {
            let mask = (1_u64 << (4 * nibbles)) - 1;
            bits = bits << (4 * nibbles) | (value.cast_unsigned() as u64 & mask);
            count += nibbles;
        }
        // The last byte is filled up with a nibble of zeros.
        let bytes = count.div_ceil(2);
        bits <<= 4 * (2 * bytes - count);
        self.first(bits.checked_shl(64 - 8 * bytes).unwrap_or_default().to_be_bytes(), bytes as usize);
    }
}

/// Returns the least number of bits in two's complement that hold the value.
fn bits_of(value: i32) -> u32 {
    33 - (value ^ value >> 31).leading_zeros()
}

#[cfg(test)]
mod tests;
