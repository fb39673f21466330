//! Writes a blackbox log as files: its values as a table, its places as a track, a page about its flight.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::outputs;
use super::report::Report;
use crate::app::error::{self, AppError};
use crate::app::log_source::FileSource;
use crate::args::ReplayArgs;
use crate::flight_log::LogFlight;
use crate::replay::{LogFlights, PastFlights as _, log_notices};
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
    for notice in log_notices(&log) {
        error::tell(&notice);
    }
    let has_track = args.gpx.is_some() || args.kml.is_some();
    if has_track && log.track().is_empty() {
        let why = if log.counts().gps > 0 { "no place with a fix and a home" } else { "no GPS" };
        return Err(AppError::input(format!("{name} has {why}, so there is no track to write")));
    }
    if let Some(output) = &args.csv {
        let (source, every_us) = (logs.source().clone(), args.row_every_us());
        let write =
            |out: &mut dyn std::io::Write| write_csv(&log, source, every_us, out, is_stopped).map(drop);
        if !outputs::table(output, stop, write)? {
            return Ok(false);
        }
    }
    if let Some(path) = &args.gpx {
        outputs::file(path, |out| log_gpx(&log, &name, out).map(drop))?;
    }
    if let Some(path) = &args.kml {
        outputs::file(path, |out| out.write_all(log_track(&log, &name).kml().as_bytes()))?;
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

/// Returns the log of the options, or the first that can be shown, with its number from zero.
fn chosen(args: &ReplayArgs, logs: &LogFlights<FileSource>) -> Result<(usize, Arc<LogFlight>), AppError> {
    let numbered = |number| logs.log(number).map(|log| (number, log));
    if let Some(number) = args.number() {
        return numbered(number).map_err(AppError::input);
    }
    let first = (0..logs.count()).map(numbered).find_map(Result::ok);
    first.map_or_else(|| numbered(0), Ok).map_err(AppError::input)
}
