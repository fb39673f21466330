//! Writes a blackbox log as files: its values as a table, its places as a track, a page about its flight.

use std::io::{self, BufWriter, ErrorKind, Write as _};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::log_source::FileSource;
use super::report::Report;
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
    repeat: &[String],
    logs: &mut LogFlights<FileSource>,
    stop: &AtomicBool,
) -> Result<bool, AppError> {
    claim(args)?;
    let report = Report::prepare(args, repeat)?;
    let is_stopped = || stop.load(Ordering::Relaxed);
    if !logs.read(&mut |_| !is_stopped()).map_err(AppError::input)? {
        return Ok(false);
    }
    let (number, log) = chosen(args, logs)?;
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
    if let Some(report) = report {
        let past = logs.open(number).map_err(AppError::input)?;
        if is_stopped() {
            return Ok(false);
        }
        let title = if logs.count() > 1 { format!("{name}, log {}", log.number()) } else { name };
        report.write_log(&title, &log, &past.overview())?;
    }
    Ok(!is_stopped())
}

/// Checks that no output replaces a file that is read.
fn claim(args: &ReplayArgs) -> Result<(), AppError> {
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

/// Returns the log of the options, or the first that can be shown, with its number from zero.
fn chosen(args: &ReplayArgs, logs: &LogFlights<FileSource>) -> Result<(usize, Arc<LogFlight>), AppError> {
    let numbered = |number| logs.log(number).map(|log| (number, log));
    if let Some(number) = args.number() {
        return numbered(number).map_err(AppError::input);
    }
    let first = (0..logs.count()).map(numbered).find_map(Result::ok);
    first.map_or_else(|| numbered(0), Ok).map_err(AppError::input)
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
