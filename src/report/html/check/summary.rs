//! The table of all expectations.

use crate::report::check::{CaseCount, CheckedFlight, Summary, complaint};
use crate::report::html::text;
use crate::scenario::{Judgement, Outcome};

/// A case, or the comparisons of several flights of a scenario.
#[derive(Debug)]
pub(super) struct Case {
    pub(super) name: String,
    /// `3 of 4`
    pub(super) passed: String,
    pub(super) class: &'static str,
    pub(super) rows: Vec<Row>,
}

/// An expectation.
#[derive(Debug)]
pub(super) struct Row {
    /// The order of the rows: failures first, then by what is left, then what was not judged.
    rank: f64,
    pub(super) label: String,
    /// What was seen against what is allowed.
    pub(super) seen: String,
    /// The share of the allowed range that is left.
    pub(super) left: String,
    pub(super) class: &'static str,
}

impl Case {
    /// Returns the expectation that failed or came closest to its limit.
    pub(super) fn tightest(&self) -> Option<&Row> {
        self.rows.iter().min_by(|a, b| a.rank.total_cmp(&b.rank))
    }
}

impl Row {
    /// Returns a row without a judgement.
    fn from_flight(label: &str, seen: &str, left: &str, class: &'static str) -> Self {
        let rank = if class == "failed" { f64::NEG_INFINITY } else { f64::INFINITY };
        Self { rank, label: label.to_owned(), seen: text::line(seen), left: left.to_owned(), class }
    }

    /// Returns the row of a judgement.
    pub(super) fn of(judgement: &Judgement) -> Self {
        let (seen, left, class) = match &judgement.outcome {
            Outcome::Met(Some(margin)) => {
                (margin.shown(), format!("{:.0} %", 100.0 * margin.verdict.share()), "passed")
            }
            Outcome::Met(None) => ("met".to_owned(), "✓".to_owned(), "passed"),
            Outcome::Skipped(_) => (complaint_of(judgement), "–".to_owned(), ""),
            Outcome::Failed { .. } | Outcome::NeverJudged(_) => {
                (complaint_of(judgement), "✗".to_owned(), "failed")
            }
        };
        let (label, seen) = (text::line(&judgement.label), text::line(&seen));
        Self { rank: rank(judgement), label, seen, left, class }
    }

    fn bytes(&self) -> usize {
        /// The size of the elements of a row.
        const ELEMENTS: usize = 120;
        self.label.len() + self.seen.len() + ELEMENTS
    }
}

/// Returns the sentence about an expectation without its label.
fn complaint_of(judgement: &Judgement) -> String {
    let complaint = complaint(judgement);
    complaint.strip_prefix(&format!("{}: ", judgement.label)).map(str::to_owned).unwrap_or(complaint)
}

/// Returns the first cases, with at most so many bytes, and the number of all.
pub(super) fn cases(summary: &Summary, most_bytes: usize) -> (Vec<Case>, usize) {
    let mut index = 0;
    let mut all: Vec<Case> = Vec::new();
    for count in summary.cases() {
        let flights = summary.flights.get(index..index + count.flights).unwrap_or_default();
        index += count.flights;
        all.push(case(&count, flights));
    }
    all.extend(summary.compared.iter().map(|compared| Case {
        name: text::line(&compared.title()),
        passed: String::new(),
        class: "",
        rows: vec![Row::of(&compared.judgement)],
    }));
    let count = all.len();
    let mut bytes = 0;
    let fitting = all.into_iter().take_while(|case| {
        let tightest = case.tightest().map_or(0, Row::bytes);
        bytes += 2 * case.name.len() + tightest + case.rows.iter().map(Row::bytes).sum::<usize>();
        bytes <= most_bytes
    });
    (fitting.collect(), count)
}

fn case(count: &CaseCount, flights: &[CheckedFlight]) -> Case {
    let CaseCount { name, passed, flights: all, .. } = count;
    let mut rows: Vec<Row> = Vec::new();
    if let Some(problem) = flights.iter().find_map(|flight| flight.problem.as_ref()) {
        rows.push(Row::from_flight("the flight", problem, "✗", "failed"));
    }
    let labels = flights.iter().map(|flight| &flight.judgements).max_by_key(|judgements| judgements.len());
    for judgement in labels.into_iter().flatten() {
        let same = |other: &&Judgement| other.label == judgement.label && other.line == judgement.line;
        let seen = flights.iter().flat_map(|flight| flight.judgements.iter().filter(same));
        rows.extend(seen.min_by(|a, b| rank(a).total_cmp(&rank(b))).map(Row::of));
    }
    if rows.is_empty() {
        rows.push(Row::from_flight("nothing was judged", "", "–", ""));
    }
    let class = match count.has_failures() {
        true => "failed",
        false if *passed > 0 => "passed",
        false => "",
    };
    Case { name: text::line(name), passed: format!("{passed} of {all}"), class, rows }
}

/// Returns the place of a judgement in the order of [`Row::rank`].
fn rank(judgement: &Judgement) -> f64 {
    match &judgement.outcome {
        Outcome::Failed { .. } | Outcome::NeverJudged(_) => f64::NEG_INFINITY,
        Outcome::Met(margin) => margin.map_or(1e9, |margin| margin.verdict.share().clamp(-1e8, 1e8)),
        Outcome::Skipped(_) => f64::INFINITY,
    }
}
