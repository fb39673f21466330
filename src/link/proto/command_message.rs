//! The command line in a message. `CLI_COMMAND` runs a line and returns its output, in pages when it is long.
//!
//! ```text
//! request  line [0  offset:u16]     offset 0 or none runs the line, a larger one pages through its output
//! reply    length:u16 flags output from the offset on     flags: 1 = output was cut, 2 = refused
//! ```

use super::command_line::LineReply;
use crate::msp::Frame;
use crate::msp::code::CLI_COMMAND;

/// The maximum number of output bytes that are kept.
const OUTPUT_MAX: usize = 2048;
/// The maximum number of output bytes of one reply.
const PAGE_MAX: usize = 512;
/// Flag: the output was longer than the kept part.
pub const CUT: u8 = 1;
/// Flag: the line was refused.
pub const REFUSED: u8 = 2;

/// The last line and its output.
#[derive(Debug, Clone, Default)]
pub(super) struct CommandMessage {
    /// The request whose line is running.
    open: Option<Frame>,
    line: String,
    output: Vec<u8>,
    flags: u8,
}

impl CommandMessage {
    /// Takes a frame. Returns `None` for another message, otherwise a line to run or the payload of the
    /// reply.
    pub(super) fn take(&mut self, frame: &Frame) -> Option<Result<String, Option<Vec<u8>>>> {
        if frame.code != CLI_COMMAND {
            return None;
        }
        let mut parts = frame.payload.splitn(2, |&byte| byte == 0);
        let line = parts.next().unwrap_or_default();
        let offset = match parts.next() {
            Some([low, high, ..]) => usize::from(u16::from_le_bytes([*low, *high])),
            _ => 0,
        };
        let Ok(line) = std::str::from_utf8(line).map(str::trim) else { return Some(Err(None)) };
        if offset > 0 {
            return Some(Err((line == self.line && !line.is_empty()).then(|| self.page(offset))));
        }
        line.clone_into(&mut self.line);
        self.output.clear();
        self.flags = 0;
        self.open = Some(frame.clone());
        Some(Ok(line.to_owned()))
    }

    /// Takes the answer to the line that was run. Returns the frame to send, unless the line came from
    /// elsewhere.
    pub(super) fn answer(&mut self, reply: &LineReply) -> Option<Frame> {
        let request = self.open.take()?;
        let text = reply.text.as_bytes();
        self.output = text[..text.len().min(OUTPUT_MAX)].to_vec();
        self.flags = if text.len() > OUTPUT_MAX { CUT } else { 0 };
        if reply.refused {
            self.flags |= REFUSED;
        }
        Some(request.answer(Some(self.page(0))))
    }

    fn page(&self, offset: usize) -> Vec<u8> {
        let rest = self.output.get(offset..).unwrap_or_default();
        let mut payload = (self.output.len() as u16).to_le_bytes().to_vec();
        payload.push(self.flags);
        payload.extend(&rest[..rest.len().min(PAGE_MAX)]);
        payload
    }
}
