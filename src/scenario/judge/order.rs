//! Expectations about the order of states.

use super::outcome::{Outcome, failed, met, unjudged};
use crate::scenario::case::StateStep;
use crate::scenario::expression::Evaluator;
use crate::scenario::happening::{Entered, Happening, HappeningKind};
use crate::telemetry::PlanSource;

/// Compares the states from the first engagement on with the expected ones.
pub(super) fn judge(steps: &[StateStep], evaluator: &Evaluator<'_>) -> Outcome {
    let trace = evaluator.trace();
    let Some(engaged_at) = trace.engaged_at else { return unjudged("the autopilot never engaged") };
    let seen: Vec<(&Happening, &Entered)> = trace
        .happenings
        .iter()
        .filter(|happening| happening.time >= engaged_at)
        .filter_map(|happening| match &happening.kind {
            HappeningKind::State(entered) => Some((happening, entered)),
            HappeningKind::Event { .. } => None,
        })
        .collect();
    // The numbers of steps that can explain the first `place` states.
    let mut reached = vec![closure(steps, 0)];
    for (place, (_, entered)) in seen.iter().enumerate() {
        let mut next: Vec<usize> = Vec::new();
        for &step in &reached[place] {
            match steps.get(step) {
                Some(StateStep::Any) => next.push(step),
                Some(expected) if expected.fits(entered) => next.push(step + 1),
                _ => {}
            }
        }
        let mut open: Vec<usize> = next.into_iter().flat_map(|step| closure(steps, step)).collect();
        open.sort_unstable();
        open.dedup();
        if open.is_empty() {
            return unexpected(steps, &reached[place], &seen, place, evaluator);
        }
        reached.push(open);
    }
    let open = reached.last().map(Vec::as_slice).unwrap_or_default();
    if open.contains(&steps.len()) {
        return met(None);
    }
    let end = trace.end();
    let last = seen.last().map_or_else(|| "nothing".to_owned(), |(happening, _)| happening.to_string());
    let sentence = format!("after {last} {} was expected but did not come", wanted(steps, open));
    failed(sentence, Some(end)).with_guard(trace, end)
}

/// Returns a step and the steps after it that need no state.
fn closure(steps: &[StateStep], step: usize) -> Vec<usize> {
    let mut open = vec![step];
    let mut at = step;
    while steps.get(at) == Some(&StateStep::Any) {
        at += 1;
        open.push(at);
    }
    open
}

fn unexpected(
    steps: &[StateStep],
    open: &[usize],
    seen: &[(&Happening, &Entered)],
    place: usize,
    evaluator: &Evaluator<'_>,
) -> Outcome {
    let trace = evaluator.trace();
    let (happening, entered) = seen[place];
    let after = match place.checked_sub(1).and_then(|before| seen.get(before)) {
        Some((before, _)) => format!("after {before}"),
        None => "at first".to_owned(),
    };
    let sentence = format!(
        "{after} came {happening} (by {}) at {}, {} was expected",
        entered.reason,
        trace.shown_time(happening.time),
        wanted(steps, open)
    );
    // The guards of the previous state.
    let before = crate::signals::SimTime(happening.time.0.saturating_sub(20_000));
    failed(sentence, Some(happening.time)).with_guard(trace, before)
}

/// Returns the expected steps in words.
fn wanted(steps: &[StateStep], open: &[usize]) -> String {
    let words: Vec<String> = open
        .iter()
        .map(|&step| match steps.get(step) {
            Some(StateStep::Any) => "any state".to_owned(),
            Some(step) => step.to_string(),
            None => "nothing more".to_owned(),
        })
        .collect();
    words.join(" or ")
}

impl StateStep {
    fn fits(&self, entered: &Entered) -> bool {
        match *self {
            Self::Any => true,
            Self::Enter { state, wp, source } => {
                state == entered.state
                    && wp.is_none_or(|wp| wp == entered.wp)
                    && source.is_none_or(|source| source == entered.source)
            }
        }
    }
}

impl std::fmt::Display for StateStep {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Any => f.write_str("..."),
            Self::Enter { state, wp, source } => {
                write!(f, "{state}")?;
                if let Some(wp) = wp {
                    write!(f, " {wp}")?;
                }
                match source {
                    Some(PlanSource::Stored) | None => Ok(()),
                    Some(source) => write!(f, " of {source}"),
                }
            }
        }
    }
}
