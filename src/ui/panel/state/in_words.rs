//! The state without a screen: the status message, the state, its guards, the last transitions.

use super::transition_list::why;
use super::{is_watch, short, short_name, time_of_leg};
use crate::telemetry::Guard;
use crate::ui::acts::status_message;
use crate::ui::formatting::clock_ms;
use crate::ui::panel::in_words::number;
use crate::ui::shared::Shared;
use crate::ui::transitions::Transitions;

/// The number of transitions shown.
const TRANSITIONS: usize = 10;

/// Returns the state as lines of text.
pub(super) fn lines(transitions: &Transitions, state: &Shared) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(message) = status_message::current(state) {
        lines.push(format!("{} → {}.", message.condition, message.action));
    }
    let Some(nav) = &state.view.vehicle.nav else {
        lines.push("The state of the autopilot is not known.".to_owned());
        return lines;
    };
    lines.push(format!("State: {}.", nav.state));
    lines.extend(nav.guards.iter().map(|guard| in_words(state, guard)));
    if let Some((seconds, _)) = time_of_leg(state) {
        lines.push(format!("Rest of the leg: {} s.", number(Some(seconds), 0)));
    }
    let shown = transitions.shown(state);
    lines.extend(shown.rev().take(TRANSITIONS).map(|step| {
        format!("{} {} → {}: {}.", clock_ms(step.time), step.from, step.to, why(step, usize::MAX))
    }));
    lines
}

/// Returns a guard with its value, its limit and its result: `Guard turn radius: 62.4 ≤ 5.5 m, not yet.`
fn in_words(state: &Shared, guard: &Guard) -> String {
    let (factor, unit) = state.units.of_guard(guard.unit());
    let value = number(Some(guard.value * factor), 1);
    let result = match (is_watch(guard), guard.holds()) {
        (false, true) => "holds",
        (false, false) => "not yet",
        (true, true) => "reached",
        (true, false) => "not reached",
    };
    let limit = short(guard.limit * factor);
    format!("Guard {}: {} {} {limit} {unit}, {result}.", short_name(guard), value, guard.op)
}
