//! Little-endian fields of a payload.

use crate::firmware::settings::Width;

/// Reads fields. Bytes beyond the end are zero.
#[derive(Debug, Clone)]
pub(super) struct Reader<'a> {
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    pub(super) fn new(payload: &'a [u8]) -> Self {
        Self { rest: payload }
    }

    /// Returns the number of bytes not read yet.
    pub(super) fn remaining(&self) -> usize {
        self.rest.len()
    }

    fn take<const N: usize>(&mut self) -> [u8; N] {
        let mut bytes = [0; N];
        let available = self.rest.len().min(N);
        let (head, rest) = self.rest.split_at(available);
        bytes[..available].copy_from_slice(head);
        self.rest = rest;
        bytes
    }

    pub(super) fn u8(&mut self) -> u8 {
        u8::from_le_bytes(self.take())
    }

    pub(super) fn u16(&mut self) -> u16 {
        u16::from_le_bytes(self.take())
    }

    pub(super) fn i16(&mut self) -> i16 {
        i16::from_le_bytes(self.take())
    }

    pub(super) fn u32(&mut self) -> u32 {
        u32::from_le_bytes(self.take())
    }

    pub(super) fn i32(&mut self) -> i32 {
        i32::from_le_bytes(self.take())
    }

    /// Reads a number of the given width.
    pub(super) fn number(&mut self, width: Width) -> i64 {
        match width {
            Width::U8 => i64::from(self.u8()),
            Width::I8 => i64::from(i8::from_le_bytes(self.take())),
            Width::U16 => i64::from(self.u16()),
            Width::I16 => i64::from(self.i16()),
            Width::U32 => i64::from(self.u32()),
        }
    }

    /// Returns everything that is left.
    pub(super) fn all(&mut self) -> &'a [u8] {
        std::mem::take(&mut self.rest)
    }

    /// Reads a text after its length, cut at the end of the payload.
    pub(super) fn prefixed(&mut self) -> &'a [u8] {
        let length = usize::from(self.u8()).min(self.rest.len());
        let (text, rest) = self.rest.split_at(length);
        self.rest = rest;
        text
    }
}

/// Writes fields. A number that does not fit becomes the nearest one that does.
#[derive(Debug, Clone, Default)]
pub(super) struct Writer {
    bytes: Vec<u8>,
}

impl Writer {
    pub(super) fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }

    pub(super) fn u8(&mut self, number: impl Into<i64>) {
        self.number(Width::U8, number.into());
    }

    pub(super) fn u16(&mut self, number: impl Into<i64>) {
        self.number(Width::U16, number.into());
    }

    pub(super) fn i16(&mut self, number: impl Into<i64>) {
        self.number(Width::I16, number.into());
    }

    pub(super) fn u32(&mut self, number: impl Into<i64>) {
        self.number(Width::U32, number.into());
    }

    pub(super) fn i32(&mut self, number: impl Into<i64>) {
        let number = number.into().clamp(i64::from(i32::MIN), i64::from(i32::MAX));
        self.bytes.extend((number as i32).to_le_bytes());
    }

    /// Writes a number of the given width.
    pub(super) fn number(&mut self, width: Width, number: i64) {
        let (min, max) = width.bounds();
        let size = match width {
            Width::U8 | Width::I8 => 1,
            Width::U16 | Width::I16 => 2,
            Width::U32 => 4,
        };
        // Two's complement: the low bytes are the same for signed and unsigned.
        self.bytes.extend(&number.clamp(min, max).to_le_bytes()[..size]);
    }

    pub(super) fn zeros(&mut self, count: usize) {
        self.bytes.resize(self.bytes.len() + count, 0);
    }

    pub(super) fn bytes(&mut self, bytes: &[u8]) {
        self.bytes.extend(bytes);
    }

    /// Writes a text after its length, cut at 255 bytes.
    pub(super) fn prefixed(&mut self, text: &str) {
        let text = &text.as_bytes()[..text.len().min(255)];
        self.u8(text.len() as i64);
        self.bytes.extend(text);
    }
}

/// Converts a quantity to wire steps. NaN becomes 0.
pub(super) fn steps(value: f64, steps_per_unit: f64) -> i64 {
    (value * steps_per_unit).round() as i64
}
