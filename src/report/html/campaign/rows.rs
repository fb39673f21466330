//! The rows of the tables of a campaign.

use crate::campaign::{Answer, GoalOutcome, Summary};
use crate::report::campaign::{Reported, sentences, shown};
use crate::report::html::text;
use crate::scenario::percent;

/// An expectation of the campaign.
#[derive(Debug)]
pub(super) struct GoalRow {
    pub(super) label: String,
    pub(super) class: &'static str,
    pub(super) mark: &'static str,
    pub(super) found: String,
}

/// An input that explains failures.
#[derive(Debug)]
pub(super) struct CauseRow {
    pub(super) rule: String,
    pub(super) inside: String,
    pub(super) outside: String,
    pub(super) rho: String,
}

/// The distribution of a metric.
#[derive(Debug)]
pub(super) struct DistributionRow {
    pub(super) name: String,
    pub(super) cells: [String; 7],
}

/// One of the worst flights.
#[derive(Debug)]
pub(super) struct WorstRow {
    pub(super) name: String,
    pub(super) class: &'static str,
    pub(super) complaint: String,
    pub(super) open: Option<String>,
}

pub(super) fn goals(answer: &Answer, most: usize) -> Vec<GoalRow> {
    let row = |judged: &crate::campaign::JudgedGoal| {
        let (class, mark) = match judged.outcome {
            GoalOutcome::Met => ("passed", "✓"),
            GoalOutcome::Failed => ("failed", "✗"),
            GoalOutcome::Unknown => ("", "–"),
        };
        GoalRow {
            label: text::line(&judged.goal.label),
            class,
            mark,
            found: text::line(&sentences::found(judged)),
        }
    };
    answer.goals.iter().take(most).map(row).collect()
}

pub(super) fn causes(answer: &Answer) -> Vec<CauseRow> {
    let real = answer.causes.of_failures.iter().filter(|cause| cause.is_real);
    let failed = |(failed, flights): (u64, u64)| {
        let share = percent(failed as f64 / flights.max(1) as f64);
        format!("{failed} of {flights} failed ({share})")
    };
    real.map(|cause| CauseRow {
        rule: text::line(&shown::rule(&cause.input, &cause.split.rule)),
        inside: failed(cause.split.inside),
        outside: failed(cause.split.outside),
        rho: cause.rho.map_or_else(String::new, |rho| format!("{rho:.2}")),
    })
    .collect()
}

pub(super) fn distributions(answer: &Answer, most: usize) -> Vec<DistributionRow> {
    let row = |distribution: &crate::campaign::Distribution| {
        let value = |value| shown::value(&distribution.of, value);
        DistributionRow {
            name: text::line(&distribution.of.name),
            cells: [
                distribution.count.to_string(),
                value(distribution.mean),
                value(distribution.median),
                value(distribution.p5),
                value(distribution.p95),
                value(distribution.least),
                value(distribution.greatest),
            ],
        }
    };
    answer.distributions.iter().take(most).map(row).collect()
}

/// Returns how exact the numbers are.
pub(super) fn distributions_note(answer: &Answer) -> String {
    let flights = "Flights without the number are left out.";
    if answer.distributions.iter().all(|distribution| distribution.is_exact) {
        return flights.to_owned();
    }
    format!("{flights} Quantiles are within {} of themselves.", percent(Summary::ERROR))
}

pub(super) fn worst(reported: &Reported<'_>) -> Vec<WorstRow> {
    let row = |alike: Vec<&crate::campaign::Worst>| {
        let [worst, others @ ..] = alike.as_slice() else { return None };
        let more = shown::others(reported, worst, others);
        let more = more.map_or_else(String::new, |more| format!("; {more}"));
        Some(WorstRow {
            name: shown::flight_name(reported, worst),
            class: if worst.has_passed { "" } else { "failed" },
            complaint: text::line(&format!("{}{more}", shown::complaint(worst))),
            open: shown::open_command(reported, worst)
                .and_then(|command| text::command(&command).map(str::to_owned)),
        })
    };
    shown::alike(&reported.answer.worst).into_iter().filter_map(row).collect()
}
