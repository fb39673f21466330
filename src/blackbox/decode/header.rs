//! The header of a log: text lines before the first frame.

mod error;
mod firmware;
mod lines;

use super::super::field::{Field, FrameKind};
use super::layout::Layout;
use lines::Lines;

pub use error::HeaderError;
pub use firmware::{FirmwareName, Version};

/// The most bytes of a header. Real ones have at most 10 kB.
pub(super) const MAX_HEADER: usize = 32 * 1024;
/// The most lines of a header. Real ones have at most 300.
const MAX_LINES: usize = 1000;

/// The header of a log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Header {
    lines: Lines,
    pub firmware: FirmwareName,
    /// The version of the firmware; zeros if the header names none.
    pub version: Version,
    pub(super) intra: Layout,
    pub(super) inter: Layout,
    pub(super) slow: Option<Layout>,
    pub(super) home: Option<Layout>,
    pub(super) gps: Option<Layout>,
    pub(super) interval: Interval,
    pub(super) constants: Constants,
    /// The places of loopIteration and time in main frames.
    pub(super) iteration_at: usize,
    pub(super) time_at: usize,
}

/// The loop iterations that are logged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Interval {
    /// The distance of whole main frames.
    intra: u64,
    /// `shown` of `of` iterations are logged.
    shown: u64,
    of: u64,
}

/// The header's numbers to which predictors add.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Constants {
    pub(super) min_throttle: i32,
    pub(super) vbat_reference: i32,
    pub(super) min_motor: i32,
}

impl Header {
    /// Reads the header at the start of `bytes`. Returns it with its length. `is_whole` is `true` if no bytes follow `bytes`.
    ///
    /// # Errors
    ///
    /// Returns the reason for which the log cannot be read.
    pub(super) fn read(bytes: &[u8], is_whole: bool) -> Result<(Self, usize), HeaderError> {
        let (lines, length) = Lines::read(bytes)?;
        match lines.value("Data version") {
            None | Some("2") => {}
            Some(other) => return Err(HeaderError::DataVersion(other.to_owned())),
        }
        let rest = &bytes[length..];
        let is_in_line = rest.first() == Some(&b'H') && rest.iter().all(|byte| (b' '..=b'~').contains(byte));
        if is_whole && is_in_line {
            return Err(HeaderError::Cut);
        }
        let cut = |error| if is_whole && rest.is_empty() { HeaderError::Cut } else { error };
        let intra = lines.layout('I', 'I').map_err(cut)?;
        let inter = lines.layout('I', 'P').map_err(cut)?;
        let place = |name: &'static str| intra.place(name).ok_or(HeaderError::NoField(name));
        let (iteration_at, time_at) = (place("loopIteration")?, place("time")?);
        // Without the definition of another frame its frames are skipped.
        let other = |letter| lines.layout(letter, letter).ok();
        let (firmware, version) = firmware::of(&lines);
        let header = Self {
            firmware,
            version,
            iteration_at,
            time_at,
            slow: other('S'),
            home: other('H'),
            gps: other('G'),
            interval: Interval::of(&lines),
            constants: Constants::of(&lines),
            intra,
            inter,
            lines,
        };
        Ok((header, length))
    }

    /// Returns the value of the first line with this name, as it is in the log.
    pub fn value(&self, name: &str) -> Option<&str> {
        self.lines.value(name)
    }

    /// Returns the whole number of a line; of a list its first one.
    pub fn number(&self, name: &str) -> Option<i32> {
        self.lines.number(name)
    }

    /// Returns all lines in their order, each as name and value.
    pub fn lines(&self) -> impl Iterator<Item = (&str, &str)> {
        self.lines.iter()
    }

    /// Returns the fields of a kind of frame; none for events and for frames that the log does not define.
    pub fn fields(&self, kind: FrameKind) -> &[Field] {
        self.layout(kind).map_or(&[], Layout::fields)
    }

    pub(super) fn layout(&self, kind: FrameKind) -> Option<&Layout> {
        match kind {
            FrameKind::Intra => Some(&self.intra),
            FrameKind::Inter => Some(&self.inter),
            FrameKind::Slow => self.slow.as_ref(),
            FrameKind::GpsHome => self.home.as_ref(),
            FrameKind::Gps => self.gps.as_ref(),
            FrameKind::Event => None,
        }
    }
}

impl Interval {
    fn of(lines: &Lines) -> Self {
        let positive =
            |value: Option<i32>| value.and_then(|value| u64::try_from(value).ok()).unwrap_or(1).max(1);
        let intra = positive(lines.number("I interval"));
        // Old firmwares write a fraction.
        let text = lines.value("P interval").unwrap_or_default();
        let (shown, of) = text.split_once('/').unwrap_or(("1", text));
        let [shown, of] = [shown, of].map(|part| positive(part.trim().parse().ok()));
        Self { intra, shown, of }
    }

    /// Returns the number of iterations after `iteration` that are not logged.
    pub(super) fn skipped_after(self, iteration: u32) -> u32 {
        let place = (u64::from(iteration) + 1) % self.intra;
        let phase = (place + self.shown - 1) % self.of;
        let skipped = if phase < self.shown { 0 } else { (self.of - phase).min(self.intra - place) };
        u32::try_from(skipped).unwrap_or(u32::MAX)
    }
}

impl Constants {
    fn of(lines: &Lines) -> Self {
        Self {
            min_throttle: lines.number("minthrottle").unwrap_or_default(),
            vbat_reference: lines.number("vbatref").unwrap_or_default(),
            min_motor: lines.number("motorOutput").unwrap_or_default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn interval(intra: u64, shown: u64, of: u64) -> Interval {
        Interval { intra, shown, of }
    }

    /// Counts one by one.
    fn counted(of: Interval, iteration: u32) -> u32 {
        let is_shown = |at: u64| (at % of.intra + of.shown - 1) % of.of < of.shown;
        (0..).find(|more| is_shown(u64::from(iteration) + 1 + u64::from(*more))).unwrap()
    }

    #[test]
    fn iterations_that_are_not_logged_are_counted() {
        for (intra, shown, of) in
            [(32, 1, 4), (32, 1, 1), (32, 2, 3), (32, 5, 3), (32, 1, 64), (1, 1, 1), (30, 1, 7)]
        {
            let interval = interval(intra, shown, of);
            for iteration in 0..200 {
                assert_eq!(
                    interval.skipped_after(iteration),
                    counted(interval, iteration),
                    "{interval:?} {iteration}"
                );
            }
        }
        assert_eq!(interval(32, 1, 4).skipped_after(u32::MAX), 0);
        assert_eq!(interval(i32::MAX as u64, 1, i32::MAX as u64).skipped_after(0), i32::MAX as u32 - 1);
    }
}
