//! The crate `blackbox-log` as a second reader.
//!
//! It differs from the decoders of Betaflight in three points, which are left out here: it refuses versions by year, it
//! counts the loop of each frame as the next one, and after an `I` frame it still averages with the frame before.

use blackbox_log::Event;
use blackbox_log::frame::{Frame, FrameDef};
use blackbox_log::prelude::*;

use crate::log_writer::reader::{self, Log, Part, Values};

/// The newest version that the crate reads.
const KNOWN_VERSION: &str = "Betaflight 4.5.2 (norevision) SITL";

/// Returns the same bytes with a version in the header that the crate reads.
pub(crate) fn with_known_version(log: &[u8]) -> Vec<u8> {
    let name = b"Firmware revision:";
    let at = log.windows(name.len()).position(|part| part == name).unwrap() + name.len();
    let end = at + log[at..].iter().position(|byte| *byte == b'\n').unwrap();
    [&log[..at], KNOWN_VERSION.as_bytes(), &log[end..]].concat()
}

fn values<'a, D: FrameDef<'a>>(def: &D, frame: &impl Frame) -> Values {
    let signed =
        |raw: u32, is_signed: bool| if is_signed { i64::from(raw.cast_signed()) } else { raw.into() };
    def.iter()
        .zip(frame.iter_raw())
        .map(|(def, raw)| (def.name.to_owned(), signed(raw, def.signed)))
        .collect()
}

/// Asserts that two frames have the same values, but for these fields.
fn assert_equal(judged: &Values, read: &Values, except: &[&str]) {
    for (name, value) in judged {
        if !except.contains(&name.as_str()) {
            assert_eq!(Some(value), read.get(name), "{name}");
        }
    }
}

/// Reads one log with both readers, and asserts that they agree.
pub(crate) fn read(log: &[u8]) -> Log {
    let known = with_known_version(log);
    let read = reader::read(&known);
    let file = blackbox_log::File::new(&known);
    assert_eq!(file.log_count(), 1);
    let headers = file.parse(0).unwrap().unwrap();
    let predictors =
        read.headers["Field P predictor"].split(',').zip(read.headers["Field I name"].split(','));
    let averaged: Vec<&str> = predictors
        .filter(|(predictor, _)| ["2", "3", "6"].contains(predictor))
        .map(|(_, name)| name)
        .collect();
    let mut parser = headers.data_parser();
    // The crate reports no H frames.
    let mut expected = read.parts.iter().filter(|part| !matches!(part, Part::Frame { letter: 'H', .. }));
    while let Some(event) = parser.next() {
        match (event, expected.next()) {
            (ParserEvent::Main(frame), Some(Part::Frame { letter: 'I', values: read, .. })) => {
                assert_equal(&values(headers.main_frame_def(), &frame), read, &[]);
            }
            (ParserEvent::Main(frame), Some(Part::Frame { letter: 'P', values: read, .. })) => {
                assert_equal(&values(headers.main_frame_def(), &frame), read, &averaged);
            }
            (ParserEvent::Slow(frame), Some(Part::Frame { letter: 'S', values: read, .. })) => {
                assert_equal(&values(headers.slow_frame_def(), &frame), read, &[]);
            }
            (ParserEvent::Gps(frame), Some(Part::Frame { letter: 'G', values: read, .. })) => {
                assert_equal(&values(headers.gps_frame_def().unwrap(), &frame), read, &["time"]);
            }
            (ParserEvent::Event(judged), Some(Part::Event(read))) => assert_same_event(&judged, read),
            (_, other) => panic!("the crate found something else than {other:?}"),
        }
    }
    // The last frame of a log that is cut may be whole, but nothing follows that shows it.
    assert!(expected.count() <= 1, "the crate found everything");
    read
}

fn assert_same_event(judged: &Event, read: &reader::Event) {
    use reader::Event as Read;
    let is_same = match (judged, read) {
        (Event::SyncBeep(judged), Read::SyncBeep { time_us }) => *time_us as u64 == *judged,
        (Event::Resume { log_iteration, time }, Read::Resume { iteration, time_us }) => {
            (i64::from(*log_iteration), i64::from(*time)) == (*iteration, *time_us)
        }
        (Event::Disarm(judged), Read::Disarm { reason }) => i64::from(*judged) == *reason,
        (Event::FlightMode { flags, last_flags }, Read::FlightMode { new, old }) => {
            (i64::from(*flags), i64::from(*last_flags)) == (*new, *old)
        }
        (Event::End { .. }, Read::End) => true,
        _ => false,
    };
    assert!(is_same, "{judged:?} is not {read:?}");
}
