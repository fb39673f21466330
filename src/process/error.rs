//! Errors of the program: a sentence for a person and an exit code for a script.

use std::io::Write as _;

use crate::process::patient_output::PatientOutput;
use crate::text::printable;

/// Exit code: an expectation was not met.
pub(crate) const FAILED: u8 = 1;
/// Exit code: wrong usage or invalid input.
pub(crate) const USAGE: u8 = 2;
/// Exit code: a file, a port or the terminal.
pub(crate) const ENVIRONMENT: u8 = 3;
/// Exit code: a defect of this program.
pub(crate) const INTERNAL: u8 = 4;
/// Exit code: stopped by the user.
pub(crate) const INTERRUPTED: u8 = 130;

/// The reason why the program ends early.
#[derive(Debug, thiserror::Error)]
#[error("{message}")]
pub struct AppError {
    pub code: u8,
    /// The problem, its place and a suggestion.
    pub message: String,
}

impl AppError {
    pub fn input(message: impl Into<String>) -> Self {
        Self { code: USAGE, message: message.into() }
    }

    /// Returns an error about a file, a port or the terminal.
    pub fn environment(message: impl Into<String>) -> Self {
        Self { code: ENVIRONMENT, message: message.into() }
    }

    /// Returns an error for a defect of this program.
    pub fn internal(error: impl std::fmt::Display) -> Self {
        Self { code: INTERNAL, message: format!("internal error: {error}; please report it") }
    }
}

/// Prints lines on standard error. A missing reader (`2>&1 | head`) is not an error.
pub(crate) fn tell(text: &str) {
    // One write, so that lines of several threads are not mixed.
    let text = format!("{}\n", printable::lines(text));
    PatientOutput(std::io::stderr()).write_all(text.as_bytes()).ok();
}

/// Writes a JSON object as a line, unshortened, to standard error.
pub(crate) fn tell_json(json: &str) {
    let line = format!("{}\n", printable::json(json));
    PatientOutput(std::io::stderr()).write_all(line.as_bytes()).ok();
}

/// Prints text for people on standard output, without control sequences for the terminal.
pub(crate) fn print(text: &str) -> Result<u8, AppError> {
    write_stdout(printable::lines(text).as_bytes())
}

/// Writes a result unchanged to standard output. A reader that went away (`| head`) is not an error.
pub(crate) fn write_stdout(text: &[u8]) -> Result<u8, AppError> {
    match PatientOutput(std::io::stdout()).write_all(text) {
        Ok(()) => Ok(0),
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(0),
        Err(error) => Err(AppError::environment(format!("cannot write to standard output: {error}"))),
    }
}
