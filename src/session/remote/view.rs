//! What is shown and told of a flight controller outside.

use std::fmt;

use super::Access;

/// How far a flight controller is known.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RemoteState {
    /// Its program starts, or no connection was made yet.
    Connecting,
    /// It is asked what it is and how it is set.
    Identifying,
    /// It answers and tells.
    Ready,
    /// The connection is gone; another is made by itself.
    Lost,
    /// It is of no use: why, as a sentence. Nothing follows.
    Unusable(String),
}

/// What a screen shows of a remote flight controller.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RemoteView {
    /// What it is called: a file, or where it is.
    pub name: String,
    /// How far it is known.
    pub state: RemoteState,
    /// What may be done with it.
    pub access: Access,
    /// It holds and flies plans, as far as it has told.
    pub has_plans: bool,
    /// Its command line has no framing: a line opens it, and it stays open.
    pub opens_cli: bool,
    /// Its command line is open, and telemetry rests.
    pub in_cli: bool,
    /// The number of the present connection: a permission is for one.
    pub connection: u32,
}

/// What is told of a remote flight controller. `Display` gives a sentence.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RemoteNotice {
    /// A line that its program printed.
    Output(String),
    Told(String),
    /// It does not speak any more, or not as it should: a sentence.
    Lost(String),
    /// It started anew, so that what was set and not stored is gone: a sentence.
    Restarted(String),
    /// It is of no use: a sentence.
    Failed(String),
}

impl fmt::Display for RemoteNotice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Output(line) => write!(f, "[firmware] {line}"),
            Self::Told(sentence)
            | Self::Lost(sentence)
            | Self::Restarted(sentence)
            | Self::Failed(sentence) => f.write_str(sentence),
        }
    }
}
