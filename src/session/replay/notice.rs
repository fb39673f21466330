//! Notices about a recorded flight.

use std::fmt;

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
