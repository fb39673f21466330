//! A stored log as a table and as tracks.

use super::{log_gpx, log_track, write_csv};
use crate::flight_log::{Indexer, LogEnd, LogFlight};
use crate::plan::feature::Shape;
use crate::plan::format::read_features;

/// A log of a second with a GPS, dated 2026-05-01T10:00:00.
const LOG: &[u8] = include_bytes!("../../../tests/corpus/blackbox/a-flight.bbl");

fn flight(bytes: &[u8]) -> LogFlight {
    Indexer::new(bytes).run().unwrap().flights.remove(0)
}

fn written(interval_us: Option<u64>, is_stopped: bool) -> Vec<u8> {
    let mut text = Vec::new();
    write_csv(&flight(LOG), LOG, interval_us, &mut text, || is_stopped).unwrap();
    text
}

/// Returns the rows of a table.
fn table(interval_us: Option<u64>) -> Vec<csv::StringRecord> {
    let text = written(interval_us, false);
    let mut rows = csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_slice());
    rows.records().map(Result::unwrap).collect()
}

#[test]
fn a_table_has_all_signals_with_their_units() {
    let rows = table(None);
    assert_eq!(rows.len() as u64, 1 + flight(LOG).counts().main);
    let pairs: Vec<String> =
        rows[0].iter().zip(&rows[3]).map(|(name, cell)| format!("{name}: {cell}")).collect();
    insta::assert_snapshot!(pairs.join("\n"));
}

#[test]
fn rows_may_be_an_interval_apart() {
    let times = |interval_us| -> Vec<String> {
        table(interval_us)[1..].iter().map(|row| row[0].to_owned()).take(4).collect()
    };
    assert_eq!(times(None), ["0.000000", "0.001000", "0.002000", "0.003000"]);
    assert_eq!(times(Some(10_000)), ["0.000000", "0.010000", "0.020000", "0.030000"]);
    // Frames are a millisecond apart.
    assert_eq!(times(Some(2_500)), ["0.000000", "0.003000", "0.005000", "0.008000"]);
    assert_eq!(times(Some(0)), times(None));
}

#[test]
fn a_table_that_is_stopped_has_the_rows_so_far() {
    let text = written(None, true);
    assert_eq!(text.iter().filter(|byte| **byte == b'\n').count(), 1, "only the header");
    let two = [LOG, LOG].concat();
    let logs_after = |is_stopped: bool| {
        write_csv(&flight(LOG), &two[..], None, &mut Vec::new(), || is_stopped).unwrap().logs_after
    };
    assert_eq!((logs_after(false), logs_after(true)), (1, 0));
    let start = |is_stopped: bool| Indexer::new(&two[..]).run_to_start(Some(2), || is_stopped).unwrap();
    assert!(start(false).is_some() && start(true).is_none());
}

#[test]
fn a_table_needs_no_index_and_gives_what_is_known_at_the_end() {
    let file = include_bytes!("../../../tests/corpus/blackbox/damaged.bbl");
    let frames = LOG.windows(3).position(|bytes| bytes == b"\nE\0").unwrap() + 1;
    let early = [&LOG[..frames], b"?????", &LOG[frames..]].concat();
    for (bytes, number) in [(LOG, None), (&file[..], None), (&early, None), (&[file, LOG].concat(), Some(2))]
    {
        let whole = Indexer::new(bytes).run().unwrap().flights;
        let at = number.unwrap_or(1) - 1;
        let start =
            Indexer::new(bytes).run_to_start(number, || false).unwrap().unwrap().flights.pop().unwrap();
        let (mut with_index, mut without) = (Vec::new(), Vec::new());
        let end = write_csv(&whole[at], bytes, None, &mut with_index, || false).unwrap();
        assert_eq!(write_csv(&start, bytes, None, &mut without, || false).unwrap(), end);
        assert!(with_index == without && without.len() > 100);
        let LogEnd { counts, cut_bytes, is_complete } = whole[at].end();
        assert_eq!((end.log.cut_bytes, end.log.is_complete), (cut_bytes, is_complete));
        assert_eq!(
            (end.log.counts.main, end.log.counts.skipped_bytes, end.log.counts.skipped_frames),
            (counts.main, counts.skipped_bytes, counts.skipped_frames)
        );
        assert_eq!(end.logs_after, whole.len() - at - 1);
    }
}

#[test]
fn tracks_have_the_date_of_the_log() {
    let flight = flight(LOG);
    let gpx = String::from_utf8(log_gpx(&flight, "a & b", Vec::new()).unwrap()).unwrap();
    insta::assert_snapshot!(gpx);
    let kml = log_track(&flight, "a & b").kml();
    assert!(
        kml.contains("<!-- betadeck (from a log) -->") && kml.contains("2026-05-01T09:59:59.990Z"),
        "{kml}"
    );
    for bytes in [kml.as_bytes(), log_track(&flight, "a & b").geojson().as_bytes(), gpx.as_bytes()] {
        let features = read_features("track", bytes).unwrap();
        assert!(features.iter().any(|feature| matches!(feature.shape, Shape::Line(_))), "{features:?}");
    }
}

#[test]
fn a_log_without_a_date_begins_at_the_simulated_boot() {
    let text = String::from_utf8_lossy(LOG).into_owned();
    let at = text.find("2026-05-01").unwrap();
    let mut bytes = LOG.to_vec();
    bytes[at..at + 10].copy_from_slice(b"0000-01-01");
    let gpx = String::from_utf8(log_gpx(&flight(&bytes), "x", Vec::new()).unwrap()).unwrap();
    assert!(gpx.contains("<time>2026-01-01T00:00:01Z</time>"), "{gpx}");
}
