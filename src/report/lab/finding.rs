//! Changed measures: the flights of both builds compared one by one.

use std::cmp::Ordering;

use super::{LabFlight, LabMeasure};
use crate::campaign::{Significance, signed_rank};
use crate::report::check::CheckedFlight;
use crate::scenario::Better;

/// The share of the value before below which no change is reported.
const SHARE: f64 = 0.01;

/// The standard deviation of a normal distribution whose median absolute deviation is 1.
const DEVIATION: f64 = 1.4826;

/// A measure that changed.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::report) struct Finding {
    pub(in crate::report) measure: LabMeasure,
    pub(in crate::report) kind: Kind,
    /// The median before, of the flights that differ, and this with the difference. Flights of different kinds have
    /// different values, so that a median after has little to do with the one before.
    pub(in crate::report) typical: [f64; 2],
    /// The estimated difference of these flights.
    pub(in crate::report) difference: f64,
    /// The flights that differ in the direction of that difference.
    pub(in crate::report) agreeing: usize,
    /// The flights that differ.
    pub(in crate::report) differing: usize,
    /// The flights that have the measure.
    pub(in crate::report) pairs: usize,
    /// The probability of such differences if the builds fly alike, corrected for the number of measures.
    pub(in crate::report) p: f64,
    /// The flight with the greatest difference in that direction.
    pub(in crate::report) example: usize,
    /// The difference in standard deviations of the differences.
    deviations: f64,
}

/// The meaning of a change for the pilot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, strum::Display, strum::IntoStaticStr)]
#[strum(serialize_all = "lowercase")]
pub(in crate::report) enum Kind {
    Worse,
    /// Neither better nor worse.
    Changed,
    Better,
}

/// A measure with the differences of its flights.
struct Compared<'a> {
    measure: &'a LabMeasure,
    /// The flights with the value before and after.
    pairs: Vec<(usize, [f64; 2])>,
    /// The flights that differ, with their difference.
    differing: Vec<(usize, f64)>,
    p: f64,
}

/// Returns the measures that changed, the most important first, and the number of measures that were compared.
///
/// A measure has changed if Wilcoxon's signed-rank test of the differences says so, after Holm's correction for the number
/// of measures that could be significant at all, and if the estimated difference is one that a pilot notices.
pub(super) fn all(measures: &[LabMeasure], flights: &[LabFlight]) -> (Vec<Finding>, usize) {
    let mut compared: Vec<Compared<'_>> = measures.iter().map(|measure| compare(measure, flights)).collect();
    compared.retain(|compared| !compared.pairs.is_empty());
    let count = compared.len();
    // With so few differing flights no difference is significant, so the measure takes no part in the correction.
    compared.retain(|compared| 2.0 * 0.5_f64.powi(compared.differing.len() as i32) < Significance::LEVEL);
    compared.sort_by(|a, b| a.p.total_cmp(&b.p));
    let tested = compared.len();
    let mut corrected = 0.0_f64;
    let mut findings = Vec::new();
    for (rank, compared) in compared.iter().enumerate() {
        corrected = corrected.max((compared.p * (tested - rank) as f64).min(1.0));
        if corrected < Significance::LEVEL {
            findings.extend(compared.finding(corrected));
        }
    }
    findings.sort_by(order);
    (findings, count)
}

/// Puts what is better last, and the others by their weight.
fn order(a: &Finding, b: &Finding) -> Ordering {
    let is_better = |finding: &Finding| finding.kind == Kind::Better;
    is_better(a).cmp(&is_better(b)).then(b.weight().total_cmp(&a.weight()))
}

fn compare<'a>(measure: &'a LabMeasure, flights: &[LabFlight]) -> Compared<'a> {
    let pairs: Vec<(usize, [f64; 2])> = flights
        .iter()
        .enumerate()
        .filter_map(|(index, flight)| Some((index, pair(measure, flight.base.as_ref()?, &flight.head)?)))
        .collect();
    let differences = pairs.iter().map(|(index, [base, head])| (*index, head - base));
    let differing: Vec<(usize, f64)> = differences.filter(|(_, difference)| *difference != 0.0).collect();
    let sizes: Vec<f64> = differing.iter().map(|(_, difference)| *difference).collect();
    Compared { measure, pairs, differing, p: signed_rank(&sizes).map_or(1.0, |found| found.p) }
}

