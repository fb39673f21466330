//! Judgements of inputs that were not carried out. A flight without them does not show the intended behaviour.

use super::outcome::{failed, unjudged};
use super::{Judgement, Outcome};
use crate::scenario::case::{Case, Expected};
use crate::scenario::happening::{EventName, Happening, HappeningKind, Pattern};
use crate::scenario::input::TimedInput;
use crate::scenario::trace::Trace;
use crate::signals::SimTime;

/// Returns a judgement for each input whose instant did not come, and for each refused input unless an expectation is
/// about refusals.
pub(super) fn judge(case: &Case, trace: &Trace) -> Vec<Judgement> {
    let refusals_are_expected = case.expectations.iter().any(|expectation| {
        matches!(
            &expectation.expected,
            Expected::Event { pattern: Pattern::Event { name: EventName::Refusal, .. }, .. }
                | Expected::NoEvent(Pattern::Event { name: EventName::Refusal, .. })
        )
    });
    let mut judgements = Vec::new();
    for input in &case.inputs {
        let outcome = match trace.happenings.iter().position(|happening| is_of(happening, input)) {
            None => Some(unjudged("its instant did not come, so it was not carried out")),
            Some(_) if refusals_are_expected => None,
            Some(place) => refusal(&trace.happenings[place + 1..])
                .map(|(why, time)| failed(format!("it was refused: {why}"), Some(time))),
        };
        judgements.extend(outcome.map(|outcome: Outcome| Judgement {
            label: format!("input {}", input.text),
            line: input.line,
            outcome,
        }));
    }
    judgements
}

/// Returns `true` if the happening reports that the input was carried out.
fn is_of(happening: &Happening, input: &TimedInput) -> bool {
    matches!(&happening.kind, HappeningKind::Event { name: EventName::Input, words, .. } if words.contains(&input.name))
}

/// Returns the reason and the time of a refusal, from the happenings after an input. A refusal comes at once, before
/// any other action.
fn refusal(behind: &[Happening]) -> Option<(&str, SimTime)> {
    for happening in behind {
        match &happening.kind {
            HappeningKind::Event { name: EventName::Refusal, text, .. } => {
                return Some((text, happening.time));
            }
            HappeningKind::Event { name: EventName::Reply, .. } => {}
            _ => return None,
        }
    }
    None
}
