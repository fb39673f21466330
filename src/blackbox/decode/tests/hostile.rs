//! Bytes that are no log, or not quite.

use proptest::prelude::*;

use super::maker::{HEADER, Maker};
use super::{Read, all};

/// Every byte of a log is a part of one item, and items have an order.
fn assert_laws(bytes: &[u8]) {
    let mut is_inside = false;
    let mut last_us = 0;
    let mut passed = 0;
    for read in all(bytes) {
        match read {
            Read::Log => {
                assert!(!is_inside);
                (is_inside, last_us) = (true, 0);
            }
            Read::LogEnd => {
                assert!(is_inside);
                is_inside = false;
            }
            Read::Refused(_) => assert!(!is_inside),
            Read::Frame(_, _, time_us) => {
                assert!(is_inside && time_us >= last_us);
                last_us = time_us;
            }
            Read::Event(_) => assert!(is_inside),
            Read::Skipped { bytes, frames } => {
                assert!(is_inside && bytes > 0 && frames <= bytes);
                passed += bytes;
            }
        }
    }
    assert!(!is_inside);
    assert!(passed <= bytes.len() as u64);
}

/// Generates frames with any values between bytes that may be frames.
fn almost_frames() -> impl Strategy<Value = Vec<u8>> {
    let piece = prop_oneof![
        4 => any::<[i32; 4]>().prop_map(|values| Maker::default().differences(values).bytes.clone()),
        2 => any::<[i32; 5]>().prop_map(|[iteration, time, gyro, ..]| {
            Maker::default().whole([iteration, time, gyro, 1000, 1000]).bytes.clone()
        }),
        2 => (0..50_000).prop_map(|at| Maker::default().intervals(at, 2).bytes.clone()),
        1 => prop::collection::vec(any::<u8>(), 1..40),
        1 => prop::collection::vec(prop::sample::select(b"IPSGHE\xff\x80\0".to_vec()), 1..40),
        1 => Just(HEADER.as_bytes().to_vec()),
        1 => Just(HEADER.as_bytes()[..200].to_vec()),
        1 => Just(Maker::default().end().bytes.clone()),
        1 => (any::<u32>(), any::<u32>()).prop_map(|(iteration, time)| {
            Maker::default().raw(b"E\x0e").unsigned(iteration).unsigned(time).bytes.clone()
        }),
    ];
    prop::collection::vec(piece, 0..30).prop_map(|pieces| pieces.concat())
}

proptest! {
    #[test]
    fn any_bytes_after_a_header_are_read_to_their_end(bytes in almost_frames()) {
        assert_laws(&[HEADER.as_bytes(), &bytes].concat());
    }

    #[test]
    fn any_bytes_after_a_header_without_all_definitions_are_read_to_their_end(
        bytes in almost_frames(),
        missing in prop::sample::select(vec!["H Field H", "H Field G name", "H Field G encoding", "H Field S"]),
    ) {
        let lines: String = HEADER.split_inclusive('\n').filter(|line| !line.starts_with(missing)).collect();
        assert_laws(&[lines.as_bytes(), &bytes].concat());
    }

    #[test]
    fn any_change_of_a_log_is_read_to_its_end(
        at in any::<prop::sample::Index>(),
        change in 1..=255_u8,
        cut in any::<prop::sample::Index>(),
    ) {
        let mut bytes = Maker::default().begin(HEADER).intervals(0, 5).end().bytes.clone();
        let place = at.index(bytes.len());
        bytes[place] ^= change;
        bytes.truncate(cut.index(bytes.len() + 1));
        assert_laws(&bytes);
    }

    #[test]
    fn damage_costs_at_most_the_frames_around_it(
        at in any::<prop::sample::Index>(),
        garbage in prop::collection::vec(any::<u8>(), 1..200),
    ) {
        let (before, after) = (20, 20);
        let mut maker = Maker::default();
        maker.begin(HEADER);
        let header = maker.bytes.len();
        maker.intervals(0, before);
        let place = header + at.index(maker.bytes.len() - header);
        maker.bytes.splice(place..place, garbage);
        maker.intervals(8 * before, after).end();
        let frames = all(&maker.bytes);
        let is_at = |read: &Read, at: i32| matches!(read, Read::Frame(_, values, _) if values.len() == 5 && values[0] == at);
        // The damage may look like a frame with a jump: then two whole frames pass until the log goes on.
        for iteration in (8 * (before + 3)..8 * (before + after)).step_by(2) {
            prop_assert!(frames.iter().any(|read| is_at(read, iteration)), "{}", iteration);
        }
    }
}
