//! The whole of a flight that is over, for a display.

use super::Picture;
use crate::geo::LatLon;
use crate::signals::SimTime;
use crate::telemetry::EventKind;
use crate::timeline::Marks;

/// Something that happened in the flight.
#[derive(Debug, Clone, PartialEq)]
pub struct PastEvent {
    pub time: SimTime,
    pub kind: PastEventKind,
}

/// The kinds of things that happened.
#[derive(Debug, Clone, PartialEq)]
pub enum PastEventKind {
    Vehicle(EventKind),
    /// A part of the record is damaged, as a sentence.
    Warning(String),
    /// Something else, as a sentence.
    Notice(String),
}

/// A named number that was recorded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Series {
    /// The name in the record, for example `gyroADC[0]`.
    pub name: String,
    /// The unit; empty if there is none, or if it is unknown.
    pub unit: &'static str,
    /// `true` if the values rest on something that the record lacks, so that it is assumed.
    pub is_assumed: bool,
}

impl Series {
    /// Returns a series whose values rest on no assumption.
    pub fn new(name: &str, unit: &'static str) -> Self {
        Self { name: name.to_owned(), unit, is_assumed: false }
    }
}

/// What a display needs of the whole flight.
#[derive(Debug, Default)]
pub struct Overview {
    /// The first and the last instant of the flight.
    pub first: SimTime,
    pub last: SimTime,
    /// The usual time between two records, µs.
    pub frame_us: u64,
    /// The position from which the pictures count, if it is known.
    pub origin: Option<LatLon>,
    /// Sentences about the record as a whole: its source, and what is damaged or missing.
    pub about: Vec<PastEventKind>,
    /// Events, oldest first.
    pub events: Vec<PastEvent>,
    /// The marks of the events, oldest first.
    pub marks: Marks,
    /// Pictures at equal intervals, oldest first; at most some ten thousand.
    pub pictures: Vec<Picture>,
    /// The recorded series by name.
    pub series: Vec<Series>,
}

impl Overview {
    /// Returns the usual number of records in a time, µs; at least one.
    pub fn frames_in(&self, time_us: u64) -> u32 {
        u32::try_from(time_us / self.frame_us.max(1)).unwrap_or(u32::MAX).max(1)
    }
}
