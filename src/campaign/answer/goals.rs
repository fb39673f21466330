//! The goals of a campaign, judged.

use std::collections::BTreeMap;

use crate::campaign::statistics::{Summary, order_bound, wilson};
use crate::scenario::{Goal, GoalStatistic, Subject};

/// A goal and its outcome.
#[derive(Debug, Clone, PartialEq)]
pub struct JudgedGoal {
    pub goal: Goal,
    pub outcome: GoalOutcome,
    /// The number that was found; `None` if no flight has one.
    pub found: Option<f64>,
    /// The bound of its interval that was compared, if the goal asks for a confidence.
    pub bound: Option<f64>,
}

/// The outcome of a goal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GoalOutcome {
    Met,
    Failed,
    /// There are no flights, or too few for the confidence.
    Unknown,
}

/// The numbers of a campaign.
#[derive(Debug, Clone, Copy)]
pub(super) struct Numbers<'a> {
    pub(super) passed: u64,
    pub(super) judged: u64,
    pub(super) flown: u64,
    pub(super) results: &'a BTreeMap<String, u64>,
    pub(super) summaries: &'a BTreeMap<String, Summary>,
}

pub(super) fn judge(goal: &Goal, numbers: &Numbers<'_>) -> JudgedGoal {
    let found = value(&goal.subject, numbers);
    let bound = goal.confidence.and_then(|confidence| bound(goal, confidence, numbers));
    let compared = if goal.confidence.is_some() { bound } else { found };
    let outcome = match compared {
        Some(value) if goal.limit.allows(value) => GoalOutcome::Met,
        Some(_) => GoalOutcome::Failed,
        None => GoalOutcome::Unknown,
    };
    JudgedGoal { goal: goal.clone(), outcome, found, bound }
}

fn share(subject: &Subject, numbers: &Numbers<'_>) -> Option<(u64, u64)> {
    match subject {
        Subject::Success => Some((numbers.passed, numbers.judged)),
        Subject::Share(result) => Some((numbers.results.get(result).copied().unwrap_or(0), numbers.flown)),
        Subject::Statistic(..) => None,
    }
}

fn value(subject: &Subject, numbers: &Numbers<'_>) -> Option<f64> {
    if let Some((hits, count)) = share(subject, numbers) {
        return (count > 0).then(|| hits as f64 / count as f64);
    }
    let Subject::Statistic(statistic, quantity) = subject else { return None };
    let summary = numbers.summaries.get(&quantity.name)?;
    match statistic {
        GoalStatistic::Quantile(share) => summary.quantiles([*share]).map(|[value]| value),
        GoalStatistic::Mean => summary.mean(),
        GoalStatistic::Min => summary.least(),
        GoalStatistic::Max => summary.greatest(),
    }
}

/// Returns the bound of the number that is farther from the allowed values, with this confidence on its side.
fn bound(goal: &Goal, confidence: f64, numbers: &Numbers<'_>) -> Option<f64> {
    if let Some((hits, count)) = share(&goal.subject, numbers) {
        // The interval is two-sided, and only one of its ends is compared.
        let (low, high) = wilson(hits, count, 2.0 * confidence - 1.0);
        return (count > 0).then_some(if goal.limit.is_least { low } else { high });
    }
    let Subject::Statistic(GoalStatistic::Quantile(share), quantity) = &goal.subject else { return None };
    let summary = numbers.summaries.get(&quantity.name)?;
    let count = summary.count();
    let rank = if goal.limit.is_least {
        count + 1 - order_bound(count, 1.0 - share, confidence)?
    } else {
        order_bound(count, *share, confidence)?
    };
    summary.ranked(rank)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::{GoalLimit, Quantity};
    use crate::telemetry::quantity::Dimension;

    fn goal(subject: Subject, value: f64, is_least: bool, confidence: Option<f64>) -> Goal {
        let limit = GoalLimit { value, is_least, is_strict: false };
        Goal { label: String::new(), line: 1, subject, limit, confidence }
    }

    fn outcome(goal: &Goal, passed: u64, judged: u64) -> GoalOutcome {
        let results = BTreeMap::from([("crashed".to_owned(), 2)]);
        let mut summary = Summary::default();
        (1..=100).for_each(|value| summary.add(f64::from(value)));
        let summaries = BTreeMap::from([("touchdown".to_owned(), summary)]);
        let numbers = Numbers { passed, judged, flown: 100, results: &results, summaries: &summaries };
        judge(goal, &numbers).outcome
    }

    #[test]
    fn the_estimate_may_pass_where_its_bound_does_not() {
        let plain = goal(Subject::Success, 0.99, true, None);
        let sure = goal(Subject::Success, 0.99, true, Some(0.95));
        assert_eq!(outcome(&plain, 995, 1000), GoalOutcome::Met);
        assert_eq!(outcome(&sure, 996, 1000), GoalOutcome::Met, "the lower bound is 99.09 %");
        assert_eq!(outcome(&sure, 993, 1000), GoalOutcome::Failed);
        assert_eq!(outcome(&plain, 993, 1000), GoalOutcome::Met);
        assert_eq!(outcome(&plain, 0, 0), GoalOutcome::Unknown);
    }

    #[test]
    fn shares_of_results_and_quantiles_are_compared() {
        let crashed = |most, confidence| goal(Subject::Share("crashed".to_owned()), most, false, confidence);
        assert_eq!(outcome(&crashed(0.02, None), 0, 0), GoalOutcome::Met);
        assert_eq!(outcome(&crashed(0.02, Some(0.95)), 0, 0), GoalOutcome::Failed);
        let quantity = || Quantity { name: "touchdown".to_owned(), dimension: Dimension::LENGTH };
        let p90 = |most, confidence| {
            goal(Subject::Statistic(GoalStatistic::Quantile(0.9), quantity()), most, false, confidence)
        };
        assert_eq!(outcome(&p90(91.0, None), 0, 0), GoalOutcome::Met);
        assert_eq!(outcome(&p90(91.0, Some(0.95)), 0, 0), GoalOutcome::Failed);
        assert_eq!(outcome(&p90(96.0, Some(0.95)), 0, 0), GoalOutcome::Met);
        let p99 =
            goal(Subject::Statistic(GoalStatistic::Quantile(0.99), quantity()), 200.0, false, Some(0.95));
        assert_eq!(outcome(&p99, 0, 0), GoalOutcome::Unknown, "a hundred flights are too few");
        let other = Quantity { name: "lap".to_owned(), dimension: Dimension::TIME };
        let lap = goal(Subject::Statistic(GoalStatistic::Mean, other), 5.0, false, None);
        assert_eq!(outcome(&lap, 0, 0), GoalOutcome::Unknown);
    }
}
