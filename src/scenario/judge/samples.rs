//! Expectations about samples: always, never, at some time, mostly, and statistics.

use super::Range;
use super::outcome::{Margin, Outcome, describe, failed, met, of_verdict, unjudged};
use crate::scenario::case::{Expected, Statistic};
use crate::scenario::expression::{Comparison, Condition, Evaluator, Verdict};
use crate::scenario::happening::Happening;
use crate::signals::SimTime;
use crate::telemetry::quantity::Dimension;

const NOTHING_KNOWN: &str = "it was not known at any moment of its time";

/// Judges an expectation about the samples of a range.
pub(super) fn judge(expected: &Expected, range: Range, evaluator: &Evaluator<'_>) -> Outcome {
    let samples = range.samples(evaluator.trace());
    if samples.is_empty() {
        return unjudged("there is no sample in its time");
    }
    match expected {
        Expected::Always(condition, never) => always(condition, *never, samples, evaluator),
        Expected::Eventually(condition) => eventually(condition, samples, evaluator),
        Expected::Mostly(condition, share) => mostly(condition, *share, samples, evaluator),
        Expected::Statistic(statistic, comparison) => {
            judge_statistic(*statistic, comparison, samples, evaluator)
        }
        _ => unjudged("it is not about samples"),
    }
}

/// Judges the condition at one sample, optionally with the numbers of a happening.
pub(super) fn instant(
    condition: &Condition,
    index: usize,
    happening: Option<&Happening>,
    time: SimTime,
    evaluator: &Evaluator<'_>,
) -> Outcome {
    let trace = evaluator.trace();
    let deciding = evaluator.deciding(condition, index, happening);
    match evaluator.holds_of(condition, index, happening) {
        Some(true) => met(deciding.filter(Verdict::holds).map(|verdict| Margin { verdict, time })),
        Some(false) => match deciding.filter(|verdict| !verdict.holds()) {
            Some(verdict) => of_verdict(&verdict, time, trace),
            None => failed(format!("it did not hold at {}", trace.shown_time(time)), Some(time)),
        },
        None => {
            let unknown = evaluator.unknown_names(condition);
            let what = if unknown.is_empty() {
                "none of its values".to_owned()
            } else {
                format!("no {}", unknown.join(", no "))
            };
            unjudged(&format!("{what} was known at its instant"))
        }
    }
}

/// Returns the deciding comparison at a sample for a condition that must hold, or (`never`) must not hold.
fn wanted(
    condition: &Condition,
    never: bool,
    index: usize,
    evaluator: &Evaluator<'_>,
) -> Option<(bool, Option<Verdict>)> {
    let holds = evaluator.holds(condition, index)?;
    let deciding = evaluator.deciding(condition, index, None);
    if !never {
        return Some((holds, deciding));
    }
    Some((!holds, deciding.and_then(|verdict| opposite(&verdict))))
}

/// Returns the verdict for a number that must be outside its bounds; `None` if two sides remain.
fn opposite(verdict: &Verdict) -> Option<Verdict> {
    let Verdict { value, low, high, dimension, strict } = *verdict;
    match (low.is_finite(), high.is_finite()) {
        (false, true) => Some(Verdict { value, low: high, high: f64::INFINITY, dimension, strict: !strict }),
        (true, false) => {
            Some(Verdict { value, low: f64::NEG_INFINITY, high: low, dimension, strict: !strict })
        }
        _ => None,
    }
}

fn always(
    condition: &Condition,
    never: bool,
    samples: std::ops::Range<usize>,
    evaluator: &Evaluator<'_>,
) -> Outcome {
    let trace = evaluator.trace();
    let (mut known, mut broken) = (0_usize, Vec::new());
    let mut tightest: Option<Margin> = None;
    let mut worst: Option<(usize, Option<Verdict>)> = None;
    for index in samples {
        let Some((ok, verdict)) = wanted(condition, never, index, evaluator) else { continue };
        known += 1;
        let time = trace.samples[index].time;
        if !ok {
            broken.push(index);
            let is_worse = match (&worst, &verdict) {
                (None, _) => true,
                (Some((_, Some(before))), Some(now)) => now.margin() < before.margin(),
                (Some(_), _) => false,
            };
            if is_worse {
                worst = Some((index, verdict));
            }
        } else if let Some(verdict) = verdict.filter(Verdict::holds)
            && tightest.is_none_or(|before| verdict.share() < before.verdict.share())
        {
            tightest = Some(Margin { verdict, time });
        }
    }
    let Some((index, verdict)) = worst else {
        return if known == 0 { unjudged(NOTHING_KNOWN) } else { met(tightest) };
    };
    let time = trace.samples[index].time;
    let first = broken.first().map_or(time, |&index| trace.samples[index].time);
    let value = verdict.map_or_else(|| "it did not hold".to_owned(), |verdict| describe(&verdict));
    let share = 100.0 * broken.len() as f64 / known as f64;
    let sentence = format!(
        "{value} at {}; outside for {share:.1} % of its time, first at {}",
        trace.shown_time(time),
        trace.shown_time(first)
    );
    failed(sentence, Some(time)).with_guard(trace, time)
}

