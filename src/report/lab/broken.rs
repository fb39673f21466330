//! Broken properties.

use std::collections::BTreeMap;

use super::{ANSWERS, LabFlight, properties};
use crate::campaign::mcnemar;
use crate::report::check::CheckedFlight;
use crate::scenario::Outcome;
use crate::signals::SimTime;

/// The flights that break a property which the build before the change never broke, for it to count as worse. One flight can
/// do so by chance.
const SEVERAL: usize = 2;

/// A property that the build to judge broke, or that only the build before it broke.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::report) struct Broken {
    /// The property.
    pub(in crate::report) label: String,
    /// The flights in which it is judged.
    pub(in crate::report) judged: usize,
    /// The flights that break it.
    pub(in crate::report) flights: Vec<usize>,
    /// Those of them that did not before.
    pub(in crate::report) newly: Vec<usize>,
    /// The flights that no longer break it.
    pub(in crate::report) mended: Vec<usize>,
    /// The number of flights that broke it before.
    pub(in crate::report) before: usize,
    /// `true` if another build was flown.
    has_base: bool,
}

impl Broken {
    /// Returns `true` if the change made it worse and chance hardly explains that.
    pub(in crate::report) fn is_worse(&self) -> bool {
        let (newly, mended) = (self.newly.len(), self.mended.len());
        self.has_base
            && (self.before == 0 && newly >= SEVERAL
                || newly > mended && mcnemar(newly as u64, mended as u64).is_real())
    }

    /// Returns the part of the flights by which more break it than before.
    fn part(&self) -> f64 {
        (self.newly.len() as f64 - self.mended.len() as f64) / self.judged as f64
    }

    /// Returns `true` if every firmware keeps it in every flight; `false` for an expectation of a scenario.
    pub(in crate::report) fn is_general(&self) -> bool {
        self.label == ANSWERS || properties::LABELS.contains(&self.label.as_str())
    }

    /// Returns the flight that shows it: the first one that breaks it now and did not before, else the first.
    pub(in crate::report) fn example(&self) -> Option<usize> {
        self.newly.first().or(self.flights.first()).copied()
    }
}

/// Returns the properties that a build broke, those first that the change broke in the greatest part of their flights.
pub(super) fn all(flights: &[LabFlight]) -> Vec<Broken> {
    let mut found: BTreeMap<&str, Broken> = BTreeMap::new();
    for (index, flight) in flights.iter().enumerate() {
        let before = flight.base.as_ref().map(failures).unwrap_or_default();
        let now = failures(&flight.head);
        let has_base = flight.base.is_some();
        let judged_before = flight.base.as_ref().map(labels).unwrap_or_default();
        // Both sides must have judged it.
        let judged =
            labels(&flight.head).into_iter().filter(|label| !has_base || judged_before.contains(label));
        for label in judged {
            let broken = found.entry(label).or_insert_with(|| Broken {
                label: label.to_owned(),
                judged: 0,
                flights: Vec::new(),
                newly: Vec::new(),
                mended: Vec::new(),
                before: 0,
                has_base,
            });
            let (was, is) = (before.contains(&label), now.contains(&label));
            broken.judged += 1;
            broken.before += usize::from(was);
            if is {
                broken.flights.push(index);
            }
            match (was, is) {
                (false, true) if has_base => broken.newly.push(index),
                (true, false) => broken.mended.push(index),
                _ => {}
            }
        }
    }
    let mut broken: Vec<Broken> = found.into_values().collect();
    broken.retain(|broken| !broken.flights.is_empty() || !broken.mended.is_empty());
    broken.sort_by(|a, b| {
        let more = b.part().total_cmp(&a.part()).then(b.flights.len().cmp(&a.flights.len()));
        b.is_worse().cmp(&a.is_worse()).then(more)
    });
    broken
}

/// Returns the properties that are judged in a flight.
fn labels(flight: &CheckedFlight) -> Vec<&str> {
    let mut labels = vec![ANSWERS];
    for judgement in &flight.judgements {
        if !matches!(judgement.outcome, Outcome::Skipped(_)) && !labels.contains(&judgement.label.as_str()) {
            labels.push(&judgement.label);
        }
    }
    labels
}

/// Returns the properties that a flight broke.
fn failures(flight: &CheckedFlight) -> Vec<&str> {
    let problem = flight.problem.iter().map(|_| ANSWERS);
    problem.chain(flight.failures().map(|judgement| judgement.label.as_str())).collect()
}

/// Returns what was seen in a flight that broke a property, and when.
pub(super) fn seen<'f>(flight: &'f CheckedFlight, label: &str) -> (&'f str, SimTime) {
    if let (Some(problem), true) = (&flight.problem, label == ANSWERS) {
        return (problem, flight.ended_at);
    }
    let judgement = flight.failures().find(|judgement| judgement.label == label);
    match judgement.map(|judgement| &judgement.outcome) {
        Some(Outcome::Failed { sentence, at, .. }) => (sentence, at.unwrap_or(flight.ended_at)),
        Some(Outcome::NeverJudged(why)) => (why, flight.ended_at),
        _ => ("", flight.ended_at),
    }
}
