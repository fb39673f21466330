//! The frames of a log as CSV: one row a main frame, all signals by name with their units in the header.

use std::io::{self, Write};

use super::number;
use crate::blackbox::decode::LogSource;
use crate::flight_log::{BoxFlags, FlightCursor, LogEnd, LogFlight};
use crate::signals::SimTime;

/// The columns before the signals: the time since the first frame, the time on the craft's clock, and the boxes that are on.
const FIRST: [&str; 3] = ["time (s)", "boot_time (s)", "modes"];
/// The most bytes of rows in memory, about.
const MAX_TEXT: usize = 64 * 1024;

/// What is known of a file after the table of a log is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TableEnd {
    pub log: LogEnd,
    /// The number of logs after this one, readable or not.
    pub logs_after: usize,
}

/// Writes a header and one row a frame. A value that is not known is an empty cell.
#[derive(Debug)]
struct LogCsv<W: Write> {
    first: SimTime,
    /// The decimals of each signal.
    decimals: Vec<u8>,
    /// The boxes of the last row, and their cell.
    modes: (Option<BoxFlags>, Vec<u8>),
    text: Vec<u8>,
    out: W,
}

impl<W: Write> LogCsv<W> {
    /// Begins with the header.
    fn new(out: W, flight: &LogFlight) -> io::Result<Self> {
        let signals = flight.signals();
        let names = signals.iter().map(|signal| match (signal.unit, signal.is_assumed) {
            ("", false) => signal.name.clone(),
            ("", true) => format!("{} (assumed)", signal.name),
            (unit, false) => format!("{} ({unit})", signal.name),
            (unit, true) => format!("{} ({unit}, assumed)", signal.name),
        });
        let text = record(FIRST.map(str::to_owned).into_iter().chain(names))?;
        let decimals = signals.iter().map(|signal| signal.decimals).collect();
        Ok(Self { first: flight.first(), decimals, modes: (None, Vec::new()), text, out })
    }

    /// Writes the row of the frame at which a cursor is.
    fn row<S: LogSource>(&mut self, cursor: &FlightCursor<'_, S>) -> io::Result<()> {
        let (time, boxes) = (cursor.time(), cursor.latest().boxes);
        if self.modes.0 != boxes {
            self.modes = (boxes, modes(boxes)?);
        }
        let text = &mut self.text;
        number::append_seconds(text, time.0.saturating_sub(self.first.0));
        text.push(b',');
        number::append_seconds(text, time.0);
        text.push(b',');
        text.extend_from_slice(&self.modes.1);
        for (value, decimals) in cursor.values().zip(&self.decimals) {
            text.push(b',');
            number::append(text, value, *decimals);
        }
        text.push(b'\n');
        if text.len() >= MAX_TEXT { self.flush() } else { Ok(()) }
    }

    /// Writes the rows that are still in memory.
    fn flush(&mut self) -> io::Result<()> {
        self.out.write_all(&self.text)?;
        self.text.clear();
        Ok(())
    }
}

/// Returns a line of cells.
fn record(cells: impl IntoIterator<Item = String>) -> io::Result<Vec<u8>> {
    let mut line = ::csv::Writer::from_writer(Vec::new());
    line.write_record(cells)?;
    line.into_inner().map_err(::csv::IntoInnerError::into_error)
}

/// Returns the cell of boxes.
fn modes(boxes: Option<BoxFlags>) -> io::Result<Vec<u8>> {
    let Some(boxes) = boxes else { return Ok(Vec::new()) };
    // A line with a single empty cell would have quotes.
    let line = record([String::new(), boxes.names().collect::<Vec<_>>().join(" + ")])?;
    Ok(line.trim_ascii().get(1..).unwrap_or_default().to_vec())
}

/// Writes the main frames of a log: all of them, or the first one in each interval of so many microseconds. `is_stopped` is
/// asked before each row, and while later logs are counted.
///
/// # Errors
///
/// Returns the error of the source or of the output.
pub fn write_csv<S: LogSource, W: Write>(
    flight: &LogFlight,
    source: S,
    interval_us: Option<u64>,
    out: W,
    is_stopped: impl Fn() -> bool,
) -> io::Result<TableEnd> {
    let mut table = LogCsv::new(out, flight)?;
    let mut due = flight.first();
    let Some(mut cursor) = flight.cursor(source, due)? else {
        table.flush()?;
        return Ok(TableEnd::default());
    };
    while !is_stopped() {
        if cursor.time() >= due {
            table.row(&cursor)?;
            if let Some(interval_us) = interval_us.filter(|interval_us| *interval_us > 0) {
                let since = cursor.time().0 - flight.first().0;
                due = SimTime(flight.first().0 + (since / interval_us + 1) * interval_us);
            }
        }
        if !cursor.advance()? {
            break;
        }
    }
    table.flush()?;
    Ok(TableEnd { log: cursor.end(), logs_after: cursor.count_logs_after(is_stopped)? })
}
