//! The fields of a log, and the header lines that define them.

use std::fmt;

use arrayvec::ArrayVec;

use super::group::{FieldGroup, Rule};
use crate::blackbox::{Encoding, FrameKind};

/// The most fields of a frame.
pub const MAX_FIELDS: usize = 64;
/// The most groups of a frame.
const MAX_GROUPS: usize = 32;

/// Numbers of the header on which predictions are based.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LogConstants {
    /// The loops from one main frame to the next.
    pub p_interval: u32,
    /// `minthrottle`, µs.
    pub min_throttle: i32,
    /// The lower number of `motorOutput`, µs.
    pub min_motor: i32,
    /// `vbatref`, in units of the field.
    pub vbat_reference: i32,
}

/// The fields of all frames of a log.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct LogLayout {
    main: ArrayVec<FieldGroup, MAX_GROUPS>,
    slow: ArrayVec<FieldGroup, MAX_GROUPS>,
    home: ArrayVec<FieldGroup, MAX_GROUPS>,
    gps: ArrayVec<FieldGroup, MAX_GROUPS>,
}

/// The property of fields that a header line lists.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Property {
    Name,
    Signed,
    Predictor,
    Encoding,
}

/// The field lines of a header. Frames without fields have no lines.
const LINES: [(FrameKind, Property); 18] = [
    (FrameKind::Intra, Property::Name),
    (FrameKind::Intra, Property::Signed),
    (FrameKind::Intra, Property::Predictor),
    (FrameKind::Intra, Property::Encoding),
    (FrameKind::Inter, Property::Predictor),
    (FrameKind::Inter, Property::Encoding),
    (FrameKind::GpsHome, Property::Name),
    (FrameKind::GpsHome, Property::Signed),
    (FrameKind::GpsHome, Property::Predictor),
    (FrameKind::GpsHome, Property::Encoding),
    (FrameKind::Gps, Property::Name),
    (FrameKind::Gps, Property::Signed),
    (FrameKind::Gps, Property::Predictor),
    (FrameKind::Gps, Property::Encoding),
    (FrameKind::Slow, Property::Name),
    (FrameKind::Slow, Property::Signed),
    (FrameKind::Slow, Property::Predictor),
    (FrameKind::Slow, Property::Encoding),
];

impl LogLayout {
    /// Adds fields at the end of the frames of this kind. Returns `false` if there is no room for them.
    #[must_use]
    pub fn add(&mut self, kind: FrameKind, group: FieldGroup) -> bool {
        let has_room = self.len(kind) + group.names.len() <= MAX_FIELDS;
        let groups = match kind {
            FrameKind::Intra | FrameKind::Inter => &mut self.main,
            FrameKind::Slow => &mut self.slow,
            FrameKind::GpsHome => &mut self.home,
            FrameKind::Gps => &mut self.gps,
            FrameKind::Event => return false,
        };
        has_room && groups.try_push(group).is_ok()
    }

    /// Returns the groups of fields of the frames of this kind. The two kinds of main frames have the same ones.
    pub fn groups(&self, kind: FrameKind) -> &[FieldGroup] {
        match kind {
            FrameKind::Intra | FrameKind::Inter => &self.main,
            FrameKind::Slow => &self.slow,
            FrameKind::GpsHome => &self.home,
            FrameKind::Gps => &self.gps,
            FrameKind::Event => &[],
        }
    }

    /// Returns the number of fields of the frames of this kind.
    pub fn len(&self, kind: FrameKind) -> usize {
        self.groups(kind).iter().map(|group| group.names.len()).sum()
    }

    /// Returns the number of header lines, including those that are empty.
    pub fn lines(&self) -> usize {
        LINES.len()
    }

    /// Returns the header line with this number, from 0; `None` after the last one. A line of a frame that the log does
    /// not have is empty.
    pub fn line(&self, number: usize) -> Option<FieldLine<'_>> {
        let &(kind, property) = LINES.get(number)?;
        Some(FieldLine { kind, property, groups: self.groups(kind) })
    }
}

/// A header line about the fields of a frame. `Display` gives it with its line feed.
#[derive(Debug, Clone, Copy)]
pub struct FieldLine<'a> {
    kind: FrameKind,
    property: Property,
    groups: &'a [FieldGroup],
}

impl fmt::Display for FieldLine<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.groups.is_empty() {
            return Ok(());
        }
        let property = match self.property {
            Property::Name => "name",
            Property::Signed => "signed",
            Property::Predictor => "predictor",
            Property::Encoding => "encoding",
        };
        write!(f, "H Field {} {property}", char::from(self.kind.letter()))?;
        let mut separator = ':';
        for group in self.groups {
            let Rule(predictor, coding) =
                if self.kind == FrameKind::Intra { group.intra } else { group.rule };
            for name in group.names {
                write!(f, "{separator}")?;
                match self.property {
                    Property::Name => f.write_str(name)?,
                    Property::Signed => write!(f, "{}", u8::from(group.signed))?,
                    Property::Predictor => write!(f, "{}", predictor as u8)?,
                    Property::Encoding => write!(f, "{}", Encoding::from(coding) as u8)?,
                }
                separator = ',';
            }
        }
        f.write_str("\n")
    }
}
