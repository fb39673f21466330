//! The command line as a link sees it: lines go to the session, text comes back. Only the firmware interprets
//! them.

/// The kind of session that a line comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LineSource {
    /// A person or a script at a prompt.
    Prompt,
    /// A batch of lines between STX and ETX.
    Framed,
    /// One line in an MSP message.
    Message,
}

/// The answer to a line.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct LineReply {
    /// The text as it goes over the link, without echo and prompt.
    pub text: String,
    /// `true` if the line was refused.
    pub refused: bool,
    /// The consequence of the line for the link.
    pub then: AfterLine,
}

/// The consequence of a line for the link that carried it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AfterLine {
    /// The command line stays open.
    #[default]
    Stay,
    /// The command line closes, and the link uses MSP again.
    Leave,
    /// The firmware restarts, and the link is closed.
    Close,
}

/// The possible continuations of the last word of a line.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Completion {
    /// The text that is certain to follow.
    pub tail: String,
    /// The words that it may become.
    pub words: Vec<&'static str>,
}
