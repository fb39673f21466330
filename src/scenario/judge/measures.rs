//! Numbers taken from a flight.

use super::{Range, samples};
use crate::scenario::case::Measured;
use crate::scenario::expression::Evaluator;

/// A measure; NaN when what it waits for did not happen.
pub(super) fn take(measured: &Measured, evaluator: &Evaluator<'_>) -> f64 {
    let trace = evaluator.trace();
    let number = match measured {
        Measured::Over(window, statistic, number) => Range::of(window, evaluator).ok().and_then(|range| {
            samples::take(*statistic, range.samples(trace), |index| evaluator.number(number, index))
                .map(|(value, _)| value)
        }),
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
