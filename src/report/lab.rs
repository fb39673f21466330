//! `lab`: a programme of flights on one or two builds of a firmware: which properties broke, and which measures changed.
//!
//! `properties` judges each flight, `measures` takes the numbers that all flights have in common. `finding` compares the
//! numbers of both builds, flight by flight, and `broken` their failures. `text`, `markdown` and `json` give the answer,
//! `likeness` the spreads of both, `values` the signals of a flight.

mod broken;
mod finding;
mod json;
mod likeness;
mod markdown;
mod measures;
mod properties;
mod text;
mod values;

#[cfg(test)]
mod tests;

use std::collections::BTreeSet;

pub(super) use broken::Broken;
pub(super) use finding::{Finding, Kind};
pub use measures::{LabMeasure, common, measures_of, measures_of_case};
pub use properties::{ANSWERS, properties};
pub use values::values;

use super::check::CheckedFlight;

/// A flight of the programme.
#[derive(Debug, Clone, PartialEq)]
pub struct LabFlight {
    /// The flight of the build before the change; `None` if only one build is flown.
    pub base: Option<CheckedFlight>,
    /// The flight of the build to judge.
    pub head: CheckedFlight,
}

/// The programme, flown.
#[derive(Debug, Clone, PartialEq)]
pub struct Lab {
    /// The name of the build before the change; `None` if only one build is flown.
    base: Option<String>,
    head: String,
    flights: Vec<LabFlight>,
    /// The number of flights in the whole programme.
    wanted: usize,
    /// The duration in seconds of wall time.
    wall_s: f64,
    /// Changed measures, the most important first.
    findings: Vec<Finding>,
    /// The number of measures that were compared.
    compared: usize,
    /// The properties that the build to judge broke, the most important first.
    broken: Vec<Broken>,
}

impl Lab {
    /// Compares and judges the flights. `measures` has each measure once, `wanted` is the number of flights in the whole
    /// programme.
    pub fn new(
        names: (Option<String>, String),
        measures: &[LabMeasure],
        flights: Vec<LabFlight>,
        wanted: usize,
        wall_s: f64,
    ) -> Self {
        let (findings, compared) = finding::all(measures, &flights);
        let broken = broken::all(&flights);
        let (base, head) = names;
        Self { base, head, flights, wanted, wall_s, findings, compared, broken }
    }

    /// Returns `true` if the build is worse than the one before it; if it is alone, if it broke a property that every firmware
    /// keeps.
    pub fn is_worse(&self) -> bool {
        match self.base {
            Some(_) => {
                self.findings.iter().any(|finding| finding.kind == Kind::Worse)
                    || self.broken.iter().any(Broken::is_worse)
            }
            None => self.broken.iter().any(Broken::is_general),
        }
    }

    /// Returns the answer for people, in about ten lines.
    pub fn text(&self) -> String {
        text::answer(self)
    }

    /// Returns the whole answer as Markdown, with the command that gives it again.
    pub fn markdown(&self, command: Option<&str>) -> String {
        markdown::markdown(self, command)
    }

    /// Returns the likeness of both builds as a page in Markdown, with the command that prints it again.
    pub fn likeness(&self, command: Option<&str>) -> String {
        likeness::page(self, command)
    }

    /// Returns the whole answer and all flights as JSON.
    pub fn json(&self) -> String {
        json::object(self)
    }

    /// Returns the flights of the build to judge.
    pub fn heads(&self) -> impl Iterator<Item = &CheckedFlight> {
        self.flights.iter().map(|flight| &flight.head)
    }

    /// Returns the duration of the flights in seconds of wall time.
    pub fn wall_s(&self) -> f64 {
        self.wall_s
    }

    /// Returns the number of flights in the whole programme.
    pub fn wanted(&self) -> usize {
        self.wanted
    }

    /// Returns the changed measures, the most important first.
    pub(super) fn findings(&self) -> &[Finding] {
        &self.findings
    }

    /// Returns the broken properties of the answer: of two builds, those that the change broke.
    pub(super) fn shown(&self) -> impl Iterator<Item = &Broken> {
        self.broken.iter().filter(|broken| match self.base {
            Some(_) => !broken.newly.is_empty(),
            None => !broken.flights.is_empty(),
        })
    }

