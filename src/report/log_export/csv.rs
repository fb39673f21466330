//! The frames of a log as CSV: one row a main frame, all signals by name with their units in the header.

use std::io::{self, Write};

use crate::blackbox::decode::LogSource;
use crate::flight_log::{LogFlight, LogSample, LogSignal};
use crate::signals::SimTime;

/// The columns before the signals: the time since the first frame, the time on the craft's clock, and the boxes that are on.
const FIRST: [&str; 3] = ["time (s)", "boot_time (s)", "modes"];

/// Writes a header and one row a sample. A value that is not known is an empty cell.
#[derive(Debug)]
pub struct LogCsv<W: Write> {
    first: SimTime,
    signals: Vec<LogSignal>,
    rows: ::csv::Writer<W>,
}

impl<W: Write> LogCsv<W> {
    /// Writes the header.
    ///
    /// # Errors
    ///
    /// Returns the error of the output.
    pub fn new(out: W, flight: &LogFlight) -> io::Result<Self> {
        let signals = flight.signals().to_vec();
        let mut rows = ::csv::Writer::from_writer(out);
        let names = signals.iter().map(|signal| match (signal.unit, signal.is_assumed) {
            ("", false) => signal.name.clone(),
            ("", true) => format!("{} (assumed)", signal.name),
            (unit, false) => format!("{} ({unit})", signal.name),
            (unit, true) => format!("{} ({unit}, assumed)", signal.name),
        });
        rows.write_record(FIRST.map(str::to_owned).into_iter().chain(names))?;
        Ok(Self { first: flight.first(), signals, rows })
    }

    /// Writes the row of a sample.
    ///
    /// # Errors
    ///
    /// Returns the error of the output.
    pub fn row(&mut self, sample: &LogSample) -> io::Result<()> {
        let seconds = |time_us: u64| format!("{}.{:06}", time_us / 1_000_000, time_us % 1_000_000);
        let modes =
            sample.boxes.map(|boxes| boxes.names().collect::<Vec<_>>().join(" + ")).unwrap_or_default();
        self.rows.write_field(seconds(sample.time.0 - self.first.0.min(sample.time.0)))?;
        self.rows.write_field(seconds(sample.time.0))?;
        self.rows.write_field(modes)?;
        for (signal, value) in self.signals.iter().zip(&sample.values) {
            self.rows.write_field(cell(*value, signal.decimals))?;
        }
        Ok(self.rows.write_record(None::<&[u8]>)?)
    }

    /// Writes the rows that are still in memory, and returns the output.
    ///
    /// # Errors
    ///
    /// Returns the error of the output.
    pub fn finish(self) -> io::Result<W> {
        self.rows.into_inner().map_err(::csv::IntoInnerError::into_error)
    }
}

/// Writes the main frames of a log: all of them, or the first one in each interval of so many microseconds. `is_stopped` is
/// asked before each row.
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
) -> io::Result<W> {
    let mut table = LogCsv::new(out, flight)?;
    let mut due = flight.first();
    let Some(mut cursor) = flight.cursor(source, due)? else { return table.finish() };
    while !is_stopped() {
        if cursor.time() >= due {
            table.row(&cursor.sample())?;
            if let Some(interval_us) = interval_us.filter(|interval_us| *interval_us > 0) {
                let since = cursor.time().0 - flight.first().0;
                due = SimTime(flight.first().0 + (since / interval_us + 1) * interval_us);
            }
        }
        if !cursor.advance()? {
            break;
        }
    }
    table.finish()
}

/// Returns a number with at most so many decimals; empty for an unknown one.
fn cell(value: f64, decimals: u8) -> String {
    if !value.is_finite() {
        return String::new();
    }
    let text = format!("{value:.*}", usize::from(decimals));
    let short = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if short == "-0" { "0".to_owned() } else { short.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_short_and_without_a_negative_zero() {
        assert_eq!(cell(1.25, 3), "1.25");
        assert_eq!(cell(-0.0001, 3), "0");
        assert_eq!(cell(1200.0, 0), "1200");
        assert_eq!(cell(40.464_000_1, 7), "40.4640001");
        assert_eq!(cell(f64::NAN, 3), "");
    }
}
