//! The reasons why a file is not read.

use std::io;

use super::record::{FORMAT, Header};

/// The reason why a file is not shown as a recording.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    #[error("it is not a recording of a flight: one begins with a gzip member and the line {{\"flight\":…}}")]
    NoRecording,
    #[error("a later version of betadeck wrote it (format {0}, this one reads {FORMAT})")]
    LaterFormat(u32),
    #[error("it has neither pictures nor the inputs to fly it again")]
    Empty,
    #[error(transparent)]
    Source(#[from] io::Error),
}

impl Header {
    pub(super) fn check(&self) -> Result<(), ReadError> {
        if self.format > FORMAT { Err(ReadError::LaterFormat(self.format)) } else { Ok(()) }
    }
}
