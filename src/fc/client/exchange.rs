//! The exchange between a request and its answer.

use std::time::Duration;

use super::framed_line::FramedLine;
use super::message_line::MessageLine;
use super::prompt_line::PromptLine;
use super::request::Request;
use super::{Answer, line_text};

/// The current exchange; one at a time.
#[derive(Debug, Clone)]
pub(super) enum Exchange {
    /// A message of the client itself. Its answer shows that all earlier answers have come or never will.
    Synchronise(Request),
    Msp(Request),
    /// A line by message.
    Message(MessageLine),
    /// A line between STX and ETX.
    Framed(FramedLine),
    /// A line at the prompt.
    Prompt(PromptLine),
}

impl Exchange {
    /// Returns the time at which the exchange must run without bytes.
    pub(super) fn due(&self) -> Duration {
        match self {
            Self::Synchronise(request) | Self::Msp(request) => request.due(),
            Self::Message(line) => line.due(),
            Self::Framed(line) => line.due(),
            Self::Prompt(line) => line.due(),
        }
    }

    /// Returns the line for which the command line did not open.
    pub(super) fn into_line(self) -> Option<String> {
        match self {
            Self::Framed(line) => Some(line.line),
            Self::Prompt(line) => Some(line.line),
            Self::Synchronise(_) | Self::Msp(_) | Self::Message(_) => None,
        }
    }

    /// Returns the answer that a closed link gives, if it means that the flight controller restarts.
    pub(super) fn when_link_closes(&self) -> Option<Answer> {
        let (line, text) = match self {
            Self::Framed(line) => line.sent()?,
            Self::Prompt(line) => line.sent()?,
            Self::Synchronise(_) | Self::Msp(_) | Self::Message(_) => return None,
        };
        (line_text::restarts(line) || line_text::announces_restart(&text))
            .then(|| line_text::answer(text, true))
    }
}
