//! Two sides that flew the same inputs, compared flight by flight.

use std::collections::BTreeMap;

use super::Success;
use super::builder::CONFIDENCE;
use crate::campaign::record::{Record, Side, Standing};
use crate::campaign::statistics::{Significance, Summary, mcnemar, signed_rank, wilson};
use crate::scenario::Quantity;

/// The comparison of side B with side A.
#[derive(Debug, Clone, PartialEq)]
pub struct Versus {
    /// The number of pairs that were compared.
    pub pairs: u64,
    pub a: Success,
    pub b: Success,
    /// The number of pairs in which only A succeeded, and only B.
    pub only_a: u64,
    pub only_b: u64,
    /// The significance of the difference in success.
    pub success: Significance,
    pub metrics: Vec<MetricDifference>,
}

/// The difference of a metric between the sides.
#[derive(Debug, Clone, PartialEq)]
pub struct MetricDifference {
    pub of: Quantity,
    pub median_a: f64,
    pub median_b: f64,
    /// The median of B − A over the pairs.
    pub difference: f64,
    /// `None` if all pairs are equal.
    pub significance: Option<Significance>,
}

/// The pairs so far.
#[derive(Debug, Clone, Default)]
pub(super) struct Pairs {
    /// The flight of side A that waits for its partner.
    waiting: Option<Record>,
    pairs: u64,
    sides: [Counts; 2],
    only: [u64; 2],
    metrics: BTreeMap<String, Differences>,
}

#[derive(Debug, Clone, Copy, Default)]
struct Counts {
    passed: u64,
    judged: u64,
    skipped: u64,
    not_flown: u64,
}

#[derive(Debug, Clone, Default)]
struct Differences {
    sides: [Summary; 2],
    all: Summary,
    /// Those of the kept flights.
    kept: Vec<f64>,
}

impl Pairs {
    /// Adds a flight. The differences of a kept flight are used for the tests of metrics.
    pub(super) fn add(&mut self, record: &Record, is_kept: bool) {
        if record.side == Side::A {
            self.waiting = Some(record.clone());
            return;
        }
        let Some(a) = self.waiting.take().filter(|a| a.number == record.number) else { return };
        self.pairs += 1;
        let pair = [&a, record];
        for (counts, record) in self.sides.iter_mut().zip(pair) {
            match record.standing {
                Standing::Passed => {
                    counts.passed += 1;
                    counts.judged += 1;
                }
                Standing::Failed => counts.judged += 1,
                Standing::Skipped => counts.skipped += 1,
                Standing::NotFlown => counts.not_flown += 1,
            }
        }
        match pair.map(|record| record.standing) {
            [Standing::Passed, Standing::Failed] => self.only[0] += 1,
            [Standing::Failed, Standing::Passed] => self.only[1] += 1,
            _ => {}
        }
        for (name, value) in &a.metrics {
            let Some(other) = record.metric(name) else { continue };
            let differences = self.metrics.entry(name.clone()).or_default();
            differences.sides[0].add(*value);
            differences.sides[1].add(other);
            differences.all.add(other - value);
            if is_kept {
                differences.kept.push(other - value);
            }
        }
    }

    pub(super) fn versus(&self, quantities: &[Quantity]) -> Versus {
        let [a, b] = self.sides.map(|Counts { passed, judged, skipped, not_flown }| {
            let (low, high) = wilson(passed, judged, CONFIDENCE);
            Success { passed, judged, skipped, not_flown, low, high }
        });
        let [only_a, only_b] = self.only;
        let median = |summary: &Summary| summary.quantiles([0.5]).map(|[median]| median);
        let metrics = quantities.iter().filter_map(|of| {
            let differences = self.metrics.get(&of.name)?;
            Some(MetricDifference {
                of: of.clone(),
                median_a: median(&differences.sides[0])?,
                median_b: median(&differences.sides[1])?,
                difference: median(&differences.all)?,
                significance: signed_rank(&differences.kept),
            })
        });
        Versus {
            pairs: self.pairs,
            a,
            b,
            only_a,
            only_b,
            success: mcnemar(only_a, only_b),
            metrics: metrics.collect(),
        }
    }
}
