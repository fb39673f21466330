//! The judgement of a recorded flight by the expectations of its case.

mod inputs;
mod measures;
mod order;
mod outcome;
mod samples;

use super::case::{Case, Compare, Expectation, Expected, Statistic, Window};
use super::expression::{Condition, Evaluator, Instant, Number};
use super::happening::{Happening, Pattern};
use super::insight::{Insight, Needs};
use super::run::Flown;
use super::trace::Trace;
use crate::signals::SimTime;

pub use outcome::{Judgement, Margin, Outcome};
use outcome::{failed, met, unjudged};

/// Judges a flight. Returns a judgement for each expectation, in their order, then one for each input that was not
/// carried out, and the measures.
pub fn judge(case: &Case, flown: &Flown) -> (Vec<Judgement>, Vec<(String, f64)>) {
    let mut names = case.parameters.clone();
    for measure in &case.measures {
        let value = measures::take(&measure.measured, &Evaluator::new(&flown.trace, &names));
        names.push((measure.name.clone(), value));
    }
    let needs = Needs::of(case);
    let needed_to_fly = needs.flight(case);
    // A value that was not reported cannot be measured.
    names.retain(|(name, _)| needs.measure(name) <= flown.reported);
    let evaluator = Evaluator::new(&flown.trace, &names);
    let mut judgements: Vec<Judgement> = case
        .expectations
        .iter()
        .filter(|expectation| expectation.holds_for(flown.firmware))
        .map(|expectation| {
            // Without reports the inputs were not carried out. Such a flight cannot be judged.
            let outcome = match needs.expectation(expectation).max(needed_to_fly) {
                needed if needed > flown.reported => Outcome::Skipped(needed),
                _ => judge_one(expectation, flown, &evaluator),
            };
            judgement(expectation, outcome)
        })
        .collect();
    if needed_to_fly <= flown.reported {
        judgements.extend(inputs::judge(case, &flown.trace));
    }
    (judgements, names)
}

/// Returns skipped judgements for a case that a remote flight controller cannot fly, because its inputs or its end need
/// knowledge that no remote flight controller reports. Returns `None` if the case can be flown.
pub fn skip(case: &Case) -> Option<Vec<Judgement>> {
    let needed = Needs::of(case).flight(case);
    let skipped =
        case.expectations.iter().map(|expectation| judgement(expectation, Outcome::Skipped(needed)));
    (needed > Insight::Mission).then(|| skipped.collect())
}

fn judgement(expectation: &Expectation, outcome: Outcome) -> Judgement {
    Judgement { label: expectation.label.clone(), line: expectation.line, outcome }
}

/// Returns a statistic over a part of a flight; `None` if its instants did not come.
pub(super) fn statistic(
    window: &Window,
    statistic: Statistic,
    number: &Number,
    evaluator: &Evaluator<'_>,
) -> Option<f64> {
    measures::over(window, statistic, number, evaluator)
}

/// Judges an expectation that compares several flights. `names` are their measures as `CASE.MEASURE`, and `reported` is the
/// knowledge of all flights.
pub fn compare(compare: &Compare, names: &[(String, f64)], reported: Insight) -> Judgement {
    let trace = Trace::from_nothing();
    let is_known = |name: &str| names.iter().any(|(known, _)| known == name);
    let outcome = if reported < Insight::Inner && !compare.that.names().iter().all(|name| is_known(name)) {
        Outcome::Skipped(Insight::Inner)
    } else {
        that(&compare.that, &Evaluator::new(&trace, names))
    };
    Judgement { label: compare.label.clone(), line: compare.line, outcome }
}

impl Compare {
    /// Returns the judgement for cases that have no seed in common.
    pub fn never_judged(&self) -> Judgement {
        let outcome = unjudged("no seed was flown by all the cases; give them the same seeds");
        Judgement { label: self.label.clone(), line: self.line, outcome }
    }
}

fn judge_one(expectation: &Expectation, flown: &Flown, evaluator: &Evaluator<'_>) -> Outcome {
    let trace = evaluator.trace();
    match &expectation.expected {
        Expected::Result(allowed) if allowed.contains(&flown.result) => met(None),
        Expected::Result(allowed) => {
            let sentence = format!(
                "the flight should end {}, it ended {}: {}",
                allowed.join(" or "),
                flown.result,
                flown.reason
            );
            failed(sentence, Some(flown.ended_at)).with_guard(trace, flown.ended_at)
        }
        Expected::States(steps) => order::judge(steps, evaluator),
        Expected::Event { pattern, count, within, with } => {
            let range = match Range::of(&expectation.window, evaluator) {
                Ok(range) => range,
                Err(outcome) => return outcome,
            };
            let found = range.happenings(pattern, trace);
            if found.is_empty()
                && *count != Some(0)
                && let Some(outside) = trace.happenings.iter().find(|happening| pattern.matches(happening))
            {
                let sentence = format!(
                    "it did not happen from {} to {}, but at {}: from and until set when it counts",
                    trace.shown_time(range.from()),
                    trace.shown_time(range.to()),
                    trace.shown_time(outside.time)
                );
                return failed(sentence, Some(outside.time));
            }
            let outcome = judge_event(&found, *count, within.as_ref(), with.as_ref(), evaluator);
            if count.is_some() { range.whole(outcome, trace) } else { outcome }
        }
        Expected::NoEvent(pattern) => match Range::of(&expectation.window, evaluator) {
            Ok(range) => match range.happenings(pattern, trace).first() {
                None => range.whole(met(None), trace),
                Some(happening) => failed(
                    format!("{happening} came at {}", trace.shown_time(happening.time)),
                    Some(happening.time),
                ),
            },
            Err(outcome) => outcome,
        },
        Expected::Always(..) | Expected::Eventually(_) | Expected::Mostly(..) | Expected::Statistic(..) => {
            match Range::of(&expectation.window, evaluator) {
                Ok(range) => {
                    let outcome = samples::judge(&expectation.expected, range, evaluator);
                    let is_seen = matches!(expectation.expected, Expected::Eventually(_));
                    if is_seen { outcome } else { range.whole(outcome, trace) }
                }
                Err(outcome) => outcome,
            }
        }
        Expected::At(instant, condition) => at(instant, condition, evaluator),
        Expected::That(condition) => that(condition, evaluator),
    }
}

