//! The bytes of a log on their way out: a fixed number, and the encodings of one value.

use std::fmt;

/// The most bytes that a buffer holds.
pub const CAPACITY: usize = 4096;

/// Bytes of a log. What does not fit is dropped.
#[derive(Clone)]
pub struct LogBuffer {
    bytes: [u8; CAPACITY],
    len: usize,
}

impl Default for LogBuffer {
    fn default() -> Self {
        Self { bytes: [0; CAPACITY], len: 0 }
    }
}

impl LogBuffer {
    /// Returns the bytes in their order.
    pub fn bytes(&self) -> &[u8] {
        self.bytes.get(..self.len).unwrap_or_default()
    }

    /// Removes all bytes.
    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// Writes at the end.
    pub fn write<T>(&mut self, write: impl FnOnce(&mut LogWriter<'_>) -> T) -> T {
        // The position is a variable of its own, which stays in a register.
        let mut writer = LogWriter { bytes: &mut self.bytes, at: self.len };
        let done = write(&mut writer);
        self.len = writer.at;
        done
    }
}

impl fmt::Debug for LogBuffer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("LogBuffer").field(&self.bytes()).finish()
    }
}

impl fmt::Write for LogBuffer {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.write(|writer| writer.all(text.as_bytes()));
        Ok(())
    }
}

/// The end of a [`LogBuffer`], where bytes are added.
#[derive(Debug)]
pub struct LogWriter<'a> {
    bytes: &'a mut [u8; CAPACITY],
    at: usize,
}

impl LogWriter<'_> {
    /// Writes a byte as it is.
    #[inline]
    pub fn byte(&mut self, byte: u8) {
        if let Some(free) = self.bytes.get_mut(self.at) {
            *free = byte;
            self.at += 1;
        }
    }

    /// Writes bytes as they are.
    #[inline]
    pub fn all(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.byte(*byte));
    }

    /// Writes the first `count` of the bytes.
    #[inline]
    pub(super) fn first<const N: usize>(&mut self, bytes: [u8; N], count: usize) {
        // A copy of a known length is faster than a loop.
        match self.bytes.get_mut(self.at..).and_then(|free| free.first_chunk_mut()) {
            Some(free) => {
                *free = bytes;
                self.at += count.min(N);
            }
            None => self.all(bytes.get(..count).unwrap_or_default()),
        }
    }

    /// Writes a number with seven bits a byte, the lowest first.
    #[inline]
    pub fn unsigned_vb(&mut self, value: u32) {
        if value <= 0x7f {
            return self.byte(value as u8);
        }
        let v = u64::from(value);
        let spread = v & 0x7f
            | (v & 0x3f80) << 1
            | (v & 0x1f_c000) << 2
            | (v & 0xfe0_0000) << 3
            | (v & 0xf000_0000) << 4;
        let count = (38 - value.leading_zeros()) / 7;
        let more = 0x80_8080_8080 & ((1_u64 << (8 * (count - 1))) - 1);
        self.first((spread | more).to_le_bytes(), count as usize);
    }

    /// Writes numbers as [`Self::signed_vb`] does.
    #[inline]
    pub fn all_signed_vb(&mut self, values: &[i32]) {
        let (groups, rest) = values.as_chunks::<4>();
        for group in groups {
            let codes = group.map(zigzag);
            let [a, b, c, d] = codes;
            if (a | b | c | d) <= 0x7f {
                self.first(codes.map(|code| code as u8), 4);
            } else {
                codes.into_iter().for_each(|code| self.unsigned_vb(code));
            }
        }
        rest.iter().for_each(|value| self.signed_vb(*value));
    }

    /// Writes a number by its zigzag code, which is small for small numbers of both signs.
    #[inline]
    pub fn signed_vb(&mut self, value: i32) {
        self.unsigned_vb(zigzag(value));
    }

    /// Writes the lowest 14 bits of the negated number.
    #[inline]
    pub fn neg_14bit(&mut self, value: i32) {
        self.unsigned_vb(value.wrapping_neg().cast_unsigned() & 0x3fff);
    }
}

/// Returns a code that is small for small numbers of both signs.
fn zigzag(value: i32) -> u32 {
    (value << 1 ^ value >> 31).cast_unsigned()
}

/// Returns the written bytes.
#[cfg(test)]
pub(super) fn written(write: impl FnOnce(&mut LogWriter<'_>)) -> Vec<u8> {
    let mut buffer = LogBuffer::default();
    buffer.write(write);
    buffer.bytes().to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn worked_numbers_have_their_bytes() {
        assert_eq!(written(|log| log.unsigned_vb(300)), [0xac, 0x02]);
        assert_eq!(written(|log| log.signed_vb(-3)), [0x05]);
        assert_eq!(written(|log| log.neg_14bit(1600 - 1620)), [0x14]);
    }

    #[test]
    fn extreme_numbers_have_five_bytes() {
        assert_eq!(written(|log| log.unsigned_vb(u32::MAX)), [0xff, 0xff, 0xff, 0xff, 0x0f]);
        assert_eq!(written(|log| log.signed_vb(i32::MIN)), [0xff, 0xff, 0xff, 0xff, 0x0f]);
        assert_eq!(written(|log| log.signed_vb(i32::MAX)), [0xfe, 0xff, 0xff, 0xff, 0x0f]);
        assert_eq!(written(|log| log.unsigned_vb(0)), [0]);
    }

    #[test]
    fn a_full_buffer_takes_no_more() {
        let bytes = written(|log| {
            for _ in 0..CAPACITY + 3 {
                log.byte(7);
            }
            log.all(b"more");
        });
        assert_eq!(bytes, [7; CAPACITY]);
    }
}
