//! Recordings of flights, as files or as the lines in them.

use std::io::Write as _;

use betadeck::recording::{End, Header, Picture, Recording, Repeat, TAIL, Writer, read_summary, seen_s};
use flate2::Compression;
use flate2::write::GzEncoder;

/// The number of ticks that an accepted recording flies.
const TICKS: u32 = 40;

/// Reads the bytes as a file, and as the lines of one. What is accepted has pictures, can be listed, and flies as far as it
/// says that it does.
pub fn run(data: &[u8]) {
    check(data);
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(data).expect("memory");
    check(&encoder.finish().expect("memory"));
}

fn check(file: &[u8]) {
    let listed = read_summary(file, &file[file.len().saturating_sub(TAIL)..]);
    let seen_s = seen_s(file).expect("memory");
    assert!(seen_s >= 0.0);
    let recording = match Recording::read(file) {
        Ok(recording) => recording,
        Err(problem) => {
            assert!(!problem.to_string().is_empty());
            return;
        }
    };
    if let Ok(summary) = listed {
        assert_eq!(summary.header, recording.header);
    }
    let pictures = recording.pictures.all();
    assert!(pictures.is_sorted_by_key(Picture::time));
    for picture in pictures.iter().take(3) {
        assert_eq!(picture.snapshot().time, picture.time());
        assert_eq!(recording.pictures.at(picture.time()), Some(picture));
    }
    assert!(recording.notices().iter().all(|sentence| sentence.ends_with('.')));
    match recording.flight().and_then(|setup| Repeat::new(&recording, setup)) {
        Ok(repeat) => fly(repeat),
        Err(reason) => assert!(!reason.is_empty()),
    }
    // The events are the same after another reading.
    let mut writer = Writer::new(Header { format: 1, ..recording.header.clone() });
    writer.gap("of the test");
    recording.events.iter().for_each(|event| writer.event(event));
    let written = writer.finish(End::default());
    if !pictures.is_empty() || !recording.events.is_empty() {
        match Recording::read(&written[..]) {
            Ok(again) => assert_eq!(again.events, recording.events),
            Err(problem) => assert!(problem.to_string().contains("neither pictures"), "{problem}"),
        }
    }
}

fn fly(mut repeat: Repeat<'_>) {
    for _ in 0..TICKS {
        if repeat.is_over() {
            break;
        }
        repeat.prepare();
        repeat.tick(drop);
    }
    let (vehicle, timeline) = repeat.finish();
    let snapshot = vehicle.snapshot();
    assert!(snapshot.truth.is_some_and(|truth| truth.n.is_finite() && truth.alt.is_finite()));
    drop(timeline);
}
