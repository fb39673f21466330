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
//! The owner of the stream reads more bytes only when [`SerialSession::next`] has nothing left. Memory is
//! therefore bounded by the bytes of one read, [`OUTPUT_MAX`] and one reply. One byte may cause kilobytes of
//! output: a tab that lists all settings.

use std::time::Duration;

use super::between_frames::{BetweenFrames, NotText};
use super::command_line::{AfterLine, Completion, LineReply, LineSource};
use super::command_message::CommandMessage;
use super::line_editor::{ENTRY_QUIET, LineEditor, LinkMode};
use crate::msp::{Decoder, Dropped, Frame};

/// Opens the command line for one batch of lines.
const STX: u8 = 0x02;

/// The amount of output that is sent before the next request is processed, bytes.
pub const OUTPUT_MAX: usize = 64 * 1024;

/// A request to the owner of the stream.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SerialRequest {
    /// Answer an MSP message with [`SerialSession::reply`].
    Msp(Frame),
    /// Open the command line unless the craft is armed. Answer with [`SerialSession::admit`].
    EnterCli {
        /// `true` for a person, which blocks arming until the next restart; `false` for one batch of lines.
        interactive: bool,
    },
    /// Run a line. Answer with [`SerialSession::answer`].
    Line {
        /// The line, without its end.
        line: String,
        /// The kind of session that the line comes from.
        source: LineSource,
    },
    /// Complete this line. Answer with [`SerialSession::complete`].
    Complete {
        /// The line as typed so far.
        line: String,
    },
    /// Send the bytes of [`SerialSession::take_output`].
    Flush,
    /// Restart the firmware and close the link.
    Restart,
    /// The command line was closed.
    LeftCli,
    /// A line of text arrived while the command line was closed, and was ignored. Reported once per paste of
    /// several lines.
    Ignored { word: String },
    /// The received bytes are neither MSP nor text. Close the link; later bytes are not interpreted.
    Foreign,
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
    between: BetweenFrames,
    is_foreign: bool,
}

impl Default for SerialSession {
    /// Creates the state of a new client, which starts with MSP.
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
            between: BetweenFrames::default(),
            is_foreign: false,
        }
    }
}

impl SerialSession {
    /// Takes bytes from the client.
    pub fn push(&mut self, bytes: &[u8]) {
        if !self.is_foreign {
            self.input.extend_from_slice(bytes);
        }
    }

    /// Returns the next request; `None` if more bytes or more time are needed. `now` counts from the client's
    /// arrival.
    pub fn next(&mut self, now: Duration) -> Option<SerialRequest> {
        while !self.is_foreign {
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
            let opens_batch = byte == STX && self.is_outside() && self.between.is_at_line_start();
            if opens_batch && self.editor.mode() == LinkMode::Msp {
                return Some(SerialRequest::EnterCli { interactive: false });
            }
            self.taken += 1;
            if let Some(request) = self.take(byte, now) {
                return Some(request);
            }
        }
        None
    }

    /// Returns `true` if the next byte is neither in a frame nor for the command line.
    fn is_outside(&self) -> bool {
        match self.editor.mode() {
            LinkMode::Msp => self.decoder.is_between_frames(),
            LinkMode::Entering { .. } => true,
            LinkMode::Interactive | LinkMode::Framed { .. } => false,
        }
    }

    fn take(&mut self, byte: u8, now: Duration) -> Option<SerialRequest> {
        let in_frame = self.editor.mode() == LinkMode::Msp && !self.decoder.is_between_frames();
        let is_outside = self.is_outside();
        let mut ignored = None;
        if is_outside && byte != b'$' {
            let begins_line = self.between.is_at_line_start();
            ignored = match self.between.take(byte, now) {
                Ok(word) => word.map(|word| SerialRequest::Ignored { word }),
                Err(NotText) => return Some(self.give_up()),
            };
            if self.editor.mode() == LinkMode::Msp && !(begins_line && byte == b'#') {
                return ignored;
            }
        } else if !is_outside && !in_frame {
            self.between.begin_line();
        }
        let for_msp = if in_frame {
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
            return ignored;
        }
        let before = self.decoder.dropped();
        let frame = self.decoder.push(byte);
        if in_frame && self.decoder.is_between_frames() {
            let dropped = self.decoder.dropped();
            if dropped == before {
                self.between.begin_line();
            } else if dropped.oversized != before.oversized {
                self.between.expect_frame_rest(self.decoder.oversized_rest());
            } else {
                self.between.begin_inside_line();
                if dropped.malformed != before.malformed && self.between.take(byte, now).is_err() {
                    return Some(self.give_up());
                }
            }
        }
        let frame = frame?;
        match self.message.take(&frame) {
            Some(Ok(line)) => Some(SerialRequest::Line { line, source: LineSource::Message }),
            Some(Err(payload)) => {
                frame.answer(payload).encode(&mut self.output);
                None
            }
            None => Some(SerialRequest::Msp(frame)),
        }
    }

