//! The serial session of one client: MSP frames, and the command line between them, with and without framing.
//!
//! ```text
//! bytes ─▶ push() ─▶ next() ─┬─ Msp ────────▶ reply()
//!                            ├─ EnterCli ───▶ admit()        answers go to the output, in the order of
//!                            ├─ Line ───────▶ answer()       the questions: at most one is open at a time
//!                            ├─ Complete ───▶ complete()
//!                            ├─ Flush ──────▶ take_output()
//!                            └─ Restart, LeftCli
//! ```
//!
//! The owner of the stream reads more bytes only when [`SerialSession::next`] has nothing left, so memory is bounded by
//! what it reads at once, [`OUTPUT_MAX`] and one reply. One byte may cause kilobytes of output: a tab that lists all
//! settings.

use std::time::Duration;

use super::command_line::{AfterLine, Completion, LineReply, LineSource};
use super::command_message::CommandMessage;
use super::line_editor::{ENTRY_QUIET, LineEditor, LinkMode};
use super::msp::{Decoder, Dropped, Frame};

/// Opens the command line for one batch of lines.
const STX: u8 = 0x02;

/// Output that is sent before more is asked for, bytes.
pub const OUTPUT_MAX: usize = 64 * 1024;

/// What the client asks of the owner of the stream.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SerialRequest {
    /// Answer an MSP message; tell [`SerialSession::reply`].
    Msp(Frame),
    /// May the command line open? Not while armed; tell [`SerialSession::admit`].
    EnterCli {
        /// For a person, which blocks arming until the next restart; else for one batch of lines.
        interactive: bool,
    },
    /// Run a line; tell [`SerialSession::answer`].
    Line {
        /// The line, without its end.
        line: String,
        /// What kind of session it comes from.
        source: LineSource,
    },
    /// How may this line go on? Tell [`SerialSession::complete`].
    Complete {
        /// The line as far as it was typed.
        line: String,
    },
    /// Send what there is: [`SerialSession::take_output`].
    Flush,
    /// The firmware is to start anew, and the link to be closed.
    Restart,
    /// The command line was left.
    LeftCli,
}

/// The protocol state of one client.
#[derive(Debug, Clone)]
pub struct SerialSession {
    decoder: Decoder,
    editor: LineEditor,
    message: CommandMessage,
    input: Vec<u8>,
    taken: usize,
    output: Vec<u8>,
    in_cli: bool,
    restart: bool,
    line: Option<String>,
}

impl Default for SerialSession {
    /// A new client starts with MSP.
    fn default() -> Self {
        Self {
            decoder: Decoder::server(),
            editor: LineEditor::default(),
            message: CommandMessage::default(),
            input: Vec::new(),
            taken: 0,
            output: Vec::new(),
            in_cli: false,
            restart: false,
            line: None,
        }
    }
}

impl SerialSession {
    /// Takes bytes from the client.
    pub fn push(&mut self, bytes: &[u8]) {
        self.input.extend_from_slice(bytes);
    }

    /// What the client asks next; `None` when more bytes or more time are needed. `now` counts from the client's
    /// arrival.
    pub fn next(&mut self, now: Duration) -> Option<SerialRequest> {
        loop {
            if self.output.len() > OUTPUT_MAX {
                return Some(SerialRequest::Flush);
            }
            if let Some(line) = self.line.take() {
                let source = if self.editor.mode() == LinkMode::Interactive {
                    LineSource::Prompt
                } else {
                    LineSource::Framed
                };
                return Some(SerialRequest::Line { line, source });
            }
            if self.restart {
                self.restart = false;
                return Some(SerialRequest::Restart);
            }
            let in_cli = matches!(self.editor.mode(), LinkMode::Interactive | LinkMode::Framed { .. });
            if self.in_cli && !in_cli {
                self.in_cli = false;
                return Some(SerialRequest::LeftCli);
            }
            if self.due().is_some_and(|due| now >= due) {
                return Some(SerialRequest::EnterCli { interactive: true });
            }
            let Some(&byte) = self.input.get(self.taken) else {
                self.input.clear();
                self.taken = 0;
                return None;
            };
            if byte == STX && self.editor.mode() == LinkMode::Msp && self.decoder.is_between_frames() {
                return Some(SerialRequest::EnterCli { interactive: false });
            }
            self.taken += 1;
            if let Some(request) = self.take(byte, now) {
                return Some(request);
            }
        }
    }

    fn take(&mut self, byte: u8, now: Duration) -> Option<SerialRequest> {
        let for_msp = if self.editor.mode() == LinkMode::Msp && !self.decoder.is_between_frames() {
            true
        } else {
            let output = self.editor.feed(byte, false, now);
            self.output.extend(output.bytes);
            self.line = output.line;
            self.restart = output.restart;
            if output.completes {
                return Some(SerialRequest::Complete { line: self.editor.line().to_owned() });
            }
            output.for_msp
        };
        if !for_msp {
            return None;
        }
        let frame = self.decoder.push(byte)?;
        match self.message.take(&frame) {
            Some(Ok(line)) => Some(SerialRequest::Line { line, source: LineSource::Message }),
            Some(Err(payload)) => {
                frame.answer(payload).encode(&mut self.output);
                None
            }
            None => Some(SerialRequest::Msp(frame)),
        }
    }

    /// Says whether the command line that was asked for opens.
    pub fn admit(&mut self, admitted: bool, now: Duration) {
        if let LinkMode::Entering { .. } = self.editor.mode() {
            let greeting = self.editor.poll(!admitted, now);
            self.output.extend(greeting.unwrap_or_default());
        } else {
            self.taken += 1;
            let output = self.editor.feed(STX, !admitted, now);
            self.output.extend(output.bytes);
        }
        self.in_cli = admitted;
    }

    /// Answers a request: a payload, or `None` for the protocol's error.
    pub fn reply(&mut self, request: &Frame, payload: Option<Vec<u8>>) {
        request.answer(payload).encode(&mut self.output);
    }

    /// Answers a line. Says whether the link is to be closed.
    #[must_use]
    pub fn answer(&mut self, reply: &LineReply) -> bool {
        if let Some(frame) = self.message.answer(reply) {
            frame.encode(&mut self.output);
            return false;
        }
        let bytes = self.editor.answer(reply);
        self.output.extend(bytes);
        reply.then == AfterLine::Close
    }

    /// Answers how a line may go on.
    pub fn complete(&mut self, completion: Completion) {
        let bytes = self.editor.complete(completion);
        self.output.extend(bytes);
    }

    /// What is to be sent, taken away.
    pub fn take_output(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.output)
    }

    /// When [`Self::next`] will have something even without bytes.
    #[must_use]
    pub fn due(&self) -> Option<Duration> {
        match self.editor.mode() {
            LinkMode::Entering { since } => Some(since + ENTRY_QUIET),
            LinkMode::Msp | LinkMode::Interactive | LinkMode::Framed { .. } => None,
        }
    }

    /// Whether the command line is open.
    #[must_use]
    pub fn is_in_cli(&self) -> bool {
        self.in_cli
    }

    /// Frames given up so far.
    #[must_use]
    pub fn dropped(&self) -> Dropped {
        self.decoder.dropped()
    }
}
