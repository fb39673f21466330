//! The faults of a header that can be read in spite of them.

use std::fmt;

use super::lines::Lines;

/// The most characters of a line that a sentence quotes.
const MAX_QUOTED: usize = 60;

/// A line of a header that is damaged, missing or without a value that can be used. `Display` gives a sentence, with what is
/// assumed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HeaderFinding {
    line: String,
    sentence: String,
}

impl HeaderFinding {
    /// Returns a finding about a missing line, or about the value of one. `assumed` is a clause without its full stop.
    pub(super) fn of(lines: &Lines, line: &str, assumed: &str) -> Self {
        let sentence = match lines.value(line) {
            None => format!("The header has no line `{line}`: {assumed}."),
            Some(value) => {
                let quoted = quoted(&format!("{line}:{value}"));
                format!("The line `{quoted}` of the header has no value that can be used: {assumed}.")
            }
        };
        Self { line: line.to_owned(), sentence }
    }

    /// Returns a finding about all lines that define a frame.
    pub(super) fn undefined(frame: char, rest: &str) -> Self {
        let line = format!("Field {frame}");
        let sentence = format!("The header has no usable lines `{line} …`: {frame} frames are passed{rest}.");
        Self { line, sentence }
    }

    /// Returns a finding about a line of another form than `H name:value`. `number` counts from 1.
    pub(super) fn damaged(number: usize, text: &[u8]) -> Self {
        let quoted = quoted(&String::from_utf8_lossy(text));
        let sentence = format!(
            "Line {number} of the header is damaged, and lines after it may be missing: `{quoted}` is not of the form `H name:value`."
        );
        Self { line: String::new(), sentence }
    }

    /// Returns a finding about a line whose value has a part of another line.
    pub(super) fn joined(number: usize, name: &str, value: &str) -> Self {
        let quoted = quoted(&format!("H {name}:{value}"));
        let sentence = format!(
            "Line {number} of the header is damaged, and lines after it may be missing: `{quoted}` has parts of two lines."
        );
        Self { line: name.to_owned(), sentence }
    }

    /// Returns the name of the line, for example `motorOutput`, or the beginning of several, for example `Field G`. Empty for a
    /// line without a name.
    pub fn line(&self) -> &str {
        &self.line
    }
}

impl fmt::Display for HeaderFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.sentence)
    }
}

/// Returns the beginning of a line, with a dot for each character that cannot be shown.
fn quoted(text: &str) -> String {
    let shown = |letter: char| if letter.is_control() || letter == '`' { '·' } else { letter };
    let mut quoted: String = text.trim_end().chars().take(MAX_QUOTED).map(shown).collect();
    if text.trim_end().chars().nth(MAX_QUOTED).is_some() {
        quoted.push('…');
    }
    quoted
}
