//! What a flight controller is asked, and what comes of it.

/// Names a request until its answer; chosen by whoever asks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct AskId(pub u64);

/// What a flight controller is asked.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Ask {
    Msp {
        code: u16,
        payload: Vec<u8>,
    },
    /// A line of the command line, in the way of [`CliAccess`]; by MSP message while the command line does not open.
    Line(String),
    /// A line of the command line by MSP message alone, which works in flight and disturbs nothing.
    MessageLine(String),
}

/// What came of a request.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Answer {
    /// The payload of the reply; `None` when the message is unknown or refused.
    Msp(Option<Vec<u8>>),
    /// The output of a line.
    Line {
        /// As it came, without echo and prompt.
        text: String,
        /// Whether it tells of an error.
        failed: bool,
        /// Whether the flight controller restarts, so that what was known of it is old.
        restarted: bool,
    },
    NotAnswered(Unanswered),
}

/// Why there is no answer. `Display` is a part of a sentence.
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
    /// The interactive command line is open, and MSP rests.
    #[strum(
        to_string = "the flight controller's command line is open: leave it by `exit`, which restarts it"
    )]
    InCli,
    /// Too many requests wait.
    #[strum(to_string = "too many requests wait for the flight controller")]
    TooMany,
}

/// How lines reach the command line of a disarmed craft.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CliAccess {
    /// Each between STX and ETX, MSP before and after it.
    #[default]
    Framed,
    /// At the prompt that `#` opens, for releases without framing: MSP rests until a line restarts the flight controller.
    Interactive,
}
