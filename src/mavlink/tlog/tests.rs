use proptest::prelude::*;

use super::super::frame::Version;
use super::super::message::{Heartbeat, Statustext};
use super::super::wire::Text;
use super::*;

fn frame(sequence: u8) -> Frame {
    let message = if sequence.is_multiple_of(2) {
        Heartbeat { custom_mode: 5, mavlink_version: 3, ..Heartbeat::default() }.into()
    } else {
        Statustext { severity: 6, text: Text::new("a text"), ..Statustext::default() }.into()
    };
    let version = if sequence.is_multiple_of(3) { Version::V1 } else { Version::V2 };
    Frame { version, sequence, system: 1, component: 1, message }
}

fn time(sequence: u8) -> Duration {
    Duration::from_micros(1_790_000_000_000_000 + 20_000 * u64::from(sequence))
}

fn log(count: u8) -> Vec<u8> {
    let mut log = Vec::new();
    (0..count).for_each(|sequence| write(time(sequence), &frame(sequence).encode().unwrap(), &mut log));
    log
}

fn read(log: &[u8], piece: usize) -> (Vec<Record>, u64) {
    let mut reader = LogReader::default();
    let mut records = Vec::new();
    for mut piece in log.chunks(piece) {
        records.extend(std::iter::from_fn(|| reader.next_record(&mut piece)));
    }
    records.extend(std::iter::from_fn(|| reader.last_record()));
    (records, reader.skipped())
}

fn records(range: std::ops::Range<u8>) -> Vec<Record> {
    range.map(|sequence| Record { time: time(sequence), frame: frame(sequence) }).collect()
}

#[test]
fn a_log_is_read_as_it_was_written() {
    assert_eq!(read(&log(50), usize::MAX), (records(0..50), 0));
    assert_eq!(log(1)[..8], 1_790_000_000_000_000_u64.to_be_bytes());
}

#[test]
fn the_bytes_of_a_record_are_those_of_pymavlink() {
    // The time 1790000000.123456 s, and a heartbeat.
    let hex = "00065bfeda27c240fd090000070101000000050000000200810403abd5";
    let byte = |at: usize| u8::from_str_radix(&hex[2 * at..2 * at + 2], 16).unwrap();
    let bytes: Vec<u8> = (0..hex.len() / 2).map(byte).collect();
    let (records, skipped) = read(&bytes, usize::MAX);
    assert_eq!((records.len(), skipped), (1, 0));
    assert_eq!(records[0].time, Duration::from_micros(1_790_000_000_123_456));
    let mut log = Vec::new();
    write(records[0].time, &records[0].frame.encode().unwrap(), &mut log);
    assert_eq!(log, bytes);
}

#[test]
fn a_cut_end_is_left_out() {
    let log = log(10);
    for cut in 1..20 {
        assert_eq!(read(&log[..log.len() - cut], usize::MAX).0, records(0..9));
    }
}

#[test]
fn a_beginning_without_an_end_hides_no_record() {
    // The header of a long file transfer.
    let header = [[0; 8].to_vec(), vec![0xfd, 254, 0, 0, 9, 9, 9, 110, 0, 0]].concat();
    let bytes = [log(2), header.clone(), log(3)].concat();
    assert_eq!(read(&bytes, 7), ([records(0..2), records(0..3)].concat(), header.len() as u64));
}

#[test]
fn the_records_after_garbage_are_read() {
    let (first, second) = (log(4), log(10));
    for garbage in [&b"garbage"[..], &[0xfd; 20], &[0xfe, 9], &[0; 400], &[0xff; 8]] {
        let bytes = [&first[..], garbage, &second].concat();
        let (found, skipped) = read(&bytes, usize::MAX);
        assert_eq!(found, [records(0..4), records(0..10)].concat(), "{garbage:?}");
        assert_eq!(skipped, garbage.len() as u64);
    }
}

#[test]
fn a_frame_of_an_unknown_message_is_passed_over() {
    let mut bytes = log(2);
    let unknown = [&[0xfd, 3, 0, 0, 9, 1, 1, 0x39, 0x30, 0, 1, 2, 3, 4, 5][..]].concat();
    write(time(2), &unknown, &mut bytes);
    bytes.extend(log(3));
    assert_eq!(read(&bytes, usize::MAX), ([records(0..2), records(0..3)].concat(), 8 + unknown.len() as u64));
}

#[test]
fn a_stream_of_bytes_becomes_a_log() {
    let mut writer = LogWriter::default();
    let mut log = Vec::new();
    let bytes: Vec<u8> = [b"noise".to_vec(), frame(1).encode().unwrap(), frame(2).encode().unwrap()].concat();
    writer.write(time(1), &bytes[..20], &mut log);
    writer.write(time(2), &bytes[20..], &mut log);
    let found = read(&log, usize::MAX).0;
    assert_eq!(found.iter().map(|record| record.frame).collect::<Vec<_>>(), [frame(1), frame(2)]);
}

proptest! {
    #[test]
    fn what_is_read_does_not_depend_on_the_pieces(
        mut bytes in Just(log(12)),
        noise in prop::collection::vec(any::<u8>(), 0..60),
        at in 0..200usize,
        piece in 1usize..80,
    ) {
        let at = at.min(bytes.len());
        bytes.splice(at..at, noise);
        let (found, skipped) = read(&bytes, piece);
        let (whole, whole_skipped) = read(&bytes, usize::MAX);
        prop_assert_eq!(format!("{found:?}"), format!("{whole:?}"));
        prop_assert_eq!(skipped, whole_skipped);
        // A record with the noise in it, and those that a header in the noise claims.
        prop_assert!(whole.len() >= 3, "{}", whole.len());
    }
}