    /// Ends the session because the other side uses another protocol.
    fn give_up(&mut self) -> SerialRequest {
        self.is_foreign = true;
        self.input.clear();
        self.taken = 0;
        SerialRequest::Foreign
    }

    /// Answers a request to open the command line.
    pub fn admit(&mut self, admitted: bool, now: Duration) {
        self.between.begin_line();
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

    /// Answers a request with a payload, or with the protocol's error for `None`.
    pub fn reply(&mut self, request: &Frame, payload: Option<Vec<u8>>) {
        request.answer(payload).encode(&mut self.output);
    }

    /// Answers a line. Returns `true` if the link must close.
    pub fn answer(&mut self, reply: &LineReply) -> bool {
        if let Some(frame) = self.message.answer(reply) {
            frame.encode(&mut self.output);
            return false;
        }
        let bytes = self.editor.answer(reply);
        self.output.extend(bytes);
        reply.then == AfterLine::Close
    }

    /// Answers a completion request.
    pub fn complete(&mut self, completion: Completion) {
        let bytes = self.editor.complete(completion);
        self.output.extend(bytes);
    }

    /// Takes the bytes to send.
    pub fn take_output(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.output)
    }

    /// Returns the time at which [`Self::next`] has a request even without bytes.
    pub fn due(&self) -> Option<Duration> {
        match self.editor.mode() {
            LinkMode::Entering { since } => Some(since + ENTRY_QUIET),
            LinkMode::Msp | LinkMode::Interactive | LinkMode::Framed { .. } => None,
        }
    }

    /// Returns `true` while the command line is open.
    pub fn is_in_cli(&self) -> bool {
        self.in_cli
    }

    /// Returns the numbers of frames dropped so far.
    pub fn dropped(&self) -> Dropped {
        self.decoder.dropped()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::msp::Form;

    const FRAME: &[u8] = b"$M<\x00\x01\x01";
    const QUIET: Duration = Duration::from_millis(150);

    /// Returns the requests after each of these bursts, which are followed by a quiet moment. The command
    /// line does not open.
    fn asked(bursts: &[&[u8]]) -> Vec<SerialRequest> {
        let (mut session, mut now, mut all) = (SerialSession::default(), Duration::ZERO, Vec::new());
        for burst in bursts {
            session.push(burst);
            for _ in 0..2 {
                while let Some(ask) = session.next(now) {
                    match &ask {
                        SerialRequest::Msp(frame) => session.reply(frame, None),
                        SerialRequest::EnterCli { .. } => session.admit(false, now),
                        _ => {}
                    }
                    all.push(ask);
                }
                now += QUIET;
            }
        }
        all
    }

    fn is_entry(ask: &SerialRequest) -> bool {
        matches!(ask, SerialRequest::EnterCli { .. })
    }

    #[test]
    fn a_hash_inside_of_something_else_opens_nothing() {
        for bytes in [b"x#".as_slice(), b"\x04#", b"a \x02", "ö#".as_bytes(), b"$x#", b"$M<\x00\x01\x02#"] {
            let asks = asked(&[FRAME, bytes]);
            assert!(!asks.iter().any(is_entry), "{}: {asks:?}", bytes.escape_ascii());
        }
        for bytes in [b"#".as_slice(), b" #", b"\r\n#", b"x\n#", b"x\r\n\x02", b"\x03#"] {
            let asks = asked(&[FRAME, bytes]);
            assert!(asks.iter().any(is_entry), "{}: {asks:?}", bytes.escape_ascii());
        }
    }

    #[test]
    fn nothing_is_asked_after_bytes_that_are_no_text() {
        for bytes in [b"\x00\x64\x00\x01#".as_slice(), b"#\x00", b"\n\xff\n#", b"$M\x00#"] {
            let asks = asked(&[FRAME, bytes, FRAME, b"\n#"]);
            assert!(
                matches!(&asks[..], [SerialRequest::Msp(_), SerialRequest::Foreign]),
                "{}: {asks:?}",
                bytes.escape_ascii()
            );
        }
    }

    #[test]
    fn a_message_that_is_too_long_ends_neither_the_session_nor_counts_as_text() {
        let mut too_long = Vec::new();
        Frame::request(Form::V2, 1, &[b'#'; 300]).encode(&mut too_long);
        let asks = asked(&[&too_long, FRAME]);
        assert!(matches!(&asks[..], [SerialRequest::Msp(_)]), "{asks:?}");
    }

    #[test]
    fn lines_to_a_closed_command_line_are_reported_once_a_paste() {
        let block = b"#\nwaypoint reset\nwaypoint insert 0 1 2 3 0 LAND 0 NONE\n";
        let asks = asked(&[block, b"waypoint list\n"]);
        let ignored =
            |ask: &&SerialRequest| matches!(ask, SerialRequest::Ignored { word } if word == "waypoint");
        assert_eq!(asks.iter().filter(ignored).count(), 1, "{asks:?}");
    }
}
