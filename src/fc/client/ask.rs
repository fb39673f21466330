//! Requests to a flight controller and their answers.

/// The name of a request until its answer, chosen by the caller.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct AskId(pub u64);

/// A request to a flight controller.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Ask {
    Msp {
        code: u16,
        payload: Vec<u8>,
    },
    /// A command line, sent as [`CliAccess`] says; by MSP message while the command line does not open.
    Line(String),
    /// A command line at the prompt, as it is typed by a person. The prompt stays open, and MSP waits for its end.
    Typed(String),
    /// Leaves the prompt, if it is open. Needs no answer.
    LeavePrompt,
    /// A command line by MSP message only, which works in flight and disturbs nothing.
    MessageLine(String),
}

/// The result of a request.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Answer {
    /// The payload of the reply; `None` when the message is unknown or refused.
    Msp(Option<Vec<u8>>),
    /// The output of a line.
    Line {
        /// The output as received, without echo and prompt.
        text: String,
        /// `true` if the output reports an error.
        failed: bool,
        /// `true` if the flight controller restarts, which makes everything known about it outdated.
        restarted: bool,
    },
    NotAnswered(Unanswered),
}

/// The reason for a missing answer. `Display` gives a part of a sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display)]
pub enum Unanswered {
    /// There is no connection, or it was lost meanwhile.
    #[strum(to_string = "there is no connection to the flight controller")]
    LinkLost,
    /// No answer in time.
    #[strum(to_string = "the flight controller does not answer")]
    Silent,
    /// The command line does not open: the craft is armed, or the firmware has no framed one.
    #[strum(to_string = "the flight controller does not open its command line")]
    CliClosed,
    /// The interactive command line is open, which suspends MSP.
    #[strum(
        to_string = "the flight controller's command line is open: leave it with `exit`, which restarts it"
    )]
    InCli,
    /// Too many requests are waiting.
    #[strum(to_string = "too many requests wait for the flight controller")]
    TooMany,
}

/// The way in which lines reach the command line of a disarmed craft.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CliAccess {
    /// Each line between STX and ETX, with MSP before and after it.
    #[default]
    Framed,
    /// At the prompt that `#` opens, for releases without framing. MSP is suspended until a line restarts the
    /// flight controller.
    Interactive,
}
