//! A command line at the prompt that `#` opens, with echo.

use std::time::Duration;

use super::framed_line::{MAX_OUTPUT, RESTART_QUIET, end_of};
use super::line_progress::{LONGEST, LineProgress};
use super::line_text;

/// The character that opens the command line after a quiet moment.
const ENTRY: u8 = b'#';
/// The longest wait for the greeting.
const OPENING: Duration = Duration::from_millis(1500);
/// The longest pause in the output.
const PAUSE: Duration = Duration::from_secs(4);
/// The silence that must follow a prompt: `dump` prints headings that begin like one.
const PROMPT_QUIET: Duration = Duration::from_millis(60);
const PROMPT: &[u8] = b"\r\n# ";
/// The word that identifies the greeting.
const GREETING: &str = "CLI";
/// The answer to `exit noreboot`, after which no prompt follows.
const LEFT: &str = "no reboot";

/// A line and its output.
#[derive(Debug, Clone)]
pub(super) struct PromptLine {
    pub(super) line: String,
    /// `true` once the prompt is open and the line was typed.
    typed: bool,
    output: Vec<u8>,
    begun: Duration,
    /// The time of the last transmission or of the last byte kept.
    active: Duration,
}

impl PromptLine {
    /// Types a line at the open prompt, or opens the prompt first.
    pub(super) fn new(line: String, open: bool, now: Duration, output: &mut Vec<u8>) -> Self {
        let mut new = Self { line, typed: false, output: Vec::new(), begun: now, active: now };
        if open {
            new.type_line(now, output);
        } else {
            output.push(ENTRY);
        }
        new
    }

    fn type_line(&mut self, now: Duration, output: &mut Vec<u8>) {
        self.typed = true;
        self.active = now;
        self.output.clear();
        output.extend(self.line.as_bytes());
        output.push(b'\n');
    }

    /// Takes a byte of the output.
    pub(super) fn push(&mut self, byte: u8, now: Duration) {
        if self.output.len() < MAX_OUTPUT {
            self.output.push(byte);
            self.active = now;
        }
    }

    /// Evaluates the output once it has paused.
    pub(super) fn poll(&mut self, now: Duration, output: &mut Vec<u8>) -> LineProgress {
        if now < self.due() {
            return LineProgress::Waiting;
        }
        let at_prompt = self.output.ends_with(PROMPT);
        if !self.typed && at_prompt && end_of(&self.output).contains(GREETING) {
            self.type_line(now, output);
            LineProgress::Waiting
        } else if !self.typed {
            LineProgress::NotOpened
        } else if at_prompt {
            LineProgress::Answered { text: self.text(), open: true }
        } else if line_text::announces_restart(&end_of(&self.output)) {
            LineProgress::Restarting { text: self.text() }
        } else if self.leaves() {
            LineProgress::Answered { text: self.text(), open: false }
        } else {
            LineProgress::Silent
        }
    }

    pub(super) fn due(&self) -> Duration {
        let patience = if self.output.ends_with(PROMPT) || self.leaves() {
            PROMPT_QUIET
        } else if line_text::announces_restart(&end_of(&self.output)) {
            RESTART_QUIET
        } else if self.typed {
            PAUSE
        } else {
            OPENING
        };
        (self.active + patience).min(self.begun + LONGEST)
    }

    /// Returns the line and its output so far, once it was typed.
    pub(super) fn sent(&self) -> Option<(&str, String)> {
        self.typed.then(|| (self.line.as_str(), self.text()))
    }

    /// Returns `true` for the answer to a line that leaves the command line without a restart.
    fn leaves(&self) -> bool {
        self.typed
            && self.line.to_ascii_lowercase().starts_with("exit")
            && end_of(&self.output).trim_end().ends_with(LEFT)
    }

    /// Returns the output without echo and prompt.
    fn text(&self) -> String {
        let text = String::from_utf8_lossy(&self.output);
        let text = text.strip_suffix("\r\n# ").unwrap_or(&text);
        let text =
            text.strip_prefix(&self.line).map_or(text, |rest| rest.strip_prefix("\r\n").unwrap_or(rest));
        text.to_owned()
    }
}
