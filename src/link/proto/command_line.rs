//! The command line as a link sees it: lines go to the session, text comes back. What they mean is the firmware's affair.

/// What kind of session a line comes from.
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
    /// Text as it goes over the link, without echo and prompt.
    pub text: String,
    /// Whether the line was refused.
    pub refused: bool,
    /// What the line means for the link.
    pub then: AfterLine,
}

/// What a line means for the link that it came over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AfterLine {
    /// The command line stays open.
    #[default]
    Stay,
    /// The command line is left: the link speaks MSP again.
    Leave,
    /// The firmware starts anew, and the link is closed.
    Close,
}

/// How the last word of a line may go on.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Completion {
    /// What is certain to follow.
    pub tail: String,
    /// The words it may become.
    pub words: Vec<&'static str>,
}
