//! The end of a recording, which is found without reading the rest.

use std::io::{self, BufRead};
use std::ops::ControlFlow;
use std::path::PathBuf;

use serde::Deserialize;

use super::error::ReadError;
use super::lines::{Rest, each};
use super::record::{End, Header, Record};
use crate::signals::SimTime;

/// The name in the header of the last gzip member.
pub(super) const LAST_MEMBER: &[u8] = b"end";
/// The first bytes of that member: the magic number, deflate, a name, no time, no level, no system.
const LAST_HEADER: [u8; 10] = [0x1f, 0x8b, 8, 8, 0, 0, 0, 0, 0, 255];
/// The longest last member, bytes.
pub const TAIL: usize = 16 << 10;

/// What a list of recordings shows of one.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Summary {
    pub header: Header,
    /// The end; `None` if the recording has none.
    pub end: Option<End>,
    /// The time from the arming to the last picture of a recording without an end, s.
    pub seen_s: f64,
}

/// A recording in a library.
#[derive(Debug, Clone, PartialEq)]
pub struct Listed {
    pub file: PathBuf,
    pub bytes: u64,
    /// `true` while its flight is being recorded.
    pub is_growing: bool,
    /// What it says of itself, or the reason why it cannot be read, the end of a sentence.
    pub summary: Result<Summary, String>,
}

impl Summary {
    /// Returns the duration, s.
    pub fn flown_s(&self) -> f64 {
        self.end.as_ref().map_or(self.seen_s, |end| end.flown_s)
    }
}

/// Returns the summary of a recording from its first and its last [`TAIL`] bytes, which may overlap. One without an end
/// has no duration yet: see [`seen_s`].
///
/// # Errors
/// Fails if it is no recording of a version that is read.
pub fn read_summary(head: &[u8], tail: &[u8]) -> Result<Summary, ReadError> {
    let mut first = None;
    let _rest = each(head, |line| {
        first = serde_json::from_slice::<Record>(line).ok();
        ControlFlow::Break(())
    });
    let Some(Record::Flight(header)) = first else { return Err(ReadError::NoRecording) };
    header.check()?;
    Ok(Summary { header, end: end(tail), seen_s: 0.0 })
}

/// Returns the last line if the file ends with it.
fn end(tail: &[u8]) -> Option<End> {
    let mark: Vec<u8> = LAST_HEADER.iter().chain(LAST_MEMBER).chain(&[0]).copied().collect();
    let at = tail.windows(mark.len()).rposition(|window| window == mark)?;
    let mut found = None;
    let rest = each(tail.get(at..)?, |line| {
        found = serde_json::from_slice::<Record>(line).ok();
        ControlFlow::Continue(())
    });
    match found {
        Some(Record::End(end)) if matches!(rest, Ok(Rest::Whole)) => Some(end),
        _ => None,
    }
}

/// The beginnings of two kinds of lines.
const PICTURE: &[u8] = b"{\"picture\"";
const BRANCH: &[u8] = b"{\"branch\"";

/// A picture as far as it says when the craft was armed.
#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum Timed {
    Picture { t: SimTime, craft: Craft },
}

#[derive(Deserialize)]
struct Craft {
    armed: Option<bool>,
}

/// Returns the time from the arming to the last picture of a recording without an end, s.
///
/// # Errors
/// Fails if the source cannot be read.
pub fn seen_s(source: impl BufRead) -> io::Result<f64> {
    let (mut armed_at, mut last) = (None, SimTime::ZERO);
    // The newest line may be torn.
    let (mut newest, mut before) = (Vec::new(), Vec::new());
    // Only pictures that may be the first after the arming are read: that takes most of the time.
    let mut is_read = true;
    each(source, |line| {
        if line.starts_with(BRANCH) {
            // The flight may continue from an instant before the arming.
            is_read = true;
        } else if line.starts_with(PICTURE) {
            std::mem::swap(&mut newest, &mut before);
            newest.clear();
            newest.extend_from_slice(line);
            if let Some(Timed::Picture { t, craft }) = is_read.then(|| timed(line)).flatten() {
                last = t;
                armed_at = armed_at.filter(|armed_at| *armed_at <= t);
                if craft.armed == Some(true) {
                    armed_at.get_or_insert(t);
                }
                is_read = armed_at.is_none();
            }
        }
        ControlFlow::Continue(())
    })?;
    if let Some(Timed::Picture { t, .. }) = timed(&newest).or_else(|| timed(&before)) {
        last = t;
    }
    Ok(armed_at.map_or(0.0, |armed_at| last.seconds_since(armed_at)))
}

fn timed(line: &[u8]) -> Option<Timed> {
    serde_json::from_slice(line).ok()
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use super::*;

    #[test]
    fn a_flight_that_was_continued_before_its_arming_is_seen_from_the_next_one() {
        let picture = |t_s: u64, armed| {
            format!("{{\"picture\":{{\"t\":{},\"craft\":{{\"armed\":{armed}}}}}}}\n", t_s * 1_000_000)
        };
        let seen = |lines: &[String]| {
            let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
            encoder.write_all(lines.concat().as_bytes()).unwrap();
            seen_s(&encoder.finish().unwrap()[..]).unwrap()
        };
        let branch = "{\"branch\":{\"t\":1000000,\"inputs\":3}}\n".to_owned();
        let mut lines = vec![picture(1, false), picture(2, true), picture(3, true), picture(9, true)];
        assert!((seen(&lines) - 7.0).abs() < 1e-9);
        lines.extend([branch.clone(), picture(1, false), picture(4, true), picture(6, true)]);
        assert!((seen(&lines) - 2.0).abs() < 1e-9);
        // The arming stays that of the flight before.
        lines.extend([branch.replace('1', "5"), picture(5, true), picture(7, false)]);
        assert!((seen(&lines) - 3.0).abs() < 1e-9);
        assert!(seen(&[picture(1, false), picture(8, false)]).abs() < 1e-9);
    }

    #[test]
    fn a_torn_last_picture_leaves_the_time_up_to_the_one_before() {
        let picture = |t_s: u64| {
            format!("{{\"picture\":{{\"t\":{},\"craft\":{{\"armed\":true}}}}}}\n", t_s * 1_000_000)
        };
        let lines = [picture(2), picture(3), picture(9), "{\"picture\":{\"t\":10000000,\"cra\n".to_owned()];
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        encoder.write_all(lines.concat().as_bytes()).unwrap();
        let seen_s = seen_s(&encoder.finish().unwrap()[..]).unwrap();
        assert!((seen_s - 7.0).abs() < 1e-9, "{seen_s}");
    }
}
