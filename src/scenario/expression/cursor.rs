//! The current place in the text of an expression, and the error type of the grammar.

use std::ops::Range;

use crate::text::did_you_mean;

/// A mistake in an expression, and its place in the text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SyntaxError {
    /// The range in bytes of the text.
    pub span: Range<usize>,
    /// The problem, as a part of a sentence.
    pub message: String,
    /// The replacement, for the message; may be empty.
    pub hint: String,
}

/// A place in a text.
#[derive(Debug, Clone)]
pub struct Cursor<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
    terms: usize,
    /// The number of terms read so far, including those of failed attempts.
    reads: usize,
}

/// The deepest nesting of an expression.
const MAX_DEPTH: usize = 40;
/// The most terms of an expression: numbers, flags, states, modes, events with their words, and places. Each sample
/// of a flight costs that many steps, and evaluation goes that deep.
pub const MAX_TERMS: usize = 1000;
/// The most terms that are read for an expression. A parenthesis that turns out to hold a number is read again.
const MAX_READS: usize = MAX_DEPTH * MAX_TERMS;

const TOO_DEEP: &str = "this is nested too deeply";
const TOO_DEEP_HINT: &str = "use a measure for a part of it";

impl<'a> Cursor<'a> {
    /// Creates a cursor at the beginning of a text.
    pub fn new(text: &'a str) -> Self {
        let mut cursor = Self { text, at: 0, depth: 0, terms: 0, reads: 0 };
        cursor.skip_space();
        cursor
    }

    /// Returns the number of bytes read so far, including the space after them.
    pub fn at(&self) -> usize {
        self.at
    }

    /// Returns the text that is not read yet.
    pub fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    /// Returns `true` at the end of the text.
    pub fn is_done(&self) -> bool {
        self.rest().is_empty()
    }

    fn skip_space(&mut self) {
        let rest = self.rest();
        self.at += rest.len() - rest.trim_start().len();
    }

    fn advance(&mut self, bytes: usize) {
        self.at += bytes;
        self.skip_space();
    }

    /// Takes these characters if they come next.
    pub(in crate::scenario) fn take(&mut self, symbol: &str) -> bool {
        let found = self.rest().starts_with(symbol);
        if found {
            self.advance(symbol.len());
        }
        found
    }

    pub(in crate::scenario) fn expect(&mut self, symbol: &str) -> Result<(), SyntaxError> {
        if self.take(symbol) { Ok(()) } else { Err(self.error(format!("{symbol} is expected here"), "")) }
    }

