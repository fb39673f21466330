//! The line editor of one serial link: bytes in, lines and echo out. It holds no clock and no socket; the
//! time since the link opened is an argument.

use std::time::Duration;

use super::command_line::{AfterLine, Completion, LineReply};

/// The silence that must follow a `#` before it opens the command line.
pub(super) const ENTRY_QUIET: Duration = Duration::from_millis(100);
/// The maximum number of characters of a line; the rest is dropped.
pub const MAX_LINE: usize = 255;
/// The longest duration of a framed session.
const FRAMED_LIMIT: Duration = Duration::from_secs(2);

const STX: u8 = 0x02;
const ETX: u8 = 0x03;
const CTRL_D: u8 = 0x04;
const BACKSPACE: u8 = 0x08;
const TAB: u8 = 0x09;
const CTRL_L: u8 = 0x0c;
const DELETE: u8 = 0x7f;
const PROMPT: &str = "\r\n# ";
const GREETING: &str = "\r\nEntering CLI Mode, type 'exit' to reboot, or 'help'\r\n";
const ERASE: &[u8] = b"\x08 \x08";
const CLEAR_SCREEN: &str = "\x1b[2J\x1b[1;1H";
const CLEAR_LINE: &str = "\r\n\x1b[K";

/// The current meaning of the bytes on the link.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LinkMode {
    /// MSP frames; a byte between frames may open the command line.
    #[default]
    Msp,
    /// A `#` has arrived, and the link has been quiet since.
    Entering {
        /// The time of the last byte.
        since: Duration,
    },
    /// The command line with echo and prompt.
    Interactive,
    /// Lines between STX and ETX, without echo and prompt.
    Framed {
        /// The time of the STX.
        since: Duration,
    },
}

/// The effect of a byte.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct EditorOutput {
    /// Bytes to send now.
    pub bytes: Vec<u8>,
    /// A line to run; its reply goes through [`LineEditor::answer`].
    pub line: Option<String>,
    /// `true` if the word being typed must be completed. The completion goes to [`LineEditor::complete`].
    pub completes: bool,
    /// `true` if the client requests a restart without saving.
    pub restart: bool,
    /// `true` if the byte belongs to MSP.
    pub for_msp: bool,
}

impl EditorOutput {
    fn send(bytes: impl Into<Vec<u8>>) -> Self {
        Self { bytes: bytes.into(), ..Self::default() }
    }
}

/// The editor of one link.
#[derive(Debug, Clone, Default)]
pub struct LineEditor {
    mode: LinkMode,
    buffer: String,
}

impl LineEditor {
    /// Returns the current mode of the link.
    pub fn mode(&self) -> LinkMode {
        self.mode
    }

    /// Takes one byte. In [`LinkMode::Msp`], pass only bytes between frames.
    pub fn feed(&mut self, byte: u8, armed: bool, now: Duration) -> EditorOutput {
        match self.mode {
            LinkMode::Msp => self.between_frames(byte, armed, now),
            LinkMode::Entering { .. } => self.entering(byte, now),
            LinkMode::Interactive => self.interactive(byte),
            LinkMode::Framed { since } => self.framed(byte, now.saturating_sub(since)),
        }
    }

    /// Completes an entry by silence. Returns the greeting once the link was quiet long enough after the `#`.
    pub fn poll(&mut self, armed: bool, now: Duration) -> Option<Vec<u8>> {
        let LinkMode::Entering { since } = self.mode else { return None };
        if now.saturating_sub(since) < ENTRY_QUIET {
            return None;
        }
        self.buffer.clear();
        if armed {
            self.mode = LinkMode::Msp;
            return None;
        }
        self.mode = LinkMode::Interactive;
        Some(format!("{GREETING}{PROMPT}").into_bytes())
    }

    /// Returns the bytes that answer a line, followed by the prompt if the command line stays open.
    pub fn answer(&mut self, reply: &LineReply) -> Vec<u8> {
        let mut bytes = reply.text.clone().into_bytes();
        if self.mode == LinkMode::Interactive {
            match reply.then {
                AfterLine::Stay => bytes.extend_from_slice(PROMPT.as_bytes()),
                AfterLine::Leave | AfterLine::Close => self.mode = LinkMode::Msp,
            }
        }
        bytes
    }