/// Returns the values of both sides: the means over the waypoints for which both have one.
fn pair(measure: &LabMeasure, base: &CheckedFlight, head: &CheckedFlight) -> Option<[f64; 2]> {
    if measure.scenario.as_ref().is_some_and(|scenario| *scenario != head.scenario) {
        return None;
    }
    let is_of = |key: &str| {
        key.strip_prefix(measure.key.as_str()).is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
    };
    let (mut sums, mut count) = ([0.0; 2], 0_u32);
    for (key, before) in base.measures.iter().filter(|(key, value)| is_of(key) && value.is_finite()) {
        let after = head.measures.iter().find(|(other, value)| other == key && value.is_finite());
        let Some((_, after)) = after else { continue };
        sums = [sums[0] + before, sums[1] + after];
        count += 1;
    }
    (count > 0).then(|| sums.map(|sum| sum / f64::from(count)))
}

/// Returns the Hodges–Lehmann estimate of a difference, the median of the means of all pairs of differences. It goes with the
/// signed-rank test, also if a part of the flights hardly differs.
fn estimate(differences: &[f64]) -> Option<f64> {
    let means = differences.iter().enumerate().flat_map(|(index, one)| {
        differences.get(index..).unwrap_or_default().iter().map(move |other| f64::midpoint(*one, *other))
    });
    median(means)
}

impl Compared<'_> {
    /// Returns the finding; `None` if a pilot would not notice the difference.
    fn finding(&self, p: f64) -> Option<Finding> {
        let sizes: Vec<f64> = self.differing.iter().map(|(_, difference)| *difference).collect();
        let difference = estimate(&sizes)?;
        let differing = self.pairs.iter().filter(|(_, sides)| sides[0] != sides[1]);
        let before = median(differing.map(|(_, sides)| sides[0]))?;
        let typical = [before, before + difference];
        let least = smallest(self.measure.unit).max(SHARE * before.abs());
        if difference.abs() < least {
            return None;
        }
        let agrees = |found: f64| found * difference > 0.0;
        let example = self.differing.iter().filter(|(_, found)| agrees(*found));
        let example = example.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?.0;
        let kind = match (self.measure.better, difference > 0.0) {
            (None, _) => Kind::Changed,
            (Some(Better::Less), true) | (Some(Better::More), false) => Kind::Worse,
            _ => Kind::Better,
        };
        let center = median(sizes.iter().copied())?;
        let spread = DEVIATION * median(sizes.iter().map(|size| (size - center).abs()))?;
        Some(Finding {
            measure: self.measure.clone(),
            kind,
            typical,
            difference,
            agreeing: self.differing.iter().filter(|(_, found)| agrees(*found)).count(),
            differing: self.differing.len(),
            pairs: self.pairs.len(),
            p,
            example,
            deviations: difference.abs() / spread.max(1e-9),
        })
    }
}

impl Finding {
    /// Returns the change as a share of the measure, which makes measures of all units comparable. A measure near zero counts
    /// as a few of the smallest changes.
    pub(super) fn share(&self) -> f64 {
        let size = self.typical.iter().map(|value| value.abs()).fold(0.0, f64::max);
        self.difference.abs() / size.max(4.0 * smallest(self.measure.unit)).max(1e-9)
    }

    /// Returns the weight among the findings: how much the measure changed, in which part of the flights, and how clearly. A
    /// side effect often changes much in a few flights, or differently in each. A change for the worse counts twice.
    fn weight(&self) -> f64 {
        let part = self.differing as f64 / self.pairs as f64;
        let clarity = self.deviations / (1.0 + self.deviations);
        let kind = if self.kind == Kind::Worse { 2.0 } else { 1.0 };
        kind * self.share() * part * clarity
    }
}

/// Returns the smallest difference that a pilot notices, in a unit of the measures.
fn smallest(unit: &str) -> f64 {
    match unit {
        "m" => 0.1,
        "s" => 0.2,
        "m/s" => 0.05,
        "°" | "deg" | "°/s" | "deg/s" => 0.5,
        _ => 0.0,
    }
}

/// Returns the middle value, or the mean of the two in the middle.
fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    crate::report::compare::Statistics::of(values).map(|found| found.median)
}
