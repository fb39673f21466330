//! A command line as an MSP message, its output in pages.

use std::time::Duration;

use super::exchange::LONGEST;
use super::request::Request;
use super::{Answer, line_text};
use crate::link::proto::command_message::{CLI_COMMAND, CUT, REFUSED};
use crate::link::proto::msp::{Frame, MAX_REQUEST};

/// Bytes of a request behind the line: a zero and the offset.
const OFFSET_BYTES: usize = 3;
/// Bytes of a reply before the output: total length and flags.
const HEAD: usize = 3;
/// What is appended to an output of which the flight controller kept the beginning only.
const WAS_CUT: &str = "\r\n###ERROR: THE OUTPUT IS TOO LONG FOR A MESSAGE###\r\n";

/// A line that was sent.
#[derive(Debug)]
pub(super) struct MessageLine {
    line: String,
    request: Request,
    output: Vec<u8>,
    begun: Duration,
}

/// What a frame is to the line.
#[derive(Debug)]
pub(super) enum Page {
    /// The answer to something else.
    NotMine,
    /// A page; the next was asked for.
    More,
    Last(Answer),
    /// The flight controller knows no such message.
    Unknown,
    /// The rest of the output cannot be had.
    Lost,
}

impl MessageLine {
    /// Whether a line has room in a message.
    pub(super) fn fits(line: &str) -> bool {
        line.len() + OFFSET_BYTES <= MAX_REQUEST
    }

    pub(super) fn send(line: &str, now: Duration, output: &mut Vec<u8>) -> Self {
        let request = Request::send(CLI_COMMAND, line.as_bytes(), now, output);
        Self { line: line.to_owned(), request, output: Vec::new(), begun: now }
    }

    /// Takes a frame, and asks for the next page when there is one.
    pub(super) fn answer(&mut self, frame: Frame, now: Duration, output: &mut Vec<u8>) -> Page {
        let first = self.output.is_empty();
        let Some(payload) = self.request.answer(frame) else { return Page::NotMine };
        let Some(payload) = payload else { return if first { Page::Unknown } else { Page::Lost } };
        let Some(([low, high, flags], page)) = payload.split_first_chunk::<HEAD>() else {
            return Page::Lost;
        };
        let total = usize::from(u16::from_le_bytes([*low, *high]));
        self.output.extend(&page[..page.len().min(total.saturating_sub(self.output.len()))]);
        if self.output.len() >= total {
            return Page::Last(self.whole(*flags));
        }
        if page.is_empty() {
            return Page::Lost;
        }
        let offset = (self.output.len() as u16).to_le_bytes();
        self.request.send_next([self.line.as_bytes(), &[0], &offset].concat(), now, output);
        Page::More
    }

    fn whole(&self, flags: u8) -> Answer {
        let mut text = String::from_utf8_lossy(&self.output).into_owned();
        if flags & CUT != 0 {
            text.push_str(WAS_CUT);
        }
        let failed = flags & (REFUSED | CUT) != 0 || line_text::tells_of_error(&text);
        Answer::Line { text, failed, restarted: false }
    }

    /// Whether the reply is late; it is not asked for again, for a line may do something.
    pub(super) fn is_overdue(&self, now: Duration) -> bool {
        now >= self.due()
    }

    /// When the reply is late.
    pub(super) fn due(&self) -> Duration {
        self.request.due().min(self.begun + LONGEST)
    }
}
