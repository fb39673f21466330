//! What is under way between a request and its answer.

use std::time::Duration;

use super::Answer;
use super::framed_line::FramedLine;
use super::line_text;
use super::message_line::MessageLine;
use super::prompt_line::PromptLine;
use super::request::Request;

/// How long a line may take with all of its output, however steadily that comes.
pub(super) const LONGEST: Duration = Duration::from_secs(60);

/// What is under way; one at a time.
#[derive(Debug)]
pub(super) enum Exchange {
    /// A message that nobody asked for: its answer shows that all earlier ones have come or never will.
    Synchronise(Request),
    Msp(Request),
    /// A line by message.
    Message(MessageLine),
    /// A line between STX and ETX.
    Framed(FramedLine),
    /// A line at the prompt.
    Prompt(PromptLine),
}

/// How far a line is.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum LineProgress {
    /// Its answer is still to come.
    Waiting,
    Answered {
        text: String,
        /// Whether the prompt stays open.
        open: bool,
    },
    /// Through, and the flight controller says that it restarts.
    Restarting { text: String },
    /// The output has stopped without its end.
    Silent,
    /// The command line did not open; the line was not sent.
    NotOpened,
}

impl Exchange {
    /// When it has something to do without bytes.
    pub(super) fn due(&self) -> Duration {
        match self {
            Self::Synchronise(request) | Self::Msp(request) => request.due(),
            Self::Message(line) => line.due(),
            Self::Framed(line) => line.due(),
            Self::Prompt(line) => line.due(),
        }
    }

    /// The line that the command line did not open for.
    pub(super) fn into_line(self) -> Option<String> {
        match self {
            Self::Framed(line) => Some(line.line),
            Self::Prompt(line) => Some(line.line),
            Self::Synchronise(_) | Self::Msp(_) | Self::Message(_) => None,
        }
    }

    /// The answer that a closed link is, if it is one: the flight controller restarts.
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
