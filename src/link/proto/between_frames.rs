//! The bytes between MSP frames when the command line is closed. Text is ignored, as a flight controller
//! ignores it. Anything else shows that the other side is no serial client.
//!
//! A `#` or STX opens the command line only at the beginning of a line, so that one in the middle of other
//! bytes does not.

use std::time::Duration;

/// Ignored lines that follow each other faster than this count as one paste.
const PASTE_GAP: Duration = Duration::from_secs(1);
/// The maximum number of characters of a line's first word. A longer word is no command.
const WORD_MAX: usize = 24;

/// A byte that belongs neither to MSP nor to text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct NotText;

/// The bytes since the last frame or command line.
#[derive(Debug, Clone, Default)]
pub(super) struct BetweenFrames {
    /// The first word of the line as received so far.
    word: arrayvec::ArrayString<WORD_MAX>,
    word_is_over: bool,
    /// `true` once this line has something other than blanks.
    line_has_begun: bool,
    /// The number of bytes that a UTF-8 character still needs.
    continuation: u8,
    /// The remaining bytes of a frame that was too long to be accepted.
    frame_rest: usize,
    /// The time at which the last ignored line ended.
    ignored_at: Option<Duration>,
}

impl BetweenFrames {
    /// Returns `true` at the beginning of a line, at which `#` and STX may open the command line.
    pub(super) fn is_at_line_start(&self) -> bool {
        !self.line_has_begun && self.continuation == 0 && self.frame_rest == 0
    }

    /// Begins a line after a frame or a command line has ended.
    pub(super) fn begin_line(&mut self) {
        *self = Self { ignored_at: self.ignored_at, ..Self::default() };
    }

    /// Expects the rest of an abandoned frame, at most this many bytes.
    pub(super) fn expect_frame_rest(&mut self, bytes: usize) {
        self.begin_line();
        self.line_has_begun = true;
        self.frame_rest = bytes;
    }

    /// Treats the following bytes as the middle of a line.
    pub(super) fn begin_inside_line(&mut self) {
        self.line_has_begun = true;
        self.word_is_over = true;
    }

    /// Takes a byte. Returns the first word of a line that ends with it, once per paste of several lines.
    pub(super) fn take(&mut self, byte: u8, now: Duration) -> Result<Option<String>, NotText> {
        if self.frame_rest > 0 {
            self.frame_rest -= 1;
            return Ok(None);
        }
        if self.continuation > 0 {
            self.continuation -= 1;
            return if matches!(byte, 0x80..=0xbf) { Ok(None) } else { Err(NotText) };
        }
        match byte {
            b'\r' | b'\n' => return Ok(self.end_line(now)),
            b' ' | b'\t' => self.word_is_over |= self.line_has_begun,
            b'#' => self.begin_inside_line(),
            b'!'..=b'~' => {
                self.line_has_begun = true;
                if !self.word_is_over && self.word.try_push(char::from(byte)).is_err() {
                    self.word.clear();
                    self.word_is_over = true;
                }
            }
            // The begin and the end of a batch of lines.
            0x02 | 0x03 => {}
            // Keys of a terminal.
            0x04 | 0x08 | 0x0c | 0x1b | 0x7f => self.begin_inside_line(),
            0xc2..=0xdf => self.continue_for(1),
            0xe0..=0xef => self.continue_for(2),
            0xf0..=0xf4 => self.continue_for(3),
            _ => return Err(NotText),
        }
        Ok(None)
    }

    fn continue_for(&mut self, bytes: u8) {
        self.begin_inside_line();
        self.continuation = bytes;
    }

    fn end_line(&mut self, now: Duration) -> Option<String> {
        let word = std::mem::take(&mut self.word);
        self.begin_line();
        if word.is_empty() {
            return None;
        }
        let last = self.ignored_at.replace(now);
        let goes_on = last.is_some_and(|last| now.saturating_sub(last) < PASTE_GAP);
        (!goes_on).then(|| word.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(between: &mut BetweenFrames, text: &str, at_ms: u64) -> Vec<String> {
        let now = Duration::from_millis(at_ms);
        text.bytes().filter_map(|byte| between.take(byte, now).unwrap()).collect()
    }

    #[test]
    fn a_paste_is_reported_once_however_many_lines_it_has() {
        let mut between = BetweenFrames::default();
        assert_eq!(
            words(&mut between, "\r\n waypoint reset\r\nwaypoint insert 0 1 2\r\n", 100),
            ["waypoint"]
        );
        assert!(words(&mut between, "waypoint insert 1 1 2\n", 1000).is_empty());
        assert!(words(&mut between, "# a note\n\n", 5000).is_empty());
        assert_eq!(words(&mut between, "save\n", 5000), ["save"]);
    }

    #[test]
    fn bytes_that_are_no_text_are_refused_wherever_they_stand() {
        for bytes in [b"\0".as_slice(), b"ab\x01", b"\xff", b"\xc3(", b"\x80", b"\x15", b"\xe2\x82\n"] {
            let mut between = BetweenFrames::default();
            let (last, before) = bytes.split_last().unwrap();
            for byte in before {
                assert_eq!(between.take(*byte, Duration::ZERO), Ok(None), "{}", bytes.escape_ascii());
            }
            assert_eq!(between.take(*last, Duration::ZERO), Err(NotText), "{}", bytes.escape_ascii());
        }
    }

    #[test]
    fn a_line_begins_after_its_end_after_a_frame_and_nowhere_else() {
        let mut between = BetweenFrames::default();
        for (text, starts) in [
            ("", true),
            (" \t", true),
            ("x", false),
            (" ", false),
            ("\n", true),
            ("ö", false),
            ("\n", true),
            ("\x04", false),
        ] {
            words(&mut between, text, 0);
            assert_eq!(between.is_at_line_start(), starts, "{text:?}");
        }
        between.begin_line();
        assert!(between.is_at_line_start());
        between.expect_frame_rest(2);
        assert_eq!(
            (between.take(0, Duration::ZERO), between.take(b'\n', Duration::ZERO)),
            (Ok(None), Ok(None))
        );
        assert!(!between.is_at_line_start(), "the end of the frame is no line");
        assert_eq!(between.take(0, Duration::ZERO), Err(NotText));
    }
}
