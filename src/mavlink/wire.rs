//! The fields of a payload: little-endian numbers, arrays and texts.

use std::fmt;

/// The greatest length of a payload, bytes.
pub const MAX_PAYLOAD: usize = 255;

/// A type that a message field can have.
pub(super) trait Field: Sized {
    /// Bytes on the wire.
    const SIZE: usize;
    /// The name of the type, or that of its elements, in message definitions.
    const TYPE: &'static str;
    /// The number of elements; 0 for a single number.
    const ELEMENTS: u8;
    /// The number of fields with numbered names that the value stands for; 0 for one field.
    const FIELDS: u8 = 0;
    /// The value of a field that was not sent.
    const ZERO: Self;

    /// Reads a value. Bytes beyond the end count as 0.
    fn read(reader: &mut Reader<'_>) -> Self;

    /// Appends a value.
    fn write(&self, out: &mut Vec<u8>);
}

/// Reads fields from the beginning. Bytes beyond the end count as 0, because version 2 cuts zeros there.
#[derive(Debug)]
pub(super) struct Reader<'a>(pub(super) &'a [u8]);

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> [u8; N] {
        let mut taken = [0; N];
        let (head, rest) = self.0.split_at(self.0.len().min(N));
        taken[..head.len()].copy_from_slice(head);
        self.0 = rest;
        taken
    }
}

macro_rules! numbers {
    ($($number:ty, $name:literal, $zero:literal;)*) => {
        $(impl Field for $number {
            const SIZE: usize = size_of::<Self>();
            const TYPE: &'static str = $name;
            const ELEMENTS: u8 = 0;
            const ZERO: Self = $zero;

            fn read(reader: &mut Reader<'_>) -> Self {
                Self::from_le_bytes(reader.take())
            }

            fn write(&self, out: &mut Vec<u8>) {
                out.extend(self.to_le_bytes());
            }
        })*
    };
}

numbers! {
    u8, "uint8_t", 0;
    i8, "int8_t", 0;
    u16, "uint16_t", 0;
    i16, "int16_t", 0;
    u32, "uint32_t", 0;
    i32, "int32_t", 0;
    u64, "uint64_t", 0;
    i64, "int64_t", 0;
    f32, "float", 0.0;
}

impl<T: Field + Copy, const N: usize> Field for [T; N] {
    const SIZE: usize = N * T::SIZE;
    const TYPE: &'static str = T::TYPE;
    const ELEMENTS: u8 = N as u8;
    const ZERO: Self = [T::ZERO; N];

    fn read(reader: &mut Reader<'_>) -> Self {
        std::array::from_fn(|_| T::read(reader))
    }

    fn write(&self, out: &mut Vec<u8>) {
        self.iter().for_each(|element| element.write(out));
    }
}

/// The values of fields whose names differ by a number only, from 1: `chan1_raw`, `chan2_raw` … for the name `chan_raw`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Series<const N: usize>(pub [u16; N]);

impl<const N: usize> Field for Series<N> {
    const SIZE: usize = <[u16; N]>::SIZE;
    const TYPE: &'static str = u16::TYPE;
    const ELEMENTS: u8 = 0;
    const FIELDS: u8 = N as u8;
    const ZERO: Self = Self([0; N]);

    fn read(reader: &mut Reader<'_>) -> Self {
        Self(Field::read(reader))
    }

    fn write(&self, out: &mut Vec<u8>) {
        self.0.write(out);
    }
}

/// A text of at most `N` bytes. A shorter one ends with a zero byte.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Text<const N: usize>([u8; N]);

impl<const N: usize> Text<N> {
    /// Returns a text, cut after its last character that fits.
    pub fn new(text: &str) -> Self {
        Self::from_bytes(&text.as_bytes()[..text.floor_char_boundary(N)])
    }

    /// Returns a text of the first `N` bytes.
    pub fn from_bytes(text: &[u8]) -> Self {
        let mut bytes = [0; N];
        let length = text.len().min(N);
        bytes[..length].copy_from_slice(&text[..length]);
        Self(bytes)
    }

    /// Returns the bytes before the first zero byte.
    pub fn as_bytes(&self) -> &[u8] {
        let end = self.0.iter().position(|byte| *byte == 0).unwrap_or(N);
        &self.0[..end]
    }

    /// Returns `true` if the text has no bytes.
    pub fn is_empty(&self) -> bool {
        self.as_bytes().is_empty()
    }
}

impl<const N: usize> fmt::Display for Text<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&printable(self.as_bytes()))
    }
}

impl<const N: usize> fmt::Debug for Text<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.to_string())
    }
}

impl<const N: usize> Field for Text<N> {
    const SIZE: usize = N;
    const TYPE: &'static str = "char";
    const ELEMENTS: u8 = N as u8;
    const ZERO: Self = Self([0; N]);

    fn read(reader: &mut Reader<'_>) -> Self {
        Self(reader.take())
    }

    fn write(&self, out: &mut Vec<u8>) {
        out.extend(self.0);
    }
}

/// Returns bytes as a text that is safe to show: invalid UTF-8 is replaced, and control characters become blanks.
pub(super) fn printable(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes);
    text.chars().map(|letter| if letter.is_control() { ' ' } else { letter }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_cut_between_characters() {
        assert_eq!(Text::<4>::new("abcü").to_string(), "abc");
        assert_eq!(Text::<5>::new("abcü").to_string(), "abcü");
        assert_eq!(Text::<5>::new("ab").as_bytes(), b"ab");
    }

    #[test]
    fn a_text_from_outside_cannot_control_a_terminal() {
        assert_eq!(Text::<8>::from_bytes(b"a\x1b[2Jb\xff").to_string(), "a [2Jb\u{fffd}");
    }

    #[test]
    fn bytes_beyond_the_end_are_zero() {
        let mut reader = Reader(&[1, 2, 3]);
        assert_eq!(<[u16; 3]>::read(&mut reader), [0x0201, 3, 0]);
        assert_eq!(u64::read(&mut reader), 0);
    }
}
