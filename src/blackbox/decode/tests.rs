//! Whole logs through the reader.

mod hostile;
mod maker;
mod round_trip;

use std::io;

use super::super::event::LogEvent;
use super::super::field::FrameKind;
use super::{HeaderError, Item, LogReader, LogSource};
use maker::{HEADER, Maker};

/// An item with its values, without its place.
#[derive(Debug, Clone, PartialEq)]
enum Read {
    Log,
    Refused(HeaderError),
    Frame(FrameKind, Vec<i32>, u64),
    Event(Option<LogEvent>),
    Skipped { bytes: u64, frames: u64 },
    LogEnd,
}

fn read(item: &Item<'_>) -> Read {
    match item {
        Item::Log { .. } => Read::Log,
        Item::Refused { error, .. } => Read::Refused(error.clone()),
        Item::Frame(frame) => Read::Frame(frame.kind, frame.values.to_vec(), frame.time_us),
        Item::Event { event, .. } => Read::Event(*event),
        Item::Skipped { bytes, frames, .. } => Read::Skipped { bytes: *bytes, frames: *frames },
        Item::LogEnd => Read::LogEnd,
    }
}

fn rest_of(mut reader: LogReader<impl LogSource>) -> Vec<Read> {
    let mut all = Vec::new();
    while let Some(item) = reader.next_item().expect("a source without errors") {
        all.push(read(&item));
    }
    all
}

fn all(bytes: &[u8]) -> Vec<Read> {
    rest_of(LogReader::new(bytes))
}

fn main_frames(bytes: &[u8]) -> Vec<Read> {
    let is_main = |read: &Read| matches!(read, Read::Frame(FrameKind::Intra | FrameKind::Inter, ..));
    all(bytes).into_iter().filter(is_main).collect()
}

fn main(kind: FrameKind, values: [i32; 5]) -> Read {
    Read::Frame(kind, values.to_vec(), u64::from(values[1] as u32))
}

#[test]
fn frames_have_the_values_that_were_predicted_and_encoded() {
    let mut maker = Maker::default();
    maker.begin(HEADER).whole([0, 5000, -7, 1100, 1200]).differences([2000, 1, 2, 3]);
    maker.raw(b"S").unsigned(3).differences([-10, 1, 1, 1]).end();
    assert_eq!(
        all(&maker.bytes),
        [
            Read::Log,
            main(FrameKind::Intra, [0, 5000, -7, 1100, 1200]),
            // Two iterations on; the line through twice the same time; the average of twice the same values.
            main(FrameKind::Inter, [2, 7000, -6, 1102, 1203]),
            Read::Frame(FrameKind::Slow, vec![3], 7000),
            // (−6 − 7) / 2 = −6, (1102 + 1100) / 2 = 1101, (1203 + 1200) / 2 = 1201.
            main(FrameKind::Inter, [4, 8990, -5, 1102, 1202]),
            Read::Event(Some(LogEvent::End)),
            Read::LogEnd,
        ]
    );
}

#[test]
fn a_frame_without_its_definition_is_passed_up_to_the_end_of_a_log() {
    let is_other = |line: &&str| !line.starts_with("H Field G ");
    let header: String = HEADER.split_inclusive('\n').filter(is_other).collect();
    let mut maker = Maker::default();
    maker.begin(&header).whole([0, 5000, -7, 1100, 1200]);
    // The second byte of the undefined frame is the letter of a frame for which the log is too short.
    maker.raw(b"G\x01I\x07").raw(b"S").unsigned(3);
    let after = all(&maker.bytes).split_off(2);
    assert_eq!(after, [Read::Frame(FrameKind::Slow, vec![3], 5000), Read::LogEnd]);
}

#[test]
fn iterations_are_counted_by_the_intervals() {
    let mut maker = Maker::default();
    maker.begin(HEADER).intervals(0, 2);
    let iterations = |bytes: &[u8]| -> Vec<i32> {
        let frames = main_frames(bytes).into_iter();
        frames
            .filter_map(|read| if let Read::Frame(_, values, _) = read { Some(values[0]) } else { None })
            .collect()
    };
    assert_eq!(iterations(&maker.bytes), [0, 2, 4, 6, 8, 10, 12, 14]);
    let mut thirds = Maker::default();
    thirds.begin(&HEADER.replace("P interval:2", "P interval:2/3")).intervals(0, 1);
    assert_eq!(iterations(&thirds.bytes), [0, 2, 3, 5]);
}

