//! The files of the options: which may be written, and how.

use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::args::{OutputFile, ReplayArgs};
use crate::files::output_file::{KeptFiles, StreamedOutput, write_failed};
use crate::process::error::AppError;
use crate::process::patient_output::PatientOutput;

/// Checks that no output replaces a file that is read.
pub(super) fn claim(args: &ReplayArgs) -> Result<(), AppError> {
    let mut kept = KeptFiles::default();
    args.files.iter().for_each(|file| kept.keep("the recorded flight", file));
    args.backdrop.iter().for_each(|file| kept.keep("--backdrop", file));
    let table = match &args.csv {
        Some(OutputFile::File(path)) => Some(path.as_path()),
        Some(OutputFile::Stdout) | None => None,
    };
    let outputs = [("--gpx", &args.gpx), ("--kml", &args.kml), ("--report", &args.report)];
    let outputs = outputs.into_iter().map(|(option, path)| (option, path.as_deref()));
    std::iter::once(("--csv", table))
        .chain(outputs)
        .filter_map(|(option, path): (_, Option<&Path>)| Some((option, path?)))
        .try_for_each(|(option, path)| kept.claim(option, path))
}

/// Writes a table. Returns `false` if the user ended it; then no file is written.
///
/// # Errors
/// Returns a sentence if `write` fails or the output cannot be written.
pub(super) fn table(
    output: &OutputFile,
    stop: &AtomicBool,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<bool, AppError> {
    match output {
        OutputFile::Stdout => {
            let mut out = BufWriter::new(PatientOutput(io::stdout()));
            match write(&mut out).and_then(|()| out.flush()) {
                // The reader of the pipe has what it wanted.
                Err(error) if error.kind() != ErrorKind::BrokenPipe => {
                    return Err(write_failed(error));
                }
                Ok(()) | Err(_) => {}
            }
        }
        OutputFile::File(path) => {
            let mut out = StreamedOutput::begin(path)?;
            write(&mut out).map_err(write_failed)?;
            if stop.load(Ordering::Relaxed) {
                return Ok(false);
            }
            out.finish()?;
        }
    }
    Ok(!stop.load(Ordering::Relaxed))
}

/// Writes a whole file.
///
/// # Errors
/// Returns a sentence if `write` fails or the file cannot be written.
pub(super) fn file(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), AppError> {
    let mut out = StreamedOutput::begin(path)?;
    write(&mut out).map_err(write_failed)?;
    out.finish()
}
