//! Writes a blackbox log for other programs: its values as a table, its places as a track.

use std::io::{self, BufWriter, ErrorKind, Write as _};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::log_source::FileSource;
use crate::app::error::{self, AppError};
use crate::app::output_file::{KeptFiles, StreamedOutput};
use crate::app::patient_output::PatientOutput;
use crate::args::{OutputFile, ReplayArgs};
use crate::flight_log::LogFlight;
use crate::replay::{LogFlights, PastFlights as _, log_damage};
use crate::report::log_export::{log_gpx, log_track, write_csv};

/// Writes the files of the options from the chosen log. Returns `false` if the user ended it; then no file is written.
///
/// # Errors
/// Returns a sentence if the log cannot be read or a file cannot be written.
pub(super) fn run(
    args: &ReplayArgs,
    logs: &mut LogFlights<FileSource>,
    stop: &AtomicBool,
) -> Result<bool, AppError> {
    claim(args)?;
    let is_stopped = || stop.load(Ordering::Relaxed);
    if !logs.read(&mut |_| !is_stopped()).map_err(AppError::input)? {
        return Ok(false);
    }
    let log = chosen(args, logs)?;
    let name = logs.name().to_owned();
    if args.number().is_none() && logs.count() > 1 {
        error::tell(&format!(
            "{name} has {} logs: log {} is written; --log N chooses another one",
            logs.count(),
            log.number()
        ));
    }
    if let Some(damage) = log_damage(&log) {
        error::tell(&damage);
    }
    let has_track = args.gpx.is_some() || args.kml.is_some();
    if has_track && log.track().is_empty() {
        return Err(AppError::input(format!("{name} has no GPS, so there is no track to write")));
    }
    if let Some(output) = &args.csv {
        let every_us = args.row_every_us();
        match output {
            OutputFile::Stdout => {
                let out = BufWriter::new(PatientOutput(io::stdout()));
                let written = write_csv(&log, logs.source().clone(), every_us, out, is_stopped);
                if_read(written.and_then(|mut out| out.flush()))?;
            }
            OutputFile::File(path) => {
                let out = StreamedOutput::begin(path)?;
                let written = write_csv(&log, logs.source().clone(), every_us, out, is_stopped);
                let out = written.map_err(|error| failed(&error))?;
                if is_stopped() {
                    return Ok(false);
                }
                out.finish()?;
            }
        }
    }
    if let Some(path) = &args.gpx {
        let out = log_gpx(&log, &name, StreamedOutput::begin(path)?);
        out.map_err(|error| failed(&error))?.finish()?;
    }
    if let Some(path) = &args.kml {
        let mut out = StreamedOutput::begin(path)?;
        out.write_all(log_track(&log, &name).kml().as_bytes()).map_err(|error| failed(&error))?;
        out.finish()?;
    }
    Ok(!is_stopped())
}

/// Checks that no output replaces a file that is read.
fn claim(args: &ReplayArgs) -> Result<(), AppError> {
    let mut kept = KeptFiles::default();
    args.files.iter().for_each(|file| kept.keep("the recorded flight", file));
    let table = match &args.csv {
        Some(OutputFile::File(path)) => Some(path.as_path()),
        Some(OutputFile::Stdout) | None => None,
    };
    let outputs = [("--csv", table), ("--gpx", args.gpx.as_deref()), ("--kml", args.kml.as_deref())];
    outputs
        .into_iter()
        .filter_map(|(option, path): (_, Option<&Path>)| Some((option, path?)))
        .try_for_each(|(option, path)| kept.claim(option, path))
}

/// Returns the log of the options, or the first that can be shown.
fn chosen(args: &ReplayArgs, logs: &LogFlights<FileSource>) -> Result<Arc<LogFlight>, AppError> {
    if let Some(number) = args.number() {
        return logs.log(number).map_err(AppError::input);
    }
    let mut all = (0..logs.count()).map(|number| logs.log(number));
    let first = logs.log(0);
    all.find_map(Result::ok).map_or(first, Ok).map_err(AppError::input)
}

/// Returns `Ok` if a write was done or its reader went away.
fn if_read(written: io::Result<()>) -> Result<(), AppError> {
    match written {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(failed(&error)),
        _ => Ok(()),
    }
}

fn failed(error: &io::Error) -> AppError {
    AppError::environment(format!("cannot export the log: {error}"))
}
