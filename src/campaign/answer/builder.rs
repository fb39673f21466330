//! Takes records one at a time and keeps what the answer needs.

use std::collections::BTreeMap;

use strum::IntoEnumIterator as _;

use super::causes::CauseTable;
use super::goals::{self, Numbers};
use super::versus::Pairs;
use super::{Answer, Distribution, Success, Worst};
use crate::campaign::record::{Record, Side, Standing};
use crate::campaign::statistics::{Summary, wilson};
use crate::scenario::{Goal, Metric, Quantity, Scenario};

/// The number of worst flights.
const WORST: usize = 10;
/// The most different complaints and reasons that are counted.
const COMPLAINTS: usize = 1000;
/// The most flights whose inputs and metrics are kept for the causes and comparisons.
const KEPT: u64 = 50_000;
/// The confidence of the interval of the success.
pub(super) const CONFIDENCE: f64 = 0.95;

/// The answer so far. Its memory does not grow with the number of flights beyond a bound.
#[derive(Debug, Clone)]
pub struct AnswerBuilder {
    wanted: u64,
    /// Every flight whose number is a multiple of this, plus one, is kept for the causes.
    stride: u64,
    goals: Vec<Goal>,
    /// The metrics and measures, in their order.
    quantities: Vec<Quantity>,
    sides: [OneSide; 2],
    causes: CauseTable,
    pairs: Option<Pairs>,
    worst: Vec<((u8, f64), Worst)>,
    /// The number of failed flights with each complaint, without its numbers.
    complaints: BTreeMap<(Side, String), u64>,
    /// The first reason of each kind why a flight could not be flown, and the number of such flights, by the reason
    /// without its numbers.
    not_flown: BTreeMap<String, (String, u64)>,
}

/// The flights of one side.
#[derive(Debug, Clone, Default)]
struct OneSide {
    flown: u64,
    flown_s: f64,
    passed: u64,
    judged: u64,
    skipped: u64,
    not_flown: u64,
    results: BTreeMap<String, u64>,
    summaries: BTreeMap<String, Summary>,
}

impl AnswerBuilder {
    /// Returns an empty answer for `wanted` flights. With `has_two_sides`, each flight is flown twice.
    pub fn new(scenario: &Scenario, wanted: u64, has_two_sides: bool) -> Self {
        let metrics =
            Metric::iter().map(|metric| Quantity { name: metric.to_string(), dimension: metric.dimension() });
        let mut quantities: Vec<Quantity> = metrics.collect();
        for measure in scenario.cases.iter().flat_map(|case| &case.measures) {
            if !quantities.iter().any(|known| known.name == measure.name) {
                quantities.push(Quantity { name: measure.name.clone(), dimension: measure.dimension });
            }
        }
        Self {
            wanted,
            stride: wanted.div_ceil(KEPT).max(1),
            goals: scenario.campaign.as_ref().map(|spec| spec.goals.clone()).unwrap_or_default(),
            quantities,
            sides: Default::default(),
            causes: CauseTable::default(),
            pairs: has_two_sides.then(Pairs::default),
            worst: Vec::new(),
            complaints: BTreeMap::new(),
            not_flown: BTreeMap::new(),
        }
    }

    /// Adds a flight. Both sides of a flight come one after the other.
    pub fn add(&mut self, record: &Record) {
        let side = &mut self.sides[record.side as usize];
        side.flown += 1;
        side.flown_s += record.flown_s;
        match record.standing {
            Standing::Passed => {
                side.passed += 1;
                side.judged += 1;
            }
            Standing::Failed => {
                side.judged += 1;
                let complaint = alike(&record.result, &record.complaint());
                if let Some(count) = entry(&mut self.complaints, (record.side, complaint), || 0) {
                    *count += 1;
                }
            }
            Standing::Skipped => side.skipped += 1,
            Standing::NotFlown => {
                side.not_flown += 1;
                let reason = record.complaint();
                let kind = alike(&record.result, &reason);
                if let Some((_, count)) = entry(&mut self.not_flown, kind, || (reason, 0)) {
                    *count += 1;
                }
            }
        }
        let result = if record.result.is_empty() { "not flown" } else { record.result.as_str() };
        *side.results.entry(result.to_owned()).or_default() += 1;
        for (name, value) in &record.metrics {
            match side.summaries.get_mut(name) {
                Some(summary) => summary.add(*value),
                None => side.summaries.entry(name.clone()).or_default().add(*value),
            }
        }
        let is_kept = (record.number - 1).is_multiple_of(self.stride);
        if record.side == Side::A && is_kept {
            self.causes.add(record);
        }
        if let Some(pairs) = &mut self.pairs {
            pairs.add(record, is_kept);
        }
        self.note_worst(record);
    }

