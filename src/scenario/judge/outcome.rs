//! The outcome of an expectation.

use crate::scenario::Insight;
use crate::scenario::expression::Verdict;
use crate::scenario::trace::Trace;
use crate::signals::SimTime;
use crate::telemetry::quantity::{Dimension, shown, shown_apart};

/// The judgement of an expectation.
#[derive(Debug, Clone, PartialEq)]
pub struct Judgement {
    /// The name of the expectation, or else its text.
    pub label: String,
    /// Line in the scenario's file, from 1.
    pub line: usize,
    /// The outcome of the expectation.
    pub outcome: Outcome,
}

/// The outcome of an expectation.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// Met; with the tightest number if there is one.
    Met(Option<Margin>),
    /// Not met.
    Failed {
        /// The reason as a sentence.
        sentence: String,
        /// The time at which it failed, if there is one.
        at: Option<SimTime>,
        /// The guard that came closest to firing at that time.
        guard: Option<String>,
    },
    /// Not judged, because an instant that it needs did not come.
    NeverJudged(String),
    /// Not judged, because it needs knowledge that this flight controller does not report.
    Skipped(Insight),
}

/// The distance of a number from its bound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Margin {
    /// The number and its bounds.
    pub verdict: Verdict,
    /// The time at which the number is closest to its bound.
    pub time: SimTime,
}

impl Outcome {
    /// Returns `true` if the expectation was met.
    pub fn is_met(&self) -> bool {
        matches!(self, Self::Met(_))
    }

    /// Returns `true` if the expectation was not met, or was not judged although this flight controller reports enough.
    pub fn is_failure(&self) -> bool {
        !matches!(self, Self::Met(_) | Self::Skipped(_))
    }

    /// Returns the tightest number of a met expectation, if it has one.
    pub fn margin(&self) -> Option<&Margin> {
        match self {
            Self::Met(margin) => margin.as_ref(),
            Self::Failed { .. } | Self::NeverJudged(_) | Self::Skipped(_) => None,
        }
    }

    /// Joins two outcomes: the first failure, or the tighter one if both were met.
    pub(super) fn and(self, other: Self) -> Self {
        match (&self, &other) {
            (Self::Met(Some(a)), Self::Met(Some(b))) if b.verdict.share() < a.verdict.share() => other,
            (Self::Met(Some(_)), Self::Met(_)) => self,
            (Self::Met(_), _) => other,
            _ => self,
        }
    }

    /// Adds the guard that came closest to firing at the time.
    pub(super) fn with_guard(mut self, trace: &Trace, time: SimTime) -> Self {
        if let Self::Failed { guard, .. } = &mut self {
            let stay = trace.stays.iter().rev().find(|stay| stay.since <= time);
            *guard = stay.and_then(|stay| {
                let nearest = Trace::nearest_guard(stay)?;
                let firing = &nearest.guard;
                Some(format!(
                    "in {} {} since {} the guard {} came closest at {}: {:.2} {} {:.2} {}",
                    stay.state,
                    stay.wp,
                    trace.shown_time(stay.since),
                    firing.name,
                    trace.shown_time(nearest.time),
                    firing.value,
                    firing.op,
                    firing.limit,
                    firing.unit()
                ))
            });
        }
        self
    }
}

impl Margin {
    /// Returns the text `1.82 m, at most 2.00 m`.
    pub fn shown(&self) -> String {
        describe(&self.verdict)
    }
}

/// Returns the text of a number and its bounds: `2.13 m, at most 2.00 m`.
pub(super) fn describe(verdict: &Verdict) -> String {
    let Verdict { value, low, high, dimension, strict } = *verdict;
    let show = |number| shown(number, dimension);
    // A value that rounds to the bound it is compared with shows the digit that decides.
    let near = if (value - low).abs() < (value - high).abs() { low } else { high };
    let [value_text, near_text] = shown_apart(value, near, dimension);
    let show = |number: f64| if number == near { near_text.clone() } else { show(number) };
    let allowed = match (low.is_finite(), high.is_finite()) {
        (true, true) if low < high => format!("{} to {}", show(low), show(high)),
        (true, true) => format!("exactly {}", show(low)),
        (false, true) if strict => format!("below {}", show(high)),
        (false, _) => format!("at most {}", show(high)),
        (true, false) if strict => format!("above {}", show(low)),
        (true, false) => format!("at least {}", show(low)),
    };
    format!("{value_text}, {allowed}")
}

pub(super) fn met(margin: Option<Margin>) -> Outcome {
    Outcome::Met(margin)
}

pub(super) fn failed(sentence: String, at: Option<SimTime>) -> Outcome {
    Outcome::Failed { sentence, at, guard: None }
}

pub(super) fn unjudged(why: &str) -> Outcome {
    Outcome::NeverJudged(why.to_owned())
}

/// Compares a time with two bounds. No time from zero on can be below a lower bound of zero, so that bound is dropped.
pub(super) fn time_verdict(seconds: f64, low: f64, high: f64) -> Verdict {
    let low = if low == 0.0 && seconds >= 0.0 { f64::NEG_INFINITY } else { low };
    Verdict { value: seconds, low, high, dimension: Dimension::TIME, strict: false }
}

/// Returns the outcome of one number.
pub(super) fn of_verdict(verdict: &Verdict, time: SimTime, trace: &Trace) -> Outcome {
    if verdict.holds() {
        return met(Some(Margin { verdict: *verdict, time }));
    }
    failed(format!("{} (at {})", describe(verdict), trace.shown_time(time)), Some(time))
}
