//! The legs of the plan: distance, bearing, the time at which the craft is done, and the charge drawn by then.
//!
//! Distance, bearing and time are those of `plan show`. The charge is that of the flown estimate.

use crate::plan::estimate::estimate;
use crate::ui::acts::{findings, settings_in_force};
use crate::ui::formatting::compass;
use crate::ui::shared::Shared;

/// The width of each column.
pub(super) const WIDTHS: [u16; 4] = [10, 9, 7, 9];
/// The value of a waypoint that has none.
const NONE: &str = "—";

/// Returns the heads of the columns.
pub(super) fn heads(state: &Shared) -> [String; 4] {
    [
        format!("leg {}", state.units.length_unit()),
        "bearing".to_owned(),
        "done".to_owned(),
        "battery".to_owned(),
    ]
}

/// Returns the values of each waypoint.
pub(super) fn rows(state: &Shared) -> Vec<[String; 4]> {
    let document = state.editor.document();
    let Some(home) = findings::home(state) else { return Vec::new() };
    let estimated = estimate(&document.plan, home, &settings_in_force::assumptions(state, document));
    let flown = state.forecast.estimate().filter(|_| !state.forecast.is_estimating());
    let used_pct = |index: usize| {
        let leg = flown?.legs.iter().rfind(|leg| usize::from(leg.wp) == index)?;
        Some(leg.battery_used_pct)
    };
    let or_none = |value: Option<String>| value.unwrap_or_else(|| NONE.to_owned());
    let waypoints = document.plan.waypoints.iter().zip(&estimated.legs).enumerate();
    let row = waypoints.map(|(index, (wp, leg))| {
        let done = match leg.done_s {
            _ if !wp.kind.is_positional() => None,
            Some(seconds) => Some(clock(seconds)),
            None => Some("never".to_owned()),
        };
        [
            or_none(leg.distance_m.map(|metres| format!("{:.1}", state.units.length(metres)))),
            or_none(leg.bearing_deg.map(|degrees| format!("{:03.0}°", compass(degrees)))),
            or_none(done),
            or_none(used_pct(index).map(|percent| format!("{percent:.0} %"))),
        ]
    });
    row.collect()
}

/// Returns the leg to the waypoint under the cursor as a line, for a table without room for its columns.
pub(super) fn line(state: &Shared) -> Option<String> {
    let index = state.editor.row();
    let [length, bearing, done, used] = rows(state).into_iter().nth(index)?;
    let unit = state.units.length_unit();
    Some(format!("leg to WP{index}: {length} {unit} {bearing}, done {done}, battery {used}"))
}

/// Returns minutes and seconds: `4:05`.
fn clock(seconds: f64) -> String {
    let seconds = seconds.round() as u64;
    format!("{}:{:02}", seconds / 60, seconds % 60)
}