    /// Returns a broken property with its flights and what was seen.
    pub(super) fn broken_line(&self, broken: &Broken) -> String {
        text::broken_line(self, broken)
    }

    /// Returns the command that shows the flight with the greatest change of a measure.
    pub(super) fn open(&self, finding: &Finding) -> Option<String> {
        let flight = &self.flights.get(finding.example)?.head;
        flight.open_command(flight.ended_at)
    }

    /// Returns the command that shows a broken property.
    pub(super) fn open_broken(&self, broken: &Broken) -> Option<String> {
        let flight = &self.flights.get(broken.example()?)?.head;
        flight.open_command(broken::seen(flight, &broken.label).1)
    }

    /// Returns the names of the builds.
    pub(super) fn title(&self) -> String {
        match &self.base {
            Some(base) => format!("{base} → {}", self.head),
            None => self.head.clone(),
        }
    }

    /// Returns the number of flights and their speed in words.
    pub(super) fn flown(&self) -> String {
        let sides = if self.base.is_some() { 2.0 } else { 1.0 };
        let flown_s = self.flights.iter().map(LabFlight::flown_s).fold(0.0, |sum, flown_s| sum + flown_s);
        let each = if sides > 1.0 { " on each" } else { "" };
        let of = match self.flights.len() {
            all if all == self.wanted => counted(all, "flight", "flights"),
            some => format!("{some} of {}", counted(self.wanted, "flight", "flights")),
        };
        format!(
            "{of}{each}, {flown_s:.0} s flown in {:.0} s ({:.0}x real time)",
            self.wall_s,
            flown_s / self.wall_s.max(1e-3)
        )
    }

    /// Returns the counts of what changed, as a sentence.
    pub(super) fn verdict(&self) -> String {
        if self.flights.is_empty() {
            return "Nothing was flown.".to_owned();
        }
        if self.base.is_none() {
            let general = self.broken.iter().filter(|broken| broken.is_general()).count();
            return match (general, self.broken.len() - general) {
                (0, 0) => "Every property was kept.".to_owned(),
                (general, of_scenarios) => format!(
                    "{} and {} were not met.",
                    counted(general, "property", "properties"),
                    counted(of_scenarios, "expectation of a scenario", "expectations of scenarios")
                ),
            };
        }
        let differing = self.flights.iter().filter(|flight| !flight.is_identical()).count();
        if differing == 0 {
            return "No difference: all flights are the same to the last bit.".to_owned();
        }
        let of = |kind: Kind| self.findings.iter().filter(|finding| finding.kind == kind).count();
        let broken: BTreeSet<usize> = self.broken.iter().flat_map(|broken| &broken.newly).copied().collect();
        let fail = match broken.len() {
            0 => String::new(),
            1 => ", 1 flight breaks a property that it kept before".to_owned(),
            count => format!(", {count} flights break a property that they kept before"),
        };
        let changed = match self.findings.len() {
            0 => format!("No significant change of {} measures", self.compared),
            changed => format!(
                "{changed} of {} measures changed, {} worse, {} better",
                self.compared,
                of(Kind::Worse),
                of(Kind::Better)
            ),
        };
        format!(
            "{changed}{fail}. {differing} of {} differ.",
            counted(self.flights.len(), "flight", "flights")
        )
    }
}

/// Returns a number with its word.
fn counted(count: usize, one: &str, several: &str) -> String {
    if count == 1 { format!("1 {one}") } else { format!("{count} {several}") }
}

impl LabFlight {
    /// Returns `true` if both builds flew the same to the last bit.
    pub(super) fn is_identical(&self) -> bool {
        let is_same = |base: &CheckedFlight| base.problem.is_none() && base.hash == self.head.hash;
        self.head.problem.is_none() && self.base.as_ref().is_some_and(is_same)
    }

    fn flown_s(&self) -> f64 {
        self.head.flown_s + self.base.as_ref().map_or(0.0, |base| base.flown_s)
    }
}
