use proptest::prelude::*;

use super::super::message::{Heartbeat, ParamValue, table};
use super::*;

/// Frames by the generator of pymavlink, in hexadecimal, and their messages.
const VECTORS: &str = include_str!("../../../tests/vectors/mavlink/frames.tsv");

fn bytes_of(hex: &str) -> Vec<u8> {
    (0..hex.len() / 2).map(|at| u8::from_str_radix(&hex[2 * at..2 * at + 2], 16).unwrap()).collect()
}

/// Returns the frames in bytes that arrive in pieces of this length.
fn read(reader: &mut FrameReader, bytes: &[u8], piece: usize) -> Vec<Frame> {
    let mut frames = Vec::new();
    for mut piece in bytes.chunks(piece) {
        frames.extend(std::iter::from_fn(|| reader.next_frame(&mut piece)));
        assert!(piece.is_empty());
    }
    frames
}

fn read_all(bytes: &[u8]) -> (Vec<Frame>, ReaderCounts) {
    let mut reader = FrameReader::default();
    let frames = read(&mut reader, bytes, usize::MAX);
    (frames, reader.counts())
}

fn heartbeat(version: Version, sequence: u8) -> Frame {
    let message =
        Heartbeat { custom_mode: 5, r#type: 2, base_mode: 81, mavlink_version: 3, ..Heartbeat::default() };
    Frame { version, sequence, system: 1, component: 1, message: message.into() }
}

fn encoded(version: Version, sequence: u8) -> Vec<u8> {
    heartbeat(version, sequence).encode().unwrap()
}

/// Returns a version 2 frame of a message that the table lacks.
fn unknown(payload: &[u8]) -> Vec<u8> {
    let mut frame = vec![START_V2, payload.len() as u8, 0, 0, 9, 1, 1, 0x39, 0x30, 0];
    frame.extend(payload);
    frame.extend([0x12, 0x34]);
    frame
}

#[test]
fn frames_of_pymavlink_are_read_and_written_to_the_byte() {
    let mut met = std::collections::BTreeSet::new();
    for line in VECTORS.lines() {
        let (hex, expected) = line.split_once('\t').unwrap();
        let bytes = bytes_of(hex);
        let (frames, counts) = read_all(&bytes);
        let [frame] = frames[..] else { panic!("{line}: {counts:?}") };
        // Version 1 has no extension fields, so the line lacks them.
        let expected = if frame.version == Version::V1 { expected.trim_end_matches(" })") } else { expected };
        let ours = format!("{:?}", frame.message);
        assert!(ours.starts_with(expected), "{ours}\n{expected}");
        if frame.version == Version::V2 {
            assert_eq!(ours, expected);
        }
        assert_eq!(frame.encode().unwrap(), bytes, "{line}");
        met.insert((frame.message.info().id, frame.version));
    }
    let all = table().iter().map(|info| (info.id, Version::V2));
    let old = table().iter().filter(|info| info.id < 256).map(|info| (info.id, Version::V1));
    assert_eq!(met, all.chain(old).collect());
}

#[test]
fn the_heartbeat_of_the_documents_is_read() {
    let (frames, _) = read_all(
        &bytes_of("fd0900000701010000000500000002008104" /* payload */)
            .into_iter()
            .chain([3, 0xab, 0xd5])
            .collect::<Vec<_>>(),
    );
    let Message::Heartbeat(heartbeat) = frames[0].message else { panic!("{frames:?}") };
    assert_eq!((heartbeat.custom_mode, heartbeat.r#type, heartbeat.base_mode), (5, 2, 129));
}

#[test]
fn a_payload_of_zeros_keeps_one_byte() {
    let frame = Frame { message: ParamValue::default().into(), ..heartbeat(Version::V2, 0) };
    assert_eq!(frame.encode().unwrap().len(), HEADER_V2 + 1 + CHECKSUM);
    let old = Frame { version: Version::V1, ..frame };
    assert_eq!(old.encode().unwrap().len(), HEADER_V1 + 25 + CHECKSUM);
}

#[test]
fn version_1_carries_no_message_above_255() {
    let message = super::super::message::ProtocolVersion::default().into();
    assert_eq!(Frame { message, ..heartbeat(Version::V1, 0) }.encode(), None);
}

#[test]
fn the_frame_after_garbage_is_found() {
    for garbage in
        [&b"hello\r\n"[..], &[START_V2], &[START_V2, 255, 0], &[START_V1, 9, 1, 1, 1, 0, 7], &[0xfe; 40]]
    {
        let mut bytes = garbage.to_vec();
        for sequence in 0..40 {
            bytes.extend(encoded(Version::V2, sequence));
        }
        let (frames, counts) = read_all(&bytes);
        // A header may promise as many as 280 bytes.
        assert!(frames.len() >= 26, "{garbage:?}: {counts:?}");
        assert_eq!(frames.last(), Some(&heartbeat(Version::V2, 39)));
    }
}

#[test]
fn a_frame_with_a_flipped_bit_is_counted_and_dropped() {
    let bytes = encoded(Version::V2, 0);
    for at in 10..bytes.len() {
        let mut bytes = bytes.clone();
        bytes[at] ^= 4;
        bytes.extend(encoded(Version::V2, 1));
        let (frames, counts) = read_all(&bytes);
        assert_eq!(frames, [heartbeat(Version::V2, 1)]);
        assert_eq!((counts.bad_checksum, counts.frames), (1, 1));
    }
}

#[test]
fn a_version_1_frame_of_another_length_is_counted_as_such() {
    let mut bytes = encoded(Version::V1, 0);
    bytes[1] = 8;
    bytes.extend(encoded(Version::V1, 1));
    let (frames, counts) = read_all(&bytes);
    assert_eq!(frames, [heartbeat(Version::V1, 1)]);
    assert_eq!(counts.bad_length, 1);
}

#[test]
fn a_version_2_frame_with_fields_of_the_future_is_read() {
    let mut bytes = encoded(Version::V2, 0);
    bytes.truncate(bytes.len() - CHECKSUM);
    bytes.extend([7, 7]);
    bytes[1] += 2;
    let sum = crc::with_byte(crc::with_bytes(crc::START, &bytes[1..]), 50);
    bytes.extend(sum.to_le_bytes());
    assert_eq!(read_all(&bytes).0, [heartbeat(Version::V2, 0)]);
}

#[test]
fn signed_and_incompatible_frames_are_refused_as_a_whole() {
    let with_flags = |flags: u8| {
        let mut bytes = encoded(Version::V2, 0);
        bytes[2] = flags;
        let end = bytes.len() - CHECKSUM;
        let sum = crc::with_byte(crc::with_bytes(crc::START, &bytes[1..end]), 50);
        bytes[end..].copy_from_slice(&sum.to_le_bytes());
        bytes
    };
    let signed = [with_flags(1), vec![START_V2; SIGNATURE], encoded(Version::V2, 1)].concat();
    let (frames, counts) = read_all(&signed);
    assert_eq!(frames, [heartbeat(Version::V2, 1)]);
    assert_eq!(counts, ReaderCounts { frames: 1, signed: 1, ..ReaderCounts::default() });
    let (frames, counts) = read_all(&[with_flags(2), encoded(Version::V2, 1)].concat());
    assert_eq!(frames.len(), 1);
    assert_eq!(counts, ReaderCounts { frames: 1, incompatible: 1, ..ReaderCounts::default() });
}

#[test]
fn a_frame_inside_an_unknown_frame_is_no_frame() {
    let bytes =
        [encoded(Version::V2, 0), unknown(&encoded(Version::V2, 77)), encoded(Version::V2, 2)].concat();
    let (frames, counts) = read_all(&bytes);
    assert_eq!(frames, [heartbeat(Version::V2, 0), heartbeat(Version::V2, 2)]);
    assert_eq!(counts, ReaderCounts { frames: 2, unknown: 1, ..ReaderCounts::default() });
}

#[test]
fn losses_are_counted_for_each_sender() {
    let mut reader = FrameReader::default();
    for sequence in [250, 251, 253, 252, 254, 2] {
        read(&mut reader, &encoded(Version::V2, sequence), usize::MAX);
    }
    let loss = reader.losses()[&(1, 1)];
    assert_eq!((loss.received, loss.lost), (6, 1 + 3));
    for system in 0..=255 {
        let frame = Frame { system, ..heartbeat(Version::V2, 0) };
        read(&mut reader, &frame.encode().unwrap(), usize::MAX);
    }
    assert_eq!(reader.losses().len(), 32);
}

#[test]
fn the_bytes_of_the_returned_frame_can_be_had() {
    let (first, second) = (encoded(Version::V2, 0), encoded(Version::V1, 1));
    let mut reader = FrameReader::default();
    let bytes = [b"xx".to_vec(), first.clone(), second.clone()].concat();
    let mut bytes = &bytes[..];
    for expected in [first, second] {
        assert!(reader.next_frame(&mut bytes).is_some());
        assert_eq!(reader.frame_bytes(), expected);
    }
    assert_eq!(reader.next_frame(&mut bytes), None);
    assert_eq!(reader.frame_bytes(), b"");
}

/// Bytes of which many are parts of frames.
fn hostile() -> impl Strategy<Value = Vec<u8>> {
    let part = prop_oneof![
        prop::collection::vec(any::<u8>(), 0..40),
        any::<u8>().prop_map(|sequence| encoded(Version::V2, sequence)),
        any::<u8>().prop_map(|sequence| encoded(Version::V1, sequence)),
        (any::<[u8; 9]>()).prop_map(|rest| [vec![START_V2], rest.to_vec()].concat()),
        (0u8..12, any::<u8>()).prop_map(|(cut, at)| encoded(Version::V2, at)[usize::from(cut)..].to_vec()),
        prop::collection::vec(any::<u8>(), 0..40).prop_map(|payload| unknown(&payload)),
    ];
    prop::collection::vec(part, 0..12).prop_map(|parts| parts.concat())
}

proptest! {
    #[test]
    fn what_is_found_does_not_depend_on_the_pieces(bytes in hostile(), piece in 1usize..300) {
        let mut reader = FrameReader::default();
        let frames = read(&mut reader, &bytes, piece);
        let (whole, counts) = read_all(&bytes);
        prop_assert_eq!(format!("{frames:?}"), format!("{whole:?}"));
        prop_assert_eq!(reader.counts(), counts);
        prop_assert!(reader.buffer.len() <= MAX_FRAME);
    }

    #[test]
    fn frames_in_a_row_are_all_found(count in 0u8..50, piece in 1usize..50) {
        let frames: Vec<Frame> = (0..count).map(|sequence| heartbeat(Version::V2, sequence)).collect();
        let bytes: Vec<u8> = frames.iter().flat_map(|frame| frame.encode().unwrap()).collect();
        prop_assert_eq!(read(&mut FrameReader::default(), &bytes, piece), frames);
    }
}
