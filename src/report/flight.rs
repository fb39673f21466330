//! All that a report says about one flight, as plain data.
//!
//! `fly` and `check` fill a [`FlightReport`] from a flight, `replay` from the record of one. A part that is not known, such as the truth of a log, stays
//! empty and is left out of the report. `facts` and `margins` are the numbers, `pictures` draws them in the colours of `look`.

mod facts;
#[cfg(test)]
pub(super) mod fixture;
pub(super) mod look;
mod margins;
mod markdown;
mod past;
mod pictures;

use super::record::FlightRecord;
use super::route::Route;
use crate::geo::LocalFrame;
use crate::plan::feature::Feature;
use crate::signals::SimTime;
use crate::telemetry::FlightTruth;
pub(super) use facts::facts;
pub(super) use margins::{Margin, MarginRow, rows as margin_rows};
pub use markdown::markdown;
pub(super) use pictures::{Figure, figures, ground};

/// A flight.
#[derive(Debug, Clone, Default)]
pub struct FlightReport {
    /// The kind of the flight in a few words.
    pub kind: String,
    /// The name of the plan, or of the log.
    pub name: String,
    pub verdict: Verdict,
    /// Facts that the record does not have, such as the firmware: name and value.
    pub facts: Vec<(String, String)>,
    pub record: FlightRecord,
    /// The plan in metres, if there is one.
    pub route: Option<Route>,
    /// Radius of the fence around home, m.
    pub fence_m: Option<f64>,
    /// The frame of the record's places.
    pub frame: Option<LocalFrame>,
    /// The map under the flight.
    pub backdrop: Vec<Feature>,
    /// The height of the ground under the craft above that at home, m.
    pub ground: Vec<(SimTime, f64)>,
    pub truth: FlightTruth,
    /// The allowed distance beyond a waypoint's own radius, and from its altitude, m; `None` = the waypoints are not
    /// judged.
    pub tolerance_m: Option<f64>,
    /// Simulated seconds from the engagement (or boot, if there was none) to the end.
    pub flown_s: Option<f64>,
    pub settings: Option<ReportedSettings>,
    /// The command that gives this flight again.
    pub command: Option<String>,
}

/// The result of a flight, or of several.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Verdict {
    /// `None` = nothing was judged.
    pub passed: Option<bool>,
    /// A word or a few.
    pub word: String,
    /// The reason as a sentence; may be empty.
    pub reason: String,
}

impl Verdict {
    /// Returns the mark before the word.
    pub(super) fn symbol(&self) -> &'static str {
        match self.passed {
            Some(true) => "✓",
            Some(false) => "✗",
            None => "–",
        }
    }

    /// Returns the class of the element.
    pub(super) fn class(&self) -> &'static str {
        match self.passed {
            Some(true) => "passed",
            Some(false) => "failed",
            None => "",
        }
    }

    /// Returns the mark in Markdown.
    pub(super) fn emoji(&self) -> &'static str {
        match self.passed {
            Some(true) => "✅",
            Some(false) => "❌",
            None => "–",
        }
    }
}

/// The settings that a reader needs to know.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ReportedSettings {
    /// Those that differ from their defaults: name, value, default.
    Changed(Vec<[String; 3]>),
    /// The command lines that a remote firmware got, which keeps its settings itself.
    Sent(Vec<String>),
    /// Those in the header of a log: name, value, and the default if the embedded firmware has the setting.
    Logged {
        /// Those that differ from their defaults.
        changed: Vec<[String; 3]>,
        /// The other lines of the header.
        others: Vec<[String; 3]>,
    },
}

/// The most points, rows and so on of a report. A report that is too large is written again with less.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Detail {
    /// Points of a line.
    pub(super) points: usize,
    /// Rows of a table.
    pub(super) rows: usize,
    /// Sentences of the log.
    pub(super) sentences: usize,
    /// `true` for the pictures and tables of a page with one flight.
    pub(super) is_whole: bool,
}

impl Detail {
    /// The detail of a page with one flight.
    pub(super) const WHOLE: Self = Self { points: 1500, rows: 400, sentences: 600, is_whole: true };
    /// The detail of one of many flights.
    pub(super) const SHORT: Self = Self { points: 300, rows: 60, sentences: 0, is_whole: false };

    /// Returns half of it; `None` if there is nothing left to leave out.
    pub(super) fn halved(self) -> Option<Self> {
        let Self { points, rows, sentences, is_whole } = self;
        (points > 2).then_some(Self {
            points: points / 2,
            rows: rows / 2,
            sentences: sentences / 2,
            is_whole,
        })
    }
}