fn eventually(condition: &Condition, samples: std::ops::Range<usize>, evaluator: &Evaluator<'_>) -> Outcome {
    let trace = evaluator.trace();
    let mut nearest: Option<(usize, Verdict)> = None;
    let mut known = false;
    let last = samples.end.saturating_sub(1);
    for index in samples {
        let holds = evaluator.holds(condition, index);
        known |= holds.is_some();
        if holds == Some(true) {
            return met(None);
        }
        if let Some(verdict) = evaluator.deciding(condition, index, None)
            && nearest.as_ref().is_none_or(|(_, before)| verdict.margin() > before.margin())
        {
            nearest = Some((index, verdict));
        }
    }
    match nearest {
        _ if !known => unjudged(NOTHING_KNOWN),
        Some((index, verdict)) => {
            let time = trace.samples[index].time;
            let sentence =
                format!("it never held; closest was {} at {}", describe(&verdict), trace.shown_time(time));
            failed(sentence, Some(time)).with_guard(trace, time)
        }
        None => failed("it never held".to_owned(), trace.samples.get(last).map(|sample| sample.time)),
    }
}

fn mostly(
    condition: &Condition,
    share: f64,
    samples: std::ops::Range<usize>,
    evaluator: &Evaluator<'_>,
) -> Outcome {
    let trace = evaluator.trace();
    let (mut known, mut held, mut first) = (0_usize, 0_usize, None);
    for index in samples {
        match evaluator.holds(condition, index) {
            Some(true) => held += 1,
            Some(false) => {
                first.get_or_insert(trace.samples[index].time);
            }
            None => continue,
        }
        known += 1;
    }
    if known == 0 {
        return unjudged(NOTHING_KNOWN);
    }
    let time = first.unwrap_or_else(|| trace.end());
    let value = held as f64 / known as f64;
    // The margin is about the share of samples at which the condition does not hold.
    let verdict = Verdict {
        value: 1.0 - value,
        low: f64::NEG_INFINITY,
        high: 1.0 - share,
        dimension: Dimension::NONE,
        strict: false,
    };
    if value >= share {
        return met(Some(Margin { verdict, time }));
    }
    let sentence = format!(
        "it held at {:.1} % of the samples instead of {:.1} %, not first at {}",
        100.0 * value,
        100.0 * share,
        trace.shown_time(time)
    );
    failed(sentence, Some(time))
}

fn judge_statistic(
    statistic: Statistic,
    comparison: &Comparison,
    samples: std::ops::Range<usize>,
    evaluator: &Evaluator<'_>,
) -> Outcome {
    let trace = evaluator.trace();
    let last = samples.end.saturating_sub(1);
    let Some((value, index)) = take(statistic, samples, |index| evaluator.number(&comparison.left, index))
    else {
        return unjudged(NOTHING_KNOWN);
    };
    let time = trace.samples[index.unwrap_or(last)].time;
    match evaluator.bound(comparison, value, last, None) {
        Some(verdict) if verdict.holds() => met(Some(Margin { verdict, time })),
        Some(verdict) => {
            let when = index.map_or_else(String::new, |_| format!(" at {}", trace.shown_time(time)));
            failed(format!("{statistic} {}{when}", describe(&verdict)), Some(time))
        }
        None => unjudged(NOTHING_KNOWN),
    }
}

/// Takes a statistic of the known values of samples, and the sample it comes from; `None` if no value is known.
pub(super) fn take(
    statistic: Statistic,
    samples: std::ops::Range<usize>,
    value: impl Fn(usize) -> f64,
) -> Option<(f64, Option<usize>)> {
    let known = samples.map(|index| (value(index), index)).filter(|(value, _)| !value.is_nan());
    let mean = |of: fn(f64) -> f64, known: &mut dyn Iterator<Item = (f64, usize)>| {
        let (sum, count) = known.fold((0.0, 0_u32), |(sum, count), (value, _)| (sum + of(value), count + 1));
        (count > 0).then(|| sum / f64::from(count))
    };
    let mut known = known;
    match statistic {
        Statistic::Mean => mean(|value| value, &mut known).map(|mean| (mean, None)),
        Statistic::Rms => mean(|value| value * value, &mut known).map(|mean| (mean.sqrt(), None)),
        Statistic::Max => known.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(value, index)| (value, Some(index))),
        Statistic::Min => known.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(value, index)| (value, Some(index))),
    }
}
