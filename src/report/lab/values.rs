//! The signals of a flight as CSV.

use std::fmt::Write as _;

use crate::scenario::{Flown, Sample};
use crate::telemetry::signal::SIGNALS;

/// The samples of a flight for each row.
const EVERY: usize = 5;

/// Returns the signals of a flight: a column for each, with its name in scenarios and its unit, and the state of the mission.
/// Unknown values are empty.
pub fn values(flown: &Flown) -> String {
    let mut text = String::from("state,waypoint");
    for info in SIGNALS {
        let unit = info.dimension.unit().map_or(String::new(), |unit| format!(" [{}]", unit.name));
        _ = write!(text, ",{}{unit}", info.name);
    }
    text.push('\n');
    flown.trace.samples.iter().step_by(EVERY).for_each(|sample| row(&mut text, sample));
    text
}

fn row(text: &mut String, sample: &Sample) {
    _ = write!(text, "{},{}", sample.state, sample.wp);
    for value in SIGNALS.iter().map(|info| sample.value(info.signal)) {
        _ = if value.is_finite() { write!(text, ",{value:.4}") } else { write!(text, ",") };
    }
    text.push('\n');
}
