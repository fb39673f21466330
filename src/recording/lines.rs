//! The lines of a recording: gzip members, each of which is read as a whole, within bounds.

use std::io::{self, BufRead, Read as _};
use std::ops::ControlFlow;

use flate2::bufread::GzDecoder;

/// The most text of a member, bytes.
const MAX_MEMBER: usize = 16 << 20;
/// The most text of a recording, bytes: a day of flight has less.
const MAX_TEXT: usize = 1 << 30;

/// The state of a file after its last line that was read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Rest {
    /// The file ends there.
    #[default]
    Whole,
    /// The file was cut short, perhaps because its program was killed.
    CutShort,
    /// What follows is damaged.
    Damaged,
    /// What follows is more than is read.
    TooLong,
}

/// Passes the whole lines of a recording to `take`, without their ends, until it breaks.
///
/// # Errors
/// Fails if the source cannot be read.
pub(super) fn each(
    mut source: impl BufRead,
    mut take: impl FnMut(&[u8]) -> ControlFlow<()>,
) -> io::Result<Rest> {
    let mut left = MAX_TEXT;
    let mut text = Vec::new();
    loop {
        if source.fill_buf()?.is_empty() {
            return Ok(Rest::Whole);
        }
        text.clear();
        let most = MAX_MEMBER.min(left);
        let decoded = GzDecoder::new(&mut source).take(most as u64 + 1).read_to_end(&mut text);
        let rest = match decoded {
            // An error of the system, not of the decoder.
            Err(error) if error.raw_os_error().is_some() => return Err(error),
            Ok(count) if count > most => Rest::TooLong,
            Ok(_) => Rest::Whole,
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => Rest::CutShort,
            // The checksum of the whole member is wrong, so any line of it may be.
            Err(error) if is_checksum(&error) => return Ok(Rest::Damaged),
            Err(_) => Rest::Damaged,
        };
        left -= text.len().min(left);
        // A line without its end may be a part of one.
        let mut start = 0;
        for end in memchr::memchr_iter(b'\n', &text) {
            let line = text.get(start..end).unwrap_or_default();
            start = end + 1;
            if !line.is_empty() && take(line).is_break() {
                return Ok(rest);
            }
        }
        if rest != Rest::Whole {
            return Ok(rest);
        }
    }
}

/// Returns `true` for the error of a member whose bytes could be decoded, but are not those that were written.
fn is_checksum(error: &io::Error) -> bool {
    error.kind() == io::ErrorKind::InvalidInput && error.to_string().contains("checksum")
}
