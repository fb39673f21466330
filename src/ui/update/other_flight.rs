//! The second flight of a comparison: its arrival, and the shift of its times.

use std::sync::Arc;

use crate::replay::Overview;
use crate::ui::acts::origin::origin;
use crate::ui::model::event_log::Severity;
use crate::ui::model::other_flight::OtherFlight;
use crate::ui::shared::Shared;

/// The time of a shift, µs.
const SHIFT_US: i64 = 100_000;

/// Shows a second flight, or the reason why there is none.
pub(super) fn take(state: &mut Shared, name: String, result: Result<Arc<Overview>, String>) {
    match result {
        Ok(overview) => {
            state.other = Some(OtherFlight::new(name, overview));
            follow(state);
        }
        Err(why) => state.notify(Severity::Fault, why),
    }
}

/// Puts the second flight on the map of the newest view, and reports its alignment if it is another one.
pub(super) fn follow(state: &mut Shared) {
    if let Some(origin) = origin(state)
        && let Some(other) = &mut state.other
    {
        other.place_on(origin);
    }
    let aligned = state.other_aligned();
    if let Some(other) = &mut state.other
        && aligned.is_some()
        && other.reported != aligned
    {
        other.reported = aligned;
        say_alignment(state);
    }
}

/// Shifts the times of the second flight by some steps.
pub(super) fn shift(state: &mut Shared, steps: i64) {
    if let Some(other) = &mut state.other {
        other.shift(steps * SHIFT_US);
    }
    follow(state);
}

fn say_alignment(state: &mut Shared) {
    let Some((other, (alignment, _))) = state.other.as_ref().zip(state.other_aligned()) else { return };
    let shift_s = other.shift_s();
    let shifted = if shift_s == 0.0 {
        String::new()
    } else {
        let way = if shift_s < 0.0 { "earlier" } else { "later" };
        format!(", and {:.1} s {way}", shift_s.abs())
    };
    let text = format!("{} is aligned {alignment}{shifted}.", other.name);
    state.notify(Severity::Info, text);
}