#[test]
fn places_are_relative_to_home() {
    let mut maker = Maker::default();
    maker.begin(HEADER).whole([0, 5000, 0, 1000, 1000]);
    maker.raw(b"G").unsigned(100).unsigned(9).signed(1).signed(2);
    maker.raw(b"H").signed(404_640_000).signed(-795_175_000);
    maker.raw(b"G").unsigned(200).unsigned(9).signed(-10).signed(20);
    let mut reader = LogReader::new(&maker.bytes[..]);
    let mut homes = Vec::new();
    let mut last = Vec::new();
    while let Some(item) = reader.next_item().unwrap() {
        if let Item::Frame(frame) = item
            && frame.kind == FrameKind::Gps
        {
            homes.push(frame.has_home);
            last = frame.values.to_vec();
        }
    }
    assert_eq!(homes, [false, true]);
    assert_eq!(last, [5200, 9, 404_639_990, -795_174_980]);
}

#[test]
fn several_logs_follow_each_other() {
    let mut maker = Maker::default();
    maker.raw(b"\xff\xff").begin(HEADER).intervals(0, 1).end().raw(&[0xff; 500]);
    maker.begin(&HEADER.replace("Data version:2", "Data version:1")).intervals(0, 1);
    // Cut inside a frame.
    maker.begin(HEADER).intervals(0, 1).raw(b"P\x02");
    maker.begin(HEADER).intervals(0, 1).end();
    let whole = &all(&Maker::default().begin(HEADER).intervals(0, 1).end().bytes)[..];
    let cut = [&whole[..5], &[Read::Skipped { bytes: 2, frames: 0 }, Read::LogEnd]].concat();
    let refused = [Read::Refused(HeaderError::DataVersion("1".to_owned()))];
    assert_eq!(whole.len(), 7);
    assert_eq!(all(&maker.bytes), [whole, &refused, &cut[..], whole].concat());
}

#[test]
fn a_log_without_its_definitions_is_refused() {
    let refused = |lines: &str| match &all(lines.as_bytes())[..] {
        [Read::Refused(error)] => error.to_string(),
        other => panic!("{other:?}"),
    };
    assert_eq!(
        refused(&HEADER.replace("loopIteration", "x").replace("motorOutput:1000,2000\n", "a:b\nI")),
        { "its main frames have no field `loopIteration`" }
    );
    let first_line = HEADER.split_inclusive('\n').next().unwrap();
    assert_eq!(refused(first_line), "the file ends inside its header");
    assert_eq!(refused(&format!("{first_line}IIIIII")), "its header has no line `Field I name`");
}

#[test]
fn reading_goes_on_at_the_next_whole_frame_after_damage() {
    let mut maker = Maker::default();
    maker.begin(HEADER).intervals(0, 1);
    let (damage_at, good) = (maker.bytes.len(), main_frames(&maker.bytes));
    maker.whole([8, 8000, 8, 1100, 1200]).raw(&[0x80; 9]).differences([0; 4]).differences([0; 4]);
    maker.intervals(16, 1).end();
    let found = all(&maker.bytes);
    let mut expected = vec![Read::Log];
    expected.extend(good);
    // The frame before the damage cannot be told from the damage.
    let bytes = 2 + 2 + 1 + 1 + 1 + 1 + 9 + 2 * 5;
    assert_eq!(maker.bytes[damage_at], b'I');
    expected.push(Read::Skipped { bytes, frames: 2 });
    let rest = main_frames(&Maker::default().begin(HEADER).intervals(16, 1).bytes);
    expected.extend(rest);
    expected.extend([Read::Event(Some(LogEvent::End)), Read::LogEnd]);
    assert_eq!(found, expected);
}

