//! The view of a remote flight controller and the notices about it.

use std::fmt;

use super::Access;

/// The state of the link to a flight controller.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RemoteState {
    /// Its program is starting, or no connection was made yet.
    Connecting,
    /// Its identity and settings are being read.
    Identifying,
    /// It answers, and telemetry arrives.
    Ready,
    /// The connection is lost. Another one is made automatically.
    Lost,
    /// It cannot be used, with the reason as a sentence. A real flight controller is still asked for its
    /// API version, and is identified again once it answers.
    Unusable(String),
}

/// The state of a remote flight controller for the display.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RemoteView {
    /// The name: a file, or the address.
    pub name: String,
    /// The state of the link.
    pub state: RemoteState,
    /// The permitted access.
    pub access: Access,
    /// `true` if it is known to store and fly plans.
    pub has_plans: bool,
    /// `true` if the settings of its autopilot are known, with which estimates fly.
    pub knows_settings: bool,
    /// `true` if its command line has no framing: a line opens it, and it stays open.
    pub opens_cli: bool,
    /// `true` while its command line is open, which suspends telemetry.
    pub in_cli: bool,
    /// The number of the current connection. A permission applies to one connection.
    pub connection: u32,
    /// `true` if it runs in simulated time, so that time can be paused and made faster.
    pub is_in_steps: bool,
}

/// A notice about a remote flight controller. `Display` gives a sentence.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RemoteNotice {
    /// A line that its program printed.
    Output(String),
    Reported(String),
    /// It no longer answers, or does not answer correctly, as a sentence.
    Lost(String),
    /// It has restarted and lost unsaved settings, as a sentence.
    Restarted(String),
    /// It cannot be used, as a sentence.
    Failed(String),
}

impl fmt::Display for RemoteNotice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Output(line) => write!(f, "[firmware] {line}"),
            Self::Reported(sentence)
            | Self::Lost(sentence)
            | Self::Restarted(sentence)
            | Self::Failed(sentence) => f.write_str(sentence),
        }
    }
}
