//! The memory that files of blackbox logs can take.

use std::io;

use crate::meter::measured;
use betadeck::blackbox::decode::{Item, LogReader, LogSource};
use betadeck::flight_log::Indexer;
use betadeck::signals::SimTime;

const KIB: usize = 1 << 10;
const MIB: usize = 1 << 20;

/// A file that repeats a part after its start, without a place in memory.
struct Repeated {
    start: Vec<u8>,
    part: Vec<u8>,
    size: u64,
}

impl LogSource for Repeated {
    fn size(&self) -> u64 {
        self.size
    }

    fn read_at(&mut self, offset: u64, buffer: &mut [u8]) -> io::Result<usize> {
        let mut count = 0;
        while count < buffer.len() && offset + (count as u64) < self.size {
            let at = offset as usize + count;
            let (bytes, from) = match at.checked_sub(self.start.len()) {
                None => (&self.start, at),
                Some(after) => (&self.part, after % self.part.len()),
            };
            let piece = &bytes[from..bytes.len().min(from + buffer.len() - count)];
            let piece = &piece[..piece.len().min((self.size - offset) as usize - count)];
            buffer[count..count + piece.len()].copy_from_slice(piece);
            count += piece.len();
        }
        Ok(count)
    }
}

/// Returns a header with so many fields in a main frame.
fn header(fields: usize) -> Vec<u8> {
    let list = |first: &str, other: &str| format!("{first}{}", format!(",{other}").repeat(fields - 2));
    let text = format!(
        "{}\nH Data version:2\nH Field I name:{}\nH Field I signed:{}\nH Field I predictor:{}\nH Field I encoding:{}\n\
         H Field P predictor:{}\nH Field P encoding:{}\nH Firmware revision:Betaflight 4.5.2 (x) Y\nH I interval:4\n",
        betadeck::blackbox::FIRST_LINE,
        list("loopIteration,time", "f"),
        list("0,0", "1"),
        list("0,0", "0"),
        list("1,1", "0"),
        list("6,2", "1"),
        list("9,0", "0"),
    );
    text.into_bytes()
}

/// Returns a whole frame at iteration 0 and time 0 and three frames of differences: the time and the iteration of a file
/// that repeats them go back again and again, and are doubted and confirmed.
fn frames(fields: usize) -> Vec<u8> {
    let whole = [b"I".to_vec(), vec![0; fields]].concat();
    let differences = [b"P".to_vec(), vec![0; fields - 1]].concat();
    [whole, differences.clone(), differences.clone(), differences].concat()
}

#[test]
fn a_file_streams_through_one_window() {
    let size = 4 * MIB as u64;
    for part in [frames(40), vec![b'P'; 1000], vec![0xff; 1000], b"EEEEHGIPS".to_vec(), header(40)] {
        let source = Repeated { start: header(40), part, size };
        let (count, taken) = measured(|| {
            let mut reader = LogReader::new(source);
            let mut count = 0_u64;
            while let Some(item) = reader.next_item().expect("bytes in memory") {
                count += u64::from(matches!(item, Item::Frame(_)));
            }
            count
        });
        assert!(taken.peak <= MIB, "{taken:?}, {count} frames");
    }
}

#[test]
fn an_index_is_bounded_whatever_is_in_the_file() {
    let size = 16 * MIB as u64;
    for (what, start, part) in [
        ("frames", header(40), frames(40)),
        ("many fields", header(250), frames(250)),
        ("logs", header(40), [header(40), frames(40)].concat()),
        ("headers of many lines", header(40), [header(40), b"H a:b\n".repeat(900), frames(40)].concat()),
        ("damage", header(40), [frames(40), b"\xff".to_vec()].concat()),
        ("events", header(40), [frames(40), b"E\x1e\x01\x02E\x0f\x04E\x00\x01".repeat(20)].concat()),
    ] {
        let (file, taken) =
            measured(|| Indexer::new(Repeated { start, part, size }).run().expect("no error"));
        assert!(taken.peak <= 96 * MIB, "{what}: {taken:?}");
        assert!(!file.flights.is_empty());
    }
}

#[test]
fn an_instant_takes_one_window() {
    let source = || Repeated { start: header(40), part: frames(40), size: 4 * MIB as u64 };
    let file = Indexer::new(source()).run().expect("no error");
    let flight = &file.flights[0];
    let middle = SimTime(flight.first().0.midpoint(flight.last().0));
    let (sample, taken) = measured(|| flight.sample(source(), middle).expect("no error"));
    assert!(sample.is_some());
    assert!(taken.peak <= 512 * KIB, "{taken:?}");
}