fn judge_event(
    found: &[&Happening],
    count: Option<usize>,
    within: Option<&(f64, f64, Instant)>,
    with: Option<&Condition>,
    evaluator: &Evaluator<'_>,
) -> Outcome {
    let trace = evaluator.trace();
    let Some(first) = found.first() else {
        if count == Some(0) {
            return met(None);
        }
        let end = trace.end();
        return failed("it did not happen".to_owned(), Some(end)).with_guard(trace, end);
    };
    if let Some(count) = count.filter(|&count| count != found.len()) {
        let times: Vec<String> =
            found.iter().take(5).map(|happening| trace.shown_time(happening.time)).collect();
        let sentence =
            format!("it happened {} times instead of {count}: at {}", found.len(), times.join(", "));
        return failed(sentence, found.get(count).or(found.last()).map(|happening| happening.time));
    }
    let mut outcome = met(None);
    if let Some((from_s, to_s, instant)) = within {
        let Some(origin) = evaluator.instant(instant) else {
            return unjudged("the start of its time did not happen");
        };
        let seconds = (first.time.0 as i64 - origin) as f64 * 1e-6;
        let verdict = outcome::time_verdict(seconds, *from_s, *to_s);
        outcome = outcome.and(outcome::of_verdict(&verdict, first.time, trace));
    }
    if let Some(condition) = with {
        for happening in found {
            let Some(index) = trace.index_at(happening.time.0 as i64).or(trace.samples.len().checked_sub(1))
            else {
                return unjudged("nothing was recorded then");
            };
            let one = samples::instant(condition, index, Some(happening), happening.time, evaluator);
            outcome = outcome.and(one);
        }
    }
    outcome
}

fn at(instant: &Instant, condition: &Condition, evaluator: &Evaluator<'_>) -> Outcome {
    let Some(us) = evaluator.instant(instant) else { return unjudged("its instant did not come") };
    if us < 0 {
        return unjudged("its instant lies before boot");
    }
    let trace = evaluator.trace();
    let Some(index) = trace.index_at(us) else {
        return unjudged("its instant lies after the end of the record; watch the flight for longer");
    };
    samples::instant(condition, index, None, trace.samples[index].time, evaluator)
}

fn that(condition: &Condition, evaluator: &Evaluator<'_>) -> Outcome {
    let trace = evaluator.trace();
    let Some(index) = trace.samples.len().checked_sub(1) else {
        return unjudged("nothing was recorded");
    };
    samples::instant(condition, index, None, trace.samples[index].time, evaluator)
}

/// A part of a flight.
#[derive(Debug, Clone, Copy)]
struct Range {
    from_us: i64,
    to_us: i64,
}

impl Range {
    /// Returns the part that a window names, or the outcome if there is none.
    fn of(window: &Window, evaluator: &Evaluator<'_>) -> Result<Self, Outcome> {
        let trace = evaluator.trace();
        let from_us = match &window.from {
            None => trace.engaged_at.map_or(0, |time| time.0 as i64),
            Some(instant) => evaluator
                .instant(instant)
                .ok_or_else(|| unjudged("the instant from which it holds did not come"))?,
        };
        let to_us = match &window.until {
            None => trace.end().0 as i64,
            Some(instant) => evaluator
                .instant(instant)
                .ok_or_else(|| unjudged("the instant until which it holds did not come"))?,
        };
        if to_us < from_us {
            let time = |us: i64| trace.shown_time(SimTime(us.max(0) as u64));
            return Err(unjudged(&format!(
                "its time ends at {}, before it begins at {}",
                time(to_us),
                time(from_us)
            )));
        }
        Ok(Self { from_us, to_us })
    }

    fn from(&self) -> SimTime {
        SimTime(self.from_us.max(0) as u64)
    }

    fn to(&self) -> SimTime {
        SimTime(self.to_us.max(0) as u64)
    }

    /// Returns `true` if the record ends before this part ends.
    fn is_cut(&self, trace: &Trace) -> bool {
        self.to_us > trace.end().0 as i64
    }

    /// Replaces a met outcome by "not judged" if the record covers only a part of the range.
    fn whole(&self, outcome: Outcome, trace: &Trace) -> Outcome {
        if !outcome.is_met() || !self.is_cut(trace) {
            return outcome;
        }
        unjudged(&format!(
            "its time ends at {}, the record at {}; watch_s watches the flight for longer",
            trace.shown_time(self.to()),
            trace.shown_time(trace.end())
        ))
    }

    fn happenings<'t>(&self, pattern: &Pattern, trace: &'t Trace) -> Vec<&'t Happening> {
        trace
            .happenings
            .iter()
            .filter(|happening| (self.from_us..=self.to_us).contains(&(happening.time.0 as i64)))
            .filter(|happening| pattern.matches(happening))
            .collect()
    }

    /// Returns the indices of the samples in the range.
    fn samples(&self, trace: &Trace) -> std::ops::Range<usize> {
        let from = trace.samples.partition_point(|sample| (sample.time.0 as i64) < self.from_us);
        let to = trace.samples.partition_point(|sample| sample.time.0 as i64 <= self.to_us);
        from..to.max(from)
    }
}
