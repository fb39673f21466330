//! Sentences about a log as a whole.

use crate::flight_log::{LogEnd, LogFlight};
use crate::replay::PastEventKind;

/// Returns sentences about a log: who wrote it, and what is missing or damaged.
pub(super) fn of(log: &LogFlight) -> Vec<PastEventKind> {
    let header = log.header();
    let value = |name: &str| header.value(name).filter(|value| !value.is_empty());
    let main = log.counts().main;
    let firmware = value("Firmware revision").unwrap_or("unknown");
    let craft = value("Craft name").map_or_else(String::new, |name| format!(", craft {name}"));
    let date = date(log).map_or_else(String::new, |date| format!(", {date}"));
    let frames = if main == 1 { "frame" } else { "frames" };
    let written = format!("Written by {firmware}{craft}{date}: {main} main {frames}.");
    let mut about = vec![PastEventKind::Notice(written)];
    if log.track().is_empty() {
        let why = if log.counts().gps > 0 { "no place with a fix and a home" } else { "no GPS" };
        about.push(PastEventKind::Notice(format!("The log has {why}: the map shows no track.")));
    }
    about.extend(log_assumptions(log).into_iter().chain(log_damage(log.end())).map(PastEventKind::Warning));
    about.extend(log_cut(log.end()).map(PastEventKind::Notice));
    about
}

/// Returns sentences about what was found once a log was read to its end: what is damaged, whether its end is missing.
pub fn log_end_notices(end: LogEnd) -> impl Iterator<Item = String> {
    log_damage(end).into_iter().chain(log_cut(end))
}

/// Returns sentences about the lines that the header lacks, about those that are damaged, and about the values that rest on
/// what is assumed instead.
pub fn log_assumptions(log: &LogFlight) -> Vec<String> {
    let mut all: Vec<String> = log.findings().iter().map(ToString::to_string).collect();
    let mut names: Vec<&str> = Vec::new();
    for signal in log.signals().iter().filter(|signal| signal.is_assumed) {
        let name = signal.name.split('[').next().unwrap_or_default();
        if !names.contains(&name) {
            names.push(name);
        }
    }
    if !names.is_empty() {
        all.push(format!("These values rest on what is assumed: {}.", names.join(", ")));
    }
    all
}

/// Returns a sentence with the number of the damaged bytes and frames of a log, if it has any.
fn log_damage(end: LogEnd) -> Option<String> {
    let counts = end.counts;
    if counts.skipped_bytes == 0 && counts.skipped_frames == 0 {
        return None;
    }
    let lost = match counts.skipped_frames {
        0 => String::new(),
        1 => ", and a frame after them cannot be used".to_owned(),
        frames => format!(", and {frames} frames after them cannot be used"),
    };
    Some(format!("The log is damaged: {} bytes belong to no frame{lost}.", counts.skipped_bytes))
}

/// Returns a sentence about the missing end of a log, if it was cut.
fn log_cut(end: LogEnd) -> Option<String> {
    if end.is_complete {
        return None;
    }
    Some(match end.cut_bytes {
        // A log of a flight that was left in the air looks the same as one that lost its power.
        0 => "The log has no end: the flight went on, or the power was lost.".to_owned(),
        bytes => format!("The log was cut: it has no end; its last {bytes} bytes are no whole frame."),
    })
}

/// Returns the date of a log. A craft without a clock writes the year 0000.
fn date(log: &LogFlight) -> Option<&str> {
    log.header().value("Log start datetime").filter(|date| !date.is_empty() && !date.starts_with("0000"))
}
