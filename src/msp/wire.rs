//! Little-endian fields of a payload.

/// Reads fields from the beginning. Reading past the end gives `None`.
#[derive(Debug, Clone, Copy)]
pub struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    pub fn new(payload: &'a [u8]) -> Self {
        Self(payload)
    }

    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (taken, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*taken)
    }

    pub fn u8(&mut self) -> Option<u8> {
        self.take().map(u8::from_le_bytes)
    }

    pub fn u16(&mut self) -> Option<u16> {
        self.take().map(u16::from_le_bytes)
    }

    pub fn i16(&mut self) -> Option<i16> {
        self.take().map(i16::from_le_bytes)
    }

    pub fn u32(&mut self) -> Option<u32> {
        self.take().map(u32::from_le_bytes)
    }

    pub fn i32(&mut self) -> Option<i32> {
        self.take().map(i32::from_le_bytes)
    }

    /// Reads the next `count` bytes.
    pub fn bytes(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(taken)
    }

    /// Reads a text of `count` bytes.
    pub fn text(&mut self, count: usize) -> Option<String> {
        self.bytes(count).map(text)
    }

    /// Reads a text that follows its length.
    pub fn prefixed_text(&mut self) -> Option<String> {
        let count = self.u8()?;
        self.text(usize::from(count))
    }
}

/// Returns the printable characters of a text, without surrounding blanks.
pub(super) fn text(bytes: &[u8]) -> String {
    let letters: String =
        bytes.iter().filter(|byte| matches!(byte, b' '..=b'~')).map(|byte| char::from(*byte)).collect();
    letters.trim().to_owned()
}

/// Reads fields as a server does: bytes beyond the end are zero.
#[derive(Debug, Clone)]
pub struct PaddedReader<'a>(Reader<'a>);

impl<'a> PaddedReader<'a> {
    pub fn new(payload: &'a [u8]) -> Self {
        Self(Reader::new(payload))
    }

    /// Returns the number of bytes not read yet.
    pub fn remaining(&self) -> usize {
        self.0.0.len()
    }

    fn take<const N: usize>(&mut self) -> [u8; N] {
        let mut bytes = [0; N];
        let (head, rest) = self.0.0.split_at(self.remaining().min(N));
        bytes[..head.len()].copy_from_slice(head);
        self.0 = Reader(rest);
        bytes
    }

    pub fn u8(&mut self) -> u8 {
        u8::from_le_bytes(self.take())
    }

    pub fn i8(&mut self) -> i8 {
        i8::from_le_bytes(self.take())
    }

    pub fn u16(&mut self) -> u16 {
        u16::from_le_bytes(self.take())
    }

    pub fn i16(&mut self) -> i16 {
        i16::from_le_bytes(self.take())
    }

    pub fn u32(&mut self) -> u32 {
        u32::from_le_bytes(self.take())
    }

    pub fn i32(&mut self) -> i32 {
        i32::from_le_bytes(self.take())
    }

    /// Returns everything that is left.
    pub fn all(&mut self) -> &'a [u8] {
        std::mem::take(&mut self.0.0)
    }

    /// Reads a text after its length, cut at the end of the payload.
    pub fn prefixed(&mut self) -> &'a [u8] {
        let length = usize::from(self.u8()).min(self.remaining());
        self.0.bytes(length).unwrap_or_default()
    }
}

/// Writes fields. A number that does not fit becomes the nearest one that does.
#[derive(Debug, Clone, Default)]
pub struct Writer {
    bytes: Vec<u8>,
}

impl Writer {
    pub fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }

    /// Writes the low bytes of a number, which are the same for signed and unsigned.
    fn limited<const N: usize>(&mut self, number: i64, min: i64, max: i64) {
        self.bytes.extend(&number.clamp(min, max).to_le_bytes()[..N]);
    }

    pub fn u8(&mut self, number: impl Into<i64>) {
        self.limited::<1>(number.into(), 0, u8::MAX.into());
    }

    pub fn i8(&mut self, number: impl Into<i64>) {
        self.limited::<1>(number.into(), i8::MIN.into(), i8::MAX.into());
    }

    pub fn u16(&mut self, number: impl Into<i64>) {
        self.limited::<2>(number.into(), 0, u16::MAX.into());
    }

    pub fn i16(&mut self, number: impl Into<i64>) {
        self.limited::<2>(number.into(), i16::MIN.into(), i16::MAX.into());
    }

    pub fn u32(&mut self, number: impl Into<i64>) {
        self.limited::<4>(number.into(), 0, u32::MAX.into());
    }

    pub fn i32(&mut self, number: impl Into<i64>) {
        self.limited::<4>(number.into(), i32::MIN.into(), i32::MAX.into());
    }

    pub fn zeros(&mut self, count: usize) {
        self.bytes.resize(self.bytes.len() + count, 0);
    }

    pub fn bytes(&mut self, bytes: &[u8]) {
        self.bytes.extend(bytes);
    }

    /// Writes a text after its length, cut at 255 bytes.
    pub fn prefixed(&mut self, text: &str) {
        let text = &text.as_bytes()[..text.len().min(255)];
        self.u8(text.len() as i64);
        self.bytes.extend(text);
    }

    /// Writes a text in a field of `size` bytes, cut or filled with blanks.
    pub fn padded(&mut self, text: &str, size: usize) {
        let letters = text.bytes().chain(std::iter::repeat(b' '));
        self.bytes.extend(letters.take(size));
    }
}

/// Converts a quantity to wire steps. NaN becomes 0.
pub fn steps(value: f64, steps_per_unit: f64) -> i64 {
    (value * steps_per_unit).round() as i64
}