    /// Returns the line as typed so far.
    pub fn line(&self) -> &str {
        &self.buffer
    }

    /// Extends the last word as far as it is certain, and lists the possibilities if there are several.
    /// Returns the bytes to send.
    pub fn complete(&mut self, found: Completion) -> Vec<u8> {
        let Completion { mut tail, words } = found;
        if words.len() == 1 {
            tail.push(' ');
        }
        tail.truncate(MAX_LINE.saturating_sub(self.buffer.len()));
        self.buffer.push_str(&tail);
        match words.as_slice() {
            [] => Vec::new(),
            [_] => tail.into_bytes(),
            several => {
                let list: String = several.iter().map(|word| format!("{word}\t")).collect();
                format!("{CLEAR_LINE}{list}{PROMPT}{}", self.buffer).into_bytes()
            }
        }
    }

    fn between_frames(&mut self, byte: u8, armed: bool, now: Duration) -> EditorOutput {
        match byte {
            b'#' | STX if armed => EditorOutput::default(),
            b'#' => {
                self.mode = LinkMode::Entering { since: now };
                EditorOutput::default()
            }
            STX => {
                self.mode = LinkMode::Framed { since: now };
                self.buffer.clear();
                EditorOutput::send([STX])
            }
            _ => EditorOutput { for_msp: true, ..EditorOutput::default() },
        }
    }

    fn entering(&mut self, byte: u8, now: Duration) -> EditorOutput {
        if byte == b'$' {
            self.mode = LinkMode::Msp;
            return EditorOutput { for_msp: true, ..EditorOutput::default() };
        }
        self.mode = LinkMode::Entering { since: now };
        EditorOutput::default()
    }

    fn framed(&mut self, byte: u8, age: Duration) -> EditorOutput {
        if byte == ETX || age > FRAMED_LIMIT {
            self.mode = LinkMode::Msp;
            self.buffer.clear();
            return EditorOutput::send([ETX]);
        }
        match byte {
            b'\r' | b'\n' => EditorOutput { line: self.take_line(), ..EditorOutput::default() },
            DELETE | BACKSPACE => {
                self.buffer.pop();
                EditorOutput::default()
            }
            _ => {
                self.keep(byte);
                EditorOutput::default()
            }
        }
    }

    fn interactive(&mut self, byte: u8) -> EditorOutput {
        match byte {
            b'\r' | b'\n' => match self.take_line() {
                Some(line) => EditorOutput { line: Some(line), ..EditorOutput::send(*b"\r\n") },
                None => EditorOutput::default(),
            },
            DELETE | BACKSPACE => match self.buffer.pop() {
                Some(_) => EditorOutput::send(ERASE),
                None => EditorOutput::default(),
            },
            TAB | b'?' => EditorOutput { completes: true, ..EditorOutput::default() },
            CTRL_L => EditorOutput::send(format!("{CLEAR_SCREEN}{PROMPT}")),
            CTRL_D if self.buffer.is_empty() => {
                self.mode = LinkMode::Msp;
                EditorOutput { restart: true, ..EditorOutput::send(*b"\r\nRebooting") }
            }
            _ if self.keep(byte) => EditorOutput::send([byte]),
            _ => EditorOutput::default(),
        }
    }

    /// Buffers a printable byte. Drops leading spaces and everything beyond the longest line.
    fn keep(&mut self, byte: u8) -> bool {
        let leading_space = byte == b' ' && self.buffer.is_empty();
        let kept = (b' '..=b'~').contains(&byte) && !leading_space && self.buffer.len() < MAX_LINE;
        if kept {
            self.buffer.push(char::from(byte));
        }
        kept
    }

    fn take_line(&mut self) -> Option<String> {
        let line = std::mem::take(&mut self.buffer);
        (!line.is_empty()).then_some(line)
    }
}
