//! Files of blackbox logs.

use betadeck::blackbox::FrameKind;
use betadeck::blackbox::decode::{Item, LogReader};
use betadeck::flight_log::{Indexer, LogFlight};
use betadeck::report::log_export::{log_gpx, log_track, write_csv};
use betadeck::signals::SimTime;

/// Reads the items of a file and returns the number of logs. Every byte belongs to at most one item; times do not go back.
fn items(bytes: &[u8]) -> usize {
    let mut reader = LogReader::new(bytes);
    let (mut logs, mut is_inside, mut fields, mut last_us, mut passed) = (0, false, 0, 0, 0);
    while let Some(item) = reader.next_item().expect("bytes in memory") {
        match item {
            Item::Log { header, .. } => {
                assert!(!is_inside);
                (is_inside, last_us, fields) = (true, 0, header.fields(FrameKind::Intra).len());
                logs += 1;
            }
            Item::Refused { error, .. } => {
                assert!(!is_inside && !error.to_string().is_empty());
                logs += 1;
            }
            Item::Frame(frame) => {
                assert!(is_inside && frame.time_us >= last_us);
                last_us = frame.time_us;
                if matches!(frame.kind, FrameKind::Intra | FrameKind::Inter) {
                    assert_eq!(frame.values.len(), fields);
                }
            }
            Item::Event { .. } => assert!(is_inside),
            Item::Skipped { bytes, frames, .. } => {
                assert!(is_inside && bytes > 0 && frames <= bytes);
                passed += bytes;
            }
            Item::LogEnd => {
                assert!(is_inside);
                is_inside = false;
            }
        }
    }
    assert!(!is_inside && passed <= bytes.len() as u64);
    logs
}

/// Any instant is in the log, and shows the frame before it.
fn instants(flight: &LogFlight, bytes: &[u8]) {
    let (first, last) = (flight.first(), flight.last());
    assert!(first <= last);
    for time in [0, first.0, first.0 + (last.0 - first.0) / 2, last.0, u64::MAX].map(SimTime) {
        let sample = flight.sample(bytes, time).expect("bytes in memory");
        assert_eq!(sample.is_none(), flight.is_empty());
        let Some(sample) = sample else { continue };
        assert!(sample.time == first || sample.time <= time, "{:?} at {time:?}", sample.time);
        assert_eq!(sample.values.len(), flight.signals().len());
        assert!(sample.position.is_none_or(betadeck::geo::LatLon::is_on_globe));
    }
    for signal in [0, flight.signals().len() / 2, flight.signals().len()] {
        let series = flight.series(bytes, signal, first..last, 7).expect("bytes in memory");
        assert_eq!(series.len(), 7);
        assert!(series.iter().flatten().all(|extent| extent.min <= extent.max));
    }
}

pub fn run(bytes: &[u8]) {
    let logs = items(bytes);
    let file = Indexer::new(bytes).run().expect("bytes in memory");
    assert_eq!(file.flights.len() + file.refused.len() + file.left_out, logs);
    for flight in &file.flights {
        instants(flight, bytes);
        assert!(flight.marks().windows(2).all(|pair| pair[0].time <= pair[1].time));
        assert!(flight.marks().iter().all(|mark| mark.time >= flight.first()));
        let mut table = Vec::new();
        write_csv(flight, bytes, None, &mut table, || false).expect("memory");
        let rows = table.split(|byte| *byte == b'\n').count() as u64;
        assert!(rows >= flight.counts().main, "{rows}: {:?}", flight.counts());
        log_gpx(flight, "<&>", Vec::new()).expect("memory");
        assert!(log_track(flight, "<&>").kml().ends_with("</kml>\n"));
    }
}
