//! The samples of a flight as CSV.

use crate::args::FlyArgs;
use crate::headless::fly::output::pace::Pace;
use crate::headless::fly::output::stream::{Stream, if_read};
use crate::headless::fly::watched::WatchedFlight;
use crate::process::error::AppError;
use crate::report::CsvWriter;
use crate::runner::Flying as _;
use crate::telemetry::signal::Observed;

/// Rows a second, if the user asks for no other number.
const USUAL_HZ: f64 = 10.0;

/// The output for the rows.
pub(super) struct Table {
    /// `None` after the reader went away.
    rows: Option<CsvWriter<Stream>>,
    pace: Pace,
}

impl Table {
    /// Opens the table of the options, if there is one, and writes its header.
    ///
    /// # Errors
    /// Returns the error of the output.
    pub(super) fn open(args: &FlyArgs) -> Result<Option<Self>, AppError> {
        let Some(output) = &args.csv else { return Ok(None) };
        let rows = if_read(CsvWriter::new(Stream::open(output)?))?;
        let hz = args.samples.filter(|hz| *hz > 0.0).unwrap_or(USUAL_HZ);
        Ok(Some(Self { rows, pace: Pace::from_hz(hz) }))
    }

    /// Writes a row if one is due.
    ///
    /// # Errors
    /// Returns the error of the output.
    pub(super) fn sample(&mut self, flight: &WatchedFlight) -> Result<(), AppError> {
        let Some(rows) = self.rows.as_mut().filter(|_| self.pace.is_due(flight.vehicle())) else {
            return Ok(());
        };
        let snapshot = flight.vehicle().snapshot();
        let observed = Observed { engaged_at: flight.flight().engaged_at(), ..Observed::of(&snapshot) };
        let written = rows.row(&observed);
        self.keep(written)
    }

    /// Passes the rows on to the reader.
    ///
    /// # Errors
    /// Returns the error of the output.
    pub(super) fn flush(&mut self) -> Result<(), AppError> {
        let Some(rows) = &mut self.rows else { return Ok(()) };
        let written = rows.flush();
        self.keep(written)
    }

    fn keep(&mut self, written: std::io::Result<()>) -> Result<(), AppError> {
        if if_read(written)?.is_none() {
            self.rows = None;
        }
        Ok(())
    }

    /// Gives a file its name.
    ///
    /// # Errors
    /// Returns the error of the output.
    pub(super) fn finish(mut self) -> Result<(), AppError> {
        self.flush()?;
        let Some(rows) = self.rows else { return Ok(()) };
        if_read(rows.finish())?.map_or(Ok(()), Stream::finish)
    }
}