    fn note_worst(&mut self, record: &Record) {
        let key = record.badness();
        let order = |a: &(u8, f64), b: &(u8, f64)| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1));
        let at = self.worst.partition_point(|(known, _)| order(known, &key).is_le());
        // Of a flight that passed only its margin says how close it came.
        let has_passed = record.standing == Standing::Passed;
        let is_left_out = matches!(record.standing, Standing::Skipped | Standing::NotFlown)
            || has_passed && record.margin.is_none();
        if is_left_out || at >= WORST {
            return;
        }
        let worst = Worst {
            number: record.number,
            side: record.side,
            result: record.result.clone(),
            complaint: record.complaint(),
            at: record.worst_at,
            alike: 1,
            has_passed,
            margin: record.margin,
        };
        self.worst.insert(at, (key, worst));
        self.worst.truncate(WORST);
    }

    /// Returns the answer of the flights so far.
    pub fn answer(&self) -> Answer {
        let side = &self.sides[Side::A as usize];
        let (low, high) = wilson(side.passed, side.judged, CONFIDENCE);
        let numbers = Numbers {
            passed: side.passed,
            judged: side.judged,
            flown: side.flown - side.not_flown,
            results: &side.results,
            summaries: &side.summaries,
        };
        let mut results: Vec<(String, u64)> =
            side.results.iter().map(|(result, count)| (result.clone(), *count)).collect();
        results.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(&b.0)));
        let mut not_flown: Vec<(String, u64)> = self.not_flown.values().cloned().collect();
        not_flown.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        Answer {
            wanted: self.wanted,
            flown: side.flown,
            flown_s: self.sides.iter().map(|side| side.flown_s).sum(),
            success: Success {
                passed: side.passed,
                judged: side.judged,
                skipped: side.skipped,
                not_flown: side.not_flown,
                low,
                high,
            },
            results,
            distributions: self.distributions(side),
            causes: self.causes.causes(),
            worst: self.worst.iter().map(|(_, worst)| self.with_alike(worst)).collect(),
            not_flown,
            versus: self.pairs.as_ref().map(|pairs| pairs.versus(&self.quantities)),
            goals: self.goals.iter().map(|goal| goals::judge(goal, &numbers)).collect(),
        }
    }

    /// Returns one of the worst flights with the number of those that failed like it.
    fn with_alike(&self, worst: &Worst) -> Worst {
        let alike = self.complaints.get(&(worst.side, alike(&worst.result, &worst.complaint))).copied();
        Worst { alike: alike.filter(|_| !worst.has_passed).unwrap_or(1), ..worst.clone() }
    }

    fn distributions(&self, side: &OneSide) -> Vec<Distribution> {
        let distribution = |of: &Quantity| {
            let summary = side.summaries.get(&of.name)?;
            let [p5, median, p95] = summary.quantiles([0.05, 0.5, 0.95])?;
            Some(Distribution {
                of: of.clone(),
                count: summary.count(),
                mean: summary.mean()?,
                least: summary.least()?,
                p5,
                median,
                p95,
                greatest: summary.greatest()?,
                is_exact: summary.is_exact(),
                curve: summary
                    .quantiles(std::array::from_fn::<f64, 101, _>(|at| at as f64 / 100.0))?
                    .to_vec(),
                classes: summary.histogram(Distribution::CLASSES),
            })
        };
        self.quantities.iter().filter_map(distribution).collect()
    }
}

/// Returns a complaint without its numbers and their signs: equal for flights that fail for the same reason.
pub(super) fn alike(result: &str, complaint: &str) -> String {
    let mut text = format!("{result}, ");
    let mut rest = complaint.chars().peekable();
    while let Some(c) = rest.next() {
        let is_before_number = rest.peek().is_some_and(char::is_ascii_digit);
        match c {
            // The hyphen in `wp-3` and `12-13` is no sign.
            '-' | '−' | '+'
                if is_before_number && !text.ends_with(|c: char| c == '#' || c.is_alphanumeric()) => {}
            '0'..='9' if text.ends_with('#') => {}
            '.' if text.ends_with('#') => {}
            '0'..='9' => text.push('#'),
            c => text.push(c),
        }
    }
    text
}

/// Returns the entry of a complaint or reason; `None` if there are too many others.
fn entry<K: Ord, V>(of: &mut BTreeMap<K, V>, key: K, first: impl FnOnce() -> V) -> Option<&mut V> {
    (of.len() < COMPLAINTS || of.contains_key(&key)).then(|| of.entry(key).or_insert_with(first))
}
