//! The header of a log: text lines before the first frame.

mod error;
mod finding;
mod firmware;
mod interval;
mod lines;
#[cfg(test)]
mod tests;

use super::super::field::{Field, FrameKind, Predictor};
use super::constants::Constants;
use super::layout::Layout;
use lines::Lines;

pub(super) use interval::Interval;

pub use error::HeaderError;
pub use finding::HeaderFinding;
pub use firmware::{FirmwareName, Version};

/// The most bytes of a header. Real ones have at most 10 kB.
pub(super) const MAX_HEADER: usize = 32 * 1024;
/// The most lines of a header. Real ones have at most 300.
const MAX_LINES: usize = 1000;
/// The value of `minthrottle` if a header lacks it: the default of most firmwares.
const MIN_THROTTLE: i32 = 1070;
/// The lower value of `motorOutput` if a header lacks it: that of PWM.
const MIN_MOTOR: i32 = 1000;

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
    /// The kinds of frames that the log may have without their definition.
    undefined: Vec<FrameKind>,
    findings: Vec<HeaderFinding>,
}

impl Header {
    /// Reads the header at the start of `bytes`. Returns it with its length. `is_whole` is `true` if no bytes follow `bytes`.
    ///
    /// # Errors
    ///
    /// Returns the reason for which the log cannot be read.
    pub(super) fn read(bytes: &[u8], is_whole: bool) -> Result<(Self, usize), HeaderError> {
        let (lines, length) = Lines::read(bytes)?;
        let mut findings = lines.damaged().to_vec();
        match lines.value("Data version") {
            Some("2") => {}
            None => findings.push(HeaderFinding::of(&lines, "Data version", "version 2 is assumed")),
            Some(other) => return Err(HeaderError::DataVersion(other.to_owned())),
        }
        let rest = &bytes[length..];
        let is_in_line = rest.first() == Some(&b'H') && rest.iter().all(|byte| (b' '..=b'~').contains(byte));
        if is_whole && is_in_line {
            return Err(HeaderError::Cut);
        }
        let cut = |error| if is_whole && rest.is_empty() { HeaderError::Cut } else { error };
        let mut intra = lines.layout('I', 'I').map_err(cut)?;
        let inter = lines.layout('I', 'P').map_err(cut)?;
        let place = |name: &'static str| intra.place(name).ok_or(HeaderError::NoField(name));
        let (iteration_at, time_at) = (place("loopIteration")?, place("time")?);
        let (firmware, version) = firmware::of(&lines, &mut findings);
        let interval = Interval::of(&lines, &mut findings);
        let constants = Constants::of(&lines, &mut intra, &mut findings);
        let [slow, home, gps] = ['S', 'H', 'G'].map(|frame| lines.side_layout(frame, &mut findings));
        let mut header = Self {
            firmware,
            version,
            iteration_at,
            time_at,
            slow,
            home,
            gps,
            interval,
            constants,
            intra,
            inter,
            lines,
            undefined: Vec::new(),
            findings,
        };
        header.find_undefined();
        Ok((header, length))
    }

    /// Finds the kinds of frames that the log may have without their definition: a part of it is there, or frames that need them
    /// are defined, or the header is damaged.
    fn find_undefined(&mut self) {
        let is_damaged = !self.lines.damaged().is_empty();
        let coordinates = self.gps.as_ref().is_some_and(|gps| gps.predicts(Predictor::HomeCoordinate));
        let has_home = self.home.is_some();
        for (kind, is_needed) in
            [(FrameKind::Slow, false), (FrameKind::GpsHome, coordinates), (FrameKind::Gps, has_home)]
        {
            let letter = char::from(kind.letter());
            let has_part = self.lines().any(|(name, _)| name.starts_with(&format!("Field {letter} ")));
            if self.layout(kind).is_some() || !(has_part || is_needed || is_damaged) {
                continue;
            }
            self.undefined.push(kind);
            if has_part || is_needed {
                let is_home = kind == FrameKind::GpsHome && coordinates;
                let rest = if is_home { ", and places count from an unknown home" } else { "" };
                self.findings.push(HeaderFinding::undefined(letter, rest));
            }
        }
    }

    /// Returns what is wrong with the lines, and what is assumed for decoding. A unit may rest on more lines.
    pub fn findings(&self) -> &[HeaderFinding] {
        &self.findings
    }

    /// Returns a finding about a line that is missing, or whose value cannot be used. `assumed` is a clause without its full
    /// stop.
    pub fn finding(&self, line: &str, assumed: &str) -> HeaderFinding {
        HeaderFinding::of(&self.lines, line, assumed)
    }

    /// Returns `true` if the log may have frames of this kind although the header does not define them.
    pub(super) fn may_have_undefined(&self, kind: FrameKind) -> bool {
        self.undefined.contains(&kind)
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

impl Constants {
    /// Returns the numbers of the predictors that whole main frames have.
    fn of(lines: &Lines, intra: &mut Layout, findings: &mut Vec<HeaderFinding>) -> Self {
        let mut number = |predictor, line: &str, otherwise: i32, assumed: &str| {
            lines.number(line).unwrap_or_else(|| {
                if intra.predicts(predictor) {
                    findings.push(HeaderFinding::of(lines, line, assumed));
                    // A difference from an unknown number may be below zero.
                    if otherwise == 0 {
                        intra.sign(predictor);
                    }
                }
                otherwise
            })
        };
        Self {
            min_throttle: number(
                Predictor::MinThrottle,
                "minthrottle",
                MIN_THROTTLE,
                &format!("{MIN_THROTTLE} is assumed"),
            ),
            vbat_reference: number(
                Predictor::VbatReference,
                "vbatref",
                0,
                "the voltage at arming is unknown, and voltages are differences from it",
            ),
            min_motor: number(
                Predictor::MinMotor,
                "motorOutput",
                MIN_MOTOR,
                &format!("{MIN_MOTOR} for idling motors and 2000 for full thrust are assumed"),
            ),
        }
    }
}
