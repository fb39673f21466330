//! Samples of a flight as CSV: one row a sample, the signals by name with their units in the header.

mod column;

use std::io::{self, Write};

use crate::telemetry::signal::Observed;
use column::Column;

/// Writes a header and one row a sample. A value that is not known is an empty cell.
#[derive(Debug)]
pub struct CsvWriter<W: Write> {
    columns: Vec<Column>,
    rows: csv::Writer<W>,
}

impl<W: Write> CsvWriter<W> {
    /// Writes the header.
    ///
    /// # Errors
    ///
    /// Returns the error of the output.
    pub fn new(out: W) -> io::Result<Self> {
        let columns = column::all();
        let mut rows = csv::Writer::from_writer(out);
        rows.write_record(columns.iter().map(Column::header)).map_err(output_error)?;
        Ok(Self { columns, rows })
    }

    /// Writes the row of a sample.
    ///
    /// # Errors
    ///
    /// Returns the error of the output.
    pub fn row(&mut self, observed: &Observed<'_>) -> io::Result<()> {
        self.rows.write_record(self.columns.iter().map(|column| column.cell(observed))).map_err(output_error)
    }

    /// Writes the rows that are still in memory.
    ///
    /// # Errors
    ///
    /// Returns the error of the output.
    pub fn flush(&mut self) -> io::Result<()> {
        self.rows.flush()
    }

    /// Writes the rows that are still in memory, and returns the output.
    ///
    /// # Errors
    ///
    /// Returns the error of the output.
    pub fn finish(self) -> io::Result<W> {
        self.rows.into_inner().map_err(csv::IntoInnerError::into_error)
    }
}

/// Returns the error of the output in an error of the table, which otherwise hides its kind and its source.
fn output_error(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        kind => io::Error::other(format!("{kind:?}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signals::SimTime;
    use crate::telemetry::snapshot::{BatteryView, EstimateView, Snapshot, TruthView};
    use crate::telemetry::{NavState, NavTelemetry};

    /// Returns the header and one row, as pairs.
    fn pairs(snapshot: &Snapshot, engaged_at: Option<SimTime>) -> Vec<(String, String)> {
        let mut writer = CsvWriter::new(Vec::new()).unwrap();
        writer.row(&Observed { engaged_at, ..Observed::of(snapshot) }).unwrap();
        let text = writer.finish().unwrap();
        let mut rows = csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_slice());
        let rows: Vec<csv::StringRecord> = rows.records().map(Result::unwrap).collect();
        assert_eq!(rows.len(), 2);
        rows[0].iter().zip(&rows[1]).map(|(name, cell)| (name.to_owned(), cell.to_owned())).collect()
    }

    #[test]
    fn truth_stands_beside_its_estimate_and_units_are_in_the_header() {
        insta::assert_snapshot!(
            pairs(&Snapshot::default(), None)
                .into_iter()
                .map(|(name, _)| name)
                .collect::<Vec<_>>()
                .join("\n")
        );
    }

    #[test]
    fn unknown_values_are_empty_cells() {
        let pairs = pairs(&Snapshot { time: SimTime(1_500), ..Snapshot::default() }, None);
        let known: Vec<&(String, String)> = pairs.iter().filter(|(_, cell)| !cell.is_empty()).collect();
        assert_eq!(known, [&("boot_time (s)".to_owned(), "0.002".to_owned())]);
    }

    #[test]
    fn cells_have_the_unit_of_their_header() {
        let battery = BatteryView { drawn_mah: 120.5, capacity_mah: 1500.0, ..BatteryView::default() };
        let truth = TruthView {
            lat_deg: 40.123_456_789_12,
            n: 1.0 / 3.0,
            vu: -0.000_1,
            battery: Some(battery),
            ..TruthView::default()
        };
        let nav = NavTelemetry { engaged: true, state: NavState::Landing, wp: 3, ..NavTelemetry::idle() };
        let snapshot = Snapshot {
            time: SimTime(12_250_000),
            truth: Some(truth),
            estimate: EstimateView { n: Some(0.5), ..EstimateView::default() },
            nav: Some(nav),
            ..Snapshot::default()
        };
        let pairs = pairs(&snapshot, Some(SimTime(2_000_000)));
        for (name, expected) in [
            ("time (s)", "10.25"),
            ("boot_time (s)", "12.25"),
            ("state", "LANDING"),
            ("waypoint", "3"),
            ("lat (deg)", "40.12345679"),
            ("north (m)", "0.333"),
            ("est_north (m)", "0.5"),
            ("climb (m/s)", "0"),
            ("charge (mAh)", "120.5"),
            ("battery_used", "0.08033"),
        ] {
            let cell = pairs.iter().find(|(header, _)| header == name).map(|(_, cell)| cell.as_str());
            assert_eq!(cell, Some(expected), "{name}");
        }
    }
}
