//! Numbers taken from a flight.

use super::{Range, samples};
use crate::scenario::case::{Measured, Statistic, Window};
use crate::scenario::expression::{Evaluator, Number};

/// Takes a measure; NaN if an instant that it needs did not come.
pub(super) fn take(measured: &Measured, evaluator: &Evaluator<'_>) -> f64 {
    let trace = evaluator.trace();
    let number = match measured {
        Measured::Over(window, statistic, number) => over(window, *statistic, number, evaluator),
        Measured::At(instant, number) => evaluator
            .instant(instant)
            .and_then(|us| trace.index_at(us))
            .map(|index| evaluator.number(number, index)),
        Measured::Time(from, to) => match (evaluator.instant(from), evaluator.instant(to)) {
            (Some(from), Some(to)) => Some((to - from) as f64 * 1e-6),
            _ => None,
        },
        Measured::Of(number) => trace.samples.len().checked_sub(1).map(|last| evaluator.number(number, last)),
    };
    number.unwrap_or(f64::NAN)
}

/// Takes a statistic over a part of the flight; `None` if its instants did not come or no value is known.
pub(super) fn over(
    window: &Window,
    statistic: Statistic,
    number: &Number,
    evaluator: &Evaluator<'_>,
) -> Option<f64> {
    let range = Range::of(window, evaluator).ok().filter(|range| !range.is_cut(evaluator.trace()))?;
    let samples = range.samples(evaluator.trace());
    samples::take(statistic, samples, |index| evaluator.number(number, index)).map(|(value, _)| value)
}
