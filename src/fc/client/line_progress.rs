//! The progress of a command line that was sent.

use std::time::Duration;

/// The longest time for a line with all of its output, even if the output comes steadily.
pub(super) const LONGEST: Duration = Duration::from_secs(60);

/// The progress of a line.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum LineProgress {
    /// Its answer is still to come.
    Waiting,
    Answered {
        text: String,
        /// `true` if the prompt stays open.
        open: bool,
    },
    /// The line is done, and the flight controller reports that it restarts.
    Restarting { text: String },
    /// The output stopped before its end.
    Silent,
    /// The command line did not open; the line was not sent.
    NotOpened,
}