    /// Returns the next word: letters, digits and `_`, beginning with a letter.
    pub fn peek_word(&self) -> Option<&'a str> {
        self.word_of(|c| c.is_alphanumeric() || c == '_')
            .filter(|word| !word.starts_with(|c: char| c.is_ascii_digit()))
    }

    /// Returns the next word of an argument. It may also begin with a digit, and may have `-` inside.
    pub(in crate::scenario) fn peek_argument(&self) -> Option<&'a str> {
        self.word_of(|c| c.is_alphanumeric() || c == '_' || c == '-').filter(|word| !word.starts_with('-'))
    }

    fn word_of(&self, is_part: impl Fn(char) -> bool) -> Option<&'a str> {
        let rest = self.rest();
        let length = rest.find(|c| !is_part(c)).unwrap_or(rest.len());
        (length > 0).then(|| &rest[..length])
    }

    /// Takes a word that was peeked.
    pub(in crate::scenario) fn take_word(&mut self, word: &str) {
        self.advance(word.len());
    }

    /// Takes this word if it comes next.
    pub(in crate::scenario) fn take_keyword(&mut self, keyword: &str) -> bool {
        let found = self.peek_word() == Some(keyword);
        if found {
            self.advance(keyword.len());
        }
        found
    }

    /// Takes a decimal number without a sign.
    pub(in crate::scenario) fn take_decimal(&mut self) -> Option<f64> {
        let rest = self.rest();
        let digits = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
        let whole = digits(rest);
        if whole == 0 {
            return None;
        }
        let mut length = whole;
        // `1..2` is a range.
        if rest[whole..].starts_with('.') && !rest[whole..].starts_with("..") {
            length += 1 + digits(&rest[whole + 1..]);
        }
        let value = rest[..length].parse().ok()?;
        self.advance(length);
        Some(value)
    }

    /// Takes a whole number as an index.
    pub(in crate::scenario) fn take_index(&mut self) -> Option<u8> {
        let rest = self.rest();
        let length = rest.bytes().take_while(u8::is_ascii_digit).count();
        let value = rest[..length].parse().ok()?;
        if rest[length..].starts_with('.') {
            return None;
        }
        self.advance(length);
        Some(value)
    }

    /// Takes a text in single or double quotes.
    pub(in crate::scenario) fn take_quoted(&mut self) -> Result<Option<&'a str>, SyntaxError> {
        let rest = self.rest();
        let Some(quote) = rest.chars().next().filter(|c| matches!(c, '"' | '\'')) else { return Ok(None) };
        let Some(length) = rest[1..].find(quote) else {
            return Err(self.error("the closing quote is missing", ""));
        };
        self.advance(length + 2);
        Ok(Some(&rest[1..=length]))
    }

    /// Takes a comma if it comes next.
    pub fn comma(&mut self) -> bool {
        self.take(",")
    }

    /// Takes `...` if it comes next.
    pub fn ellipsis(&mut self) -> bool {
        self.take("...") || self.take("…")
    }

    /// Takes an arrow.
    ///
    /// # Errors
    /// Returns an error with `hint` if there is no arrow.
    pub fn arrow(&mut self, hint: &str) -> Result<(), SyntaxError> {
        if self.take("->") { Ok(()) } else { Err(self.error("-> is expected here", hint)) }
    }

    /// Returns an error about the next word.
    pub fn error(&self, message: impl Into<String>, hint: impl Into<String>) -> SyntaxError {
        let rest = self.rest();
        let word =
            self.peek_argument().map_or_else(|| rest.chars().next().map_or(0, char::len_utf8), str::len);
        SyntaxError { span: self.at..self.at + word, message: message.into(), hint: hint.into() }
    }

    /// Returns an error about the text read since `start`.
    pub fn error_since(
        &self,
        start: usize,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) -> SyntaxError {
        let end = start + self.text[start..self.at].trim_end().len();
        SyntaxError { span: start..end, message: message.into(), hint: hint.into() }
    }

    /// Returns an error that the next word is not one of `words`.
    pub(in crate::scenario) fn unknown<'w>(
        &self,
        what: &str,
        words: impl Iterator<Item = &'w str>,
    ) -> SyntaxError {
        let rest = self.rest();
        let symbol = &rest[..rest.chars().next().map_or(0, char::len_utf8)];
        let found = self.peek_argument().unwrap_or(symbol);
        let shown = if found.is_empty() { "the end".to_owned() } else { found.to_owned() };
        self.error(format!("{shown} is not {what}"), did_you_mean::hint(found, words))
    }

    /// Checks that the text is read to its end.
    ///
    /// # Errors
    /// Returns an error about the unread rest.
    pub fn finish(&self) -> Result<(), SyntaxError> {
        if self.is_done() {
            Ok(())
        } else {
            Err(self.error(format!("{} is not understood here", self.rest()), ""))
        }
    }

    /// Counts a term that begins here.
    ///
    /// # Errors
    /// Returns an error if the expression has too many terms.
    pub fn term(&mut self) -> Result<(), SyntaxError> {
        self.count(1)
    }

    pub(in crate::scenario) fn terms(&self) -> usize {
        self.terms
    }

    /// Returns the number of terms read so far, including those of failed attempts.
    pub fn reads(&self) -> usize {
        self.reads
    }

    /// Counts the terms since `before` a second time, because their values are computed twice.
    pub(in crate::scenario) fn count_twice(&mut self, before: usize) -> Result<(), SyntaxError> {
        self.count(self.terms - before)
    }

    /// Copies the count of terms from a failed attempt, so that reading can continue here in another way.
    pub(in crate::scenario) fn note_attempt(&mut self, attempt: &Self) {
        self.reads = attempt.reads;
    }

    fn count(&mut self, terms: usize) -> Result<(), SyntaxError> {
        self.terms += terms;
        self.reads += terms;
        if self.terms > MAX_TERMS {
            let hint = format!("allowed: {MAX_TERMS} terms; use measures for parts of it");
            Err(self.error("this expression has too many terms", hint))
        } else if self.reads > MAX_READS {
            Err(self.error(TOO_DEEP, TOO_DEEP_HINT))
        } else {
            Ok(())
        }
    }

    pub(in crate::scenario) fn nested<T>(
        &mut self,
        read: impl FnOnce(&mut Self) -> Result<T, SyntaxError>,
    ) -> Result<T, SyntaxError> {
        if self.depth >= MAX_DEPTH {
            return Err(self.error(TOO_DEEP, TOO_DEEP_HINT));
        }
        self.depth += 1;
        let result = read(self);
        self.depth -= 1;
        result
    }
}
