//! A JSON text and its problems, with places by JSON pointers.

use serde_json::Value;

use super::super::{Problems, json_place};

/// A text whose values are read.
pub(super) struct Source<'s, 'p> {
    text: &'s str,
    problems: &'s mut Problems<'p>,
}

impl<'s, 'p> Source<'s, 'p> {
    pub(super) fn new(text: &'s str, problems: &'s mut Problems<'p>) -> Self {
        Self { text, problems }
    }

    /// Adds a problem at the value of a pointer.
    pub(super) fn fault(&mut self, pointer: &str, message: impl Into<String>, hint: impl Into<String>) {
        // A problem that is only counted needs no place.
        let span = if self.problems.is_full() { 0..0 } else { json_place::span(self.text, pointer) };
        self.problems.add(span, message, hint);
    }

    pub(super) fn is_clean(&self) -> bool {
        self.problems.is_empty()
    }

    /// Returns `true` if further problems are only counted.
    pub(super) fn is_full(&self) -> bool {
        self.problems.is_full()
    }

    /// Reads a number; null and a missing value give `None`.
    pub(super) fn number(&mut self, value: &Value, pointer: &str, what: &str) -> Option<f64> {
        if value.is_null() {
            return None;
        }
        let number = value.as_f64();
        if number.is_none() {
            let hint = match value.as_str() {
                Some(text) if text.contains(',') => "write numbers with a decimal point, not a decimal comma",
                _ => "write a number",
            };
            self.fault(pointer, format!("{what} is not a number"), hint);
        }
        number
    }

    /// Reads a number from 0 to 65535.
    pub(super) fn whole(&mut self, value: &Value, pointer: &str, what: &str) -> Option<u16> {
        let number = self.number(value, pointer, what)?;
        if number.fract() != 0.0 || !(0.0..=65535.0).contains(&number) {
            self.fault(pointer, format!("{what} {number} is out of range"), "allowed: 0 to 65535");
            return None;
        }
        Some(number as u16)
    }
}
