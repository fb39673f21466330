//! A command line as an MSP message, with its output in pages.

use std::time::Duration;

use super::line_progress::LONGEST;
use super::request::Request;
use super::{Answer, line_text};
use crate::link::proto::command_message::{CUT, REFUSED};
use crate::msp::code::CLI_COMMAND;
use crate::msp::{Frame, MAX_REQUEST};

/// The bytes of a request after the line: a zero and the offset.
const OFFSET_BYTES: usize = 3;
/// The bytes of a reply before the output: total length and flags.
const HEAD: usize = 3;
/// The text appended to an output of which the flight controller kept only the beginning.
const WAS_CUT: &str = "\r\n###ERROR: THE OUTPUT IS TOO LONG FOR A MESSAGE###\r\n";

/// A line that was sent.
#[derive(Debug, Clone)]
pub(super) struct MessageLine {
    line: String,
    request: Request,
    output: Vec<u8>,
    begun: Duration,
}

/// The meaning of a frame for the line.
#[derive(Debug)]
pub(super) enum Page {
    /// The answer to another request.
    NotMine,
    /// A page. The request for the next one was sent.
    More,
    Last(Answer),
    /// The flight controller does not support the message.
    Unknown,
    /// The rest of the output is not available.
    Lost,
}

impl MessageLine {
    /// Returns `true` if a line fits into a message.
    pub(super) fn fits(line: &str) -> bool {
        line.len() + OFFSET_BYTES <= MAX_REQUEST
    }

    pub(super) fn send(line: &str, now: Duration, output: &mut Vec<u8>) -> Self {
        let request = Request::send(CLI_COMMAND, line.as_bytes(), now, output);
        Self { line: line.to_owned(), request, output: Vec::new(), begun: now }
    }

    /// Takes a frame and requests the next page if there is one.
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

    /// Returns `true` if the reply is overdue. The line is not sent again because it may have an effect.
    pub(super) fn is_overdue(&self, now: Duration) -> bool {
        now >= self.due()
    }

    /// Returns the time at which the reply is overdue.
    pub(super) fn due(&self) -> Duration {
        self.request.due().min(self.begun + LONGEST)
    }
}
