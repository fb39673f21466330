//! The options for the library of recorded flights.

use std::path::PathBuf;

/// The bound of the library, MB.
const RECORDINGS_MAX_MB: u32 = 200;

/// The options of a screen that records its flights.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::Args)]
pub struct RecordingArgs {
    /// Size of the library of recorded flights, MB; the oldest are removed beyond it, and 0 records none [default: 200]
    #[arg(long, value_name = "MB", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(..=1_000_000), help_heading = "Output")]
    pub recordings_max_mb: Option<u32>,
}

impl RecordingArgs {
    /// Returns the bound of the library, bytes; 0 = no library.
    pub fn most_bytes(self) -> u64 {
        u64::from(self.recordings_max_mb.unwrap_or(RECORDINGS_MAX_MB)) << 20
    }
}

/// The options of `flights`.
#[derive(Debug, Clone, PartialEq, Eq, clap::Args)]
pub struct FlightsArgs {
    /// Prints a JSON object a line
    #[arg(long)]
    pub json: bool,

    /// State directory [default: the one of the user]
    #[arg(long, value_name = "DIR")]
    pub state_dir: Option<PathBuf>,
}
