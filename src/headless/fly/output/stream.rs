//! An output that is written during the flight.

use std::io::{BufWriter, Write};

use crate::args::OutputFile;
use crate::files::output_file::{StreamedOutput, write_failed};
use crate::process::error::AppError;
use crate::process::patient_output::PatientOutput;

/// Standard output or a file.
pub(super) enum Stream {
    Stdout(BufWriter<PatientOutput<std::io::Stdout>>),
    File(StreamedOutput),
}

impl Stream {
    /// Returns standard output.
    pub(super) fn stdout() -> Self {
        Self::Stdout(BufWriter::new(PatientOutput(std::io::stdout())))
    }

    /// Opens the output of an option.
    ///
    /// # Errors
    /// Returns the reason why the file cannot be written.
    pub(super) fn open(output: &OutputFile) -> Result<Self, AppError> {
        match output {
            OutputFile::Stdout => Ok(Self::stdout()),
            OutputFile::File(path) => Ok(Self::File(StreamedOutput::begin(path)?)),
        }
    }

    /// Gives a file its name.
    ///
    /// # Errors
    /// Returns the reason why the file cannot be written.
    pub(super) fn finish(self) -> Result<(), AppError> {
        match self {
            Self::Stdout(_) => Ok(()),
            Self::File(file) => file.finish(),
        }
    }
}

impl Write for Stream {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        match self {
            Self::Stdout(lines) => lines.write(bytes),
            Self::File(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> std::io::Result<()> {
        match self {
            Self::Stdout(lines) => lines.flush(),
            Self::File(file) => file.flush(),
        }
    }
}

/// Returns the value of a write. If the reader went away, there is none: the flight continues and keeps its exit code.
///
/// # Errors
/// Returns any other error of the output.
pub(super) fn if_read<T>(written: std::io::Result<T>) -> Result<Option<T>, AppError> {
    match written {
        Ok(value) => Ok(Some(value)),
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(None),
        Err(error) => Err(write_failed(error)),
    }
}
