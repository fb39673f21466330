//! Writes a blackbox log as files: its values as a table, its places as a track, a page about its flight.

use std::sync::atomic::{AtomicBool, Ordering};

use super::outputs;
use super::report::Report;
use crate::args::ReplayArgs;
use crate::files::log_source::FileSource;
use crate::flight_log::LogFlight;
use crate::process::error;
use crate::process::error::AppError;
use crate::replay::{LogFlights, PastFlights as _, log_assumptions, log_end_notices};
use crate::report::log_export::{TableEnd, log_gpx, log_track, write_csv};

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
    // A table alone needs no index of the file.
    let needs_index = args.gpx.is_some() || args.kml.is_some() || report.is_some();
    if needs_index && !logs.read(&mut |_| !is_stopped()).map_err(AppError::input)? {
        return Ok(false);
    }
    let number = args.number();
    let log = if needs_index { logs.chosen(number).map(Some) } else { logs.start(number, is_stopped) };
    let Some(log) = log.map_err(AppError::input)? else { return Ok(false) };
    let name = logs.name().to_owned();
    log_assumptions(&log).iter().for_each(|notice| error::tell(notice));
    let has_track = args.gpx.is_some() || args.kml.is_some();
    if has_track && log.track().is_empty() {
        let why = if log.counts().gps > 0 { "no place with a fix and a home" } else { "no GPS" };
        return Err(AppError::input(format!("{name} has {why}, so there is no track to write")));
    }
    if let Some(output) = &args.csv {
        let (source, every_us) = (logs.source().clone(), args.row_every_us());
        let mut end = None;
        let write = |out: &mut dyn std::io::Write| {
            end = Some(write_csv(&log, source, every_us, out, is_stopped)?);
            Ok(())
        };
        if !outputs::table(output, stop, write)? {
            return Ok(false);
        }
        // A reader that had enough leaves the end unknown.
        end.into_iter().for_each(|end| tell_end(&name, &log, end, number.is_none()));
    } else {
        let logs_after = logs.count().saturating_sub(log.number());
        tell_end(&name, &log, TableEnd { log: log.end(), logs_after }, number.is_none());
    }
    if let Some(path) = &args.gpx {
        outputs::file(path, |out| log_gpx(&log, &name, out).map(drop))?;
    }
    if let Some(path) = &args.kml {
        outputs::file(path, |out| out.write_all(log_track(&log, &name).kml().as_bytes()))?;
    }
    if let Some(report) = report {
        let past = logs.open(log.number() - 1).map_err(AppError::input)?;
        if is_stopped() {
            return Ok(false);
        }
        let title = if logs.count() > 1 { format!("{name}, log {}", log.number()) } else { name };
        report.write_log(&title, &log, &past.overview())?;
    }
    Ok(!is_stopped())
}

/// Tells what was found in a file that was read to its end.
fn tell_end(name: &str, log: &LogFlight, end: TableEnd, is_first: bool) {
    let (number, count) = (log.number(), log.number() + end.logs_after);
    if is_first && count > 1 {
        error::tell(&format!(
            "{name} has {count} logs: log {number} is written; --log N chooses another one"
        ));
    }
    log_end_notices(end.log).for_each(|notice| error::tell(&notice));
}
