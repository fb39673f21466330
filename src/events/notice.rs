//! Notices for the user: sentences of the session with their severity, and notices about a recorded flight and about an
//! external simulator.

use std::fmt;

use crate::link::proto::fdm::PacketError;
use crate::link::proto::fdm_link::FdmNotice;

/// A sentence for the user.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Notice {
    pub text: String,
    pub is_warning: bool,
}

impl Notice {
    /// Returns a notice about something that went wrong or will.
    pub fn warning(text: String) -> Self {
        Self { text, is_warning: true }
    }
}

impl From<String> for Notice {
    fn from(text: String) -> Self {
        Self { text, is_warning: false }
    }
}

impl From<&str> for Notice {
    fn from(text: &str) -> Self {
        text.to_owned().into()
    }
}

/// A notice about the recorded flight that is shown. `Display` gives the sentence.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ReplayNotice {
    /// This flight is shown from now on. Events of flights before it no longer matter.
    Begins(String),
    /// A part of the record is damaged.
    Warning(String),
    /// The record cannot be read any more, or another flight of the file cannot be read.
    Failed(String),
}

impl fmt::Display for ReplayNotice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Begins(text) | Self::Warning(text) | Self::Failed(text) => f.write_str(text),
        }
    }
}

/// A notice about the external simulator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SimulatorNotice {
    /// The first packet was accepted.
    Connected,
    /// A packet was accepted after a silence.
    Resumed {
        /// The wall time without an accepted packet, s.
        silence_s: f64,
    },
    /// It has stopped sending.
    Silent,
    /// Packets are refused for this reason. Reported once for each reason.
    Refused(PacketError),
    /// The link has adapted to the packets.
    Adapted(FdmNotice),
}

impl fmt::Display for SimulatorNotice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Connected => f.write_str("The simulator sends: the craft now follows its time."),
            Self::Resumed { silence_s } => {
                write!(f, "The simulator sends again after {silence_s:.1} s of silence.")
            }
            Self::Silent => f.write_str("The simulator is silent: time is stopped until it sends again."),
            Self::Refused(refusal) => write!(f, "Packets of the simulator are refused: {refusal}."),
            Self::Adapted(notice) => f.write_str(&sentence(&notice.to_string())),
        }
    }
}

/// Formats a notice of the link as a sentence.
fn sentence(notice: &str) -> String {
    let mut letters = notice.chars();
    letters.next().map_or_else(String::new, |first| format!("{}{}.", first.to_uppercase(), letters.as_str()))
}
