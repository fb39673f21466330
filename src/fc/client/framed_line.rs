//! A command line between STX and ETX.

use std::time::Duration;

use super::line_progress::{LONGEST, LineProgress};
use super::line_text;

const ETX: u8 = 0x03;
/// The longest wait for the STX that opens the command line.
const OPENING: Duration = Duration::from_millis(700);
/// The longest pause in the output. A board is silent while it stores its settings.
const PAUSE: Duration = Duration::from_secs(4);
/// The silence that must follow the announcement of a restart before it is believed on a link that stays
/// open.
pub(super) const RESTART_QUIET: Duration = Duration::from_millis(500);
/// The maximum number of output bytes that are kept.
pub(super) const MAX_OUTPUT: usize = 256 * 1024;

/// A line and its output. STX was sent; the line follows once STX is answered, because a flight controller
/// that does not open its command line takes single letters for commands.
#[derive(Debug, Clone)]
pub(super) struct FramedLine {
    pub(super) line: String,
    open: bool,
    output: Vec<u8>,
    begun: Duration,
    /// The time of the last transmission or of the last byte kept.
    active: Duration,
}

impl FramedLine {
    pub(super) fn new(line: String, now: Duration) -> Self {
        Self { line, open: false, output: Vec::new(), begun: now, active: now }
    }

    /// Returns `true` while the command line is open and every byte belongs to it.
    pub(super) fn is_open(&self) -> bool {
        self.open
    }

    /// Takes a byte: STX first, then output.
    pub(super) fn push(&mut self, byte: u8, now: Duration, output: &mut Vec<u8>) -> LineProgress {
        if !self.open {
            self.open = true;
            self.active = now;
            output.extend(self.line.as_bytes());
            output.extend([b'\n', ETX]);
            return LineProgress::Waiting;
        }
        if byte == ETX && self.announces_restart() {
            return LineProgress::Restarting { text: self.text() };
        }
        if byte == ETX {
            return LineProgress::Answered { text: self.text(), open: false };
        }
        if self.output.len() < MAX_OUTPUT {
            self.output.push(byte);
            self.active = now;
        }
        LineProgress::Waiting
    }

    pub(super) fn poll(&self, now: Duration) -> LineProgress {
        if now < self.due() {
            LineProgress::Waiting
        } else if !self.open {
            LineProgress::NotOpened
        } else if self.announces_restart() {
            LineProgress::Restarting { text: self.text() }
        } else {
            LineProgress::Silent
        }
    }

    pub(super) fn due(&self) -> Duration {
        let patience = match self.open {
            false => OPENING,
            true if self.announces_restart() => RESTART_QUIET,
            true => PAUSE,
        };
        (self.active + patience).min(self.begun + LONGEST)
    }

    /// Returns the line and its output so far, once it was sent.
    pub(super) fn sent(&self) -> Option<(&str, String)> {
        self.open.then(|| (self.line.as_str(), self.text()))
    }

    fn announces_restart(&self) -> bool {
        line_text::announces_restart(&end_of(&self.output))
    }

    fn text(&self) -> String {
        String::from_utf8_lossy(&self.output).into_owned()
    }
}

/// Returns the end of an output.
pub(super) fn end_of(output: &[u8]) -> std::borrow::Cow<'_, str> {
    String::from_utf8_lossy(&output[output.len().saturating_sub(80)..])
}