#[test]
fn a_log_that_is_cut_anywhere_opens_up_to_its_last_whole_frame() {
    let mut maker = Maker::default();
    maker.begin(HEADER);
    let header = maker.bytes.len();
    maker.intervals(0, 3).raw(b"S").unsigned(5).raw(b"E").raw(&[30, 5, 1]).intervals(24, 2).end();
    let whole = all(&maker.bytes);
    for end in 0..maker.bytes.len() {
        let cut = all(&maker.bytes[..end]);
        if end <= header {
            assert!(!cut.iter().any(|read| matches!(read, Read::Frame(..))), "{end}");
            continue;
        }
        let frames =
            cut.iter().take_while(|read| !matches!(read, Read::Skipped { .. } | Read::LogEnd)).count();
        assert_eq!(cut[..frames], whole[..frames], "{end}");
        let lost: u64 = cut[frames..]
            .iter()
            .map(|read| if let Read::Skipped { bytes, .. } = read { *bytes } else { 0 })
            .sum();
        assert!(cut.len() - frames <= 2 && lost < 13, "{end}: {:?}", &cut[frames..]);
    }
}

/// A source that gives few bytes at once.
struct Drops<'a>(&'a [u8], usize);

impl LogSource for Drops<'_> {
    fn size(&self) -> u64 {
        self.0.size()
    }

    fn read_at(&mut self, offset: u64, buffer: &mut [u8]) -> io::Result<usize> {
        let most = buffer.len().min(self.1);
        self.0.read_at(offset, &mut buffer[..most])
    }
}

/// Returns a file of several hundred kilobytes with three logs.
fn large() -> Vec<u8> {
    let mut maker = Maker::default();
    maker.begin(HEADER).intervals(0, 9000).end().begin(HEADER).intervals(0, 9000);
    maker.raw(&[7; 1000]).begin(HEADER).intervals(0, 9000).end();
    maker.bytes
}

#[test]
fn the_size_of_the_pieces_does_not_matter() {
    let bytes = large();
    let whole = all(&bytes);
    assert!(bytes.len() > 600_000);
    assert_eq!(whole.iter().filter(|read| matches!(read, Read::Log)).count(), 3);
    for most in [1, 61, 4096] {
        assert!(rest_of(LogReader::new(Drops(&bytes, most))) == whole, "{most}");
    }
}

#[test]
fn reading_goes_on_at_any_whole_frame() {
    let mut maker = Maker::default();
    maker.begin(HEADER).intervals(0, 2).raw(b"S").unsigned(5).raw(b"H").signed(5).signed(6);
    maker.intervals(16, 3).raw(b"G").unsigned(1).unsigned(2).signed(3).signed(4).intervals(40, 1).end();
    let whole = all(&maker.bytes);
    let mut reader = LogReader::new(&maker.bytes[..]);
    let (mut at, mut header, mut resumed) = (0, None, 0);
    while let Some(item) = reader.next_item().unwrap() {
        let offset = match &item {
            Item::Log { header: new, .. } => {
                header = Some(new.clone());
                None
            }
            Item::Frame(frame) if frame.kind == FrameKind::Intra => Some(frame.offset),
            _ => None,
        };
        if let Some(offset) = offset {
            let point = reader.resume_point(offset).unwrap();
            let again = LogReader::resumed(&maker.bytes[..], header.clone().unwrap(), &point);
            assert_eq!(rest_of(again), whole[at..]);
            resumed += 1;
        }
        at += 1;
    }
    assert_eq!(resumed, 6);
}

#[test]
fn the_newest_values_of_each_kind_of_frame_are_kept() {
    let mut maker = Maker::default();
    maker.begin(HEADER).intervals(0, 1).raw(b"S").unsigned(5).intervals(8, 1);
    let mut reader = LogReader::new(&maker.bytes[..]);
    assert_eq!(reader.newest(FrameKind::Slow), [0; 0]);
    while reader.offset() < maker.bytes.len() as u64 {
        reader.next_item().unwrap();
    }
    assert_eq!(reader.newest(FrameKind::Slow), [5]);
    assert_eq!(reader.newest(FrameKind::Inter)[0], 14);
}

#[test]
fn logging_goes_on_after_a_pause() {
    let mut maker = Maker::default();
    maker.begin(HEADER).intervals(0, 1).raw(b"E").raw(&[14]).unsigned(80_000).unsigned(80_000_000);
    maker.intervals(80_000, 1).end();
    let frames = main_frames(&maker.bytes);
    assert_eq!(frames.len(), 8);
    assert_eq!(frames[4], main(FrameKind::Intra, [80_000, 80_000_000, 80_000, 1100, 1200]));
}
