//! Opens a file by its contents.

use std::io::BufReader;
use std::path::Path;

use super::shown_name;
use crate::blackbox::FIRST_LINE;
use crate::blackbox::decode::LogSource as _;
use crate::files::input_file;
use crate::files::log_source::{FileSource, has_log};
use crate::files::recording_file::GZIP;
use crate::files::telemetry_log;
use crate::process::error::AppError;
use crate::recording::{Setup, read_setup};
use crate::replay::{LogFlights, PastFlights, RecordedFlights};

/// The first bytes of a file in which a log must begin.
const LOOKED_AT: usize = 1 << 20;

/// A file of recorded flights.
pub(super) enum Opened {
    /// Blackbox logs.
    Logs(LogFlights<FileSource>),
    /// A recording of this program.
    Recording(RecordedFlights<FileSource>),
}

impl From<Opened> for Box<dyn PastFlights> {
    fn from(opened: Opened) -> Self {
        match opened {
            Opened::Logs(logs) => Box::new(logs),
            Opened::Recording(recording) => Box::new(recording),
        }
    }
}

/// Opens the flights of a file.
///
/// # Errors
/// Returns a sentence if the file cannot be opened, or if it has no flight.
pub(super) fn open(path: &Path) -> Result<Opened, AppError> {
    let (file, size) = input_file::open_log(path)?;
    let name = shown_name(path);
    let mut source = FileSource::new(file, size);
    let head =
        head(&mut source).map_err(|error| AppError::environment(format!("cannot read {name}: {error}")))?;
    if head.starts_with(&GZIP) {
        return Ok(Opened::Recording(RecordedFlights::new(&name, source)));
    }
    if telemetry_log::is_log(&head) {
        let recording = telemetry_log::recording(&name, &mut source)
            .map_err(|error| AppError::environment(format!("cannot read {name}: {error}")))?;
        return Ok(Opened::Recording(RecordedFlights::new(&name, recording)));
    }
    if has_log(&head) || size > LOOKED_AT as u64 {
        return Ok(Opened::Logs(LogFlights::new(&name, source)));
    }
    Err(AppError::input(format!(
        "{name} is no recorded flight: a blackbox log begins with the line `{FIRST_LINE}`, a recording is a file of \
         `betadeck fly --record`, and a telemetry log (.tlog) is one of a MAVLink ground station"
    )))
}

/// Returns the start of the flight of a recording, with its plan and settings; `None` if the file is none or has none.
pub(super) fn setup(path: &Path) -> Option<Setup> {
    let (file, _) = input_file::open_log(path).ok()?;
    read_setup(BufReader::new(file))
}

/// Returns the first bytes of a file.
fn head(source: &mut FileSource) -> std::io::Result<Vec<u8>> {
    let mut head = vec![0; LOOKED_AT];
    let mut length = 0;
    loop {
        match source.read_at(length as u64, &mut head[length..])? {
            0 => break,
            count => length += count,
        }
    }
    head.truncate(length);
    Ok(head)
}
