//! One JSON object in each line: events, samples and the end of a flight.
//!
//! Every line starts with `t`, simulated seconds since boot, and `event`. Units are SI, angles are degrees, altitudes
//! are metres above home. New keys may be added; keys are never removed or renamed. Two equal flights give equal bytes,
//! except for `wall_s` and `speed_ratio`.

mod event;
mod sample;
mod truth;

use serde::Serialize;

use crate::events::Event;
use crate::signals::SimTime;
use crate::telemetry::Snapshot;

use super::End;
use super::number::{Decimals, Milli};

/// Returns the line of an event, without line end; `None` for the few events that only matter inside the craft.
pub fn event_line(event: &Event) -> Option<String> {
    event::Fields::of(&event.kind).map(|(name, fields)| line(event.time, name, &fields))
}

/// Returns the line of a sample, without line end.
pub fn sample_line(snapshot: &Snapshot) -> String {
    line(snapshot.time, "sample", &sample::Fields(snapshot))
}

/// Returns the last line of a flight, without line end.
pub fn end_line(time: SimTime, end: &End) -> String {
    #[derive(Serialize)]
    struct Fields<'a> {
        result: &'a str,
        reason: &'a str,
        #[serde(flatten)]
        truth: truth::Fields,
        flown_s: Milli,
        wall_s: Milli,
        speed_ratio: Decimals<1>,
        #[serde(skip_serializing_if = "Option::is_none")]
        hash: Option<String>,
    }
    let fields = Fields {
        result: &end.result,
        reason: &end.reason,
        truth: truth::Fields::of(&end.truth),
        flown_s: Decimals(end.flown_s),
        wall_s: Decimals(end.wall_s),
        speed_ratio: Decimals(end.speed_ratio()),
        hash: end.hash.map(|hash| format!("{hash:016x}")),
    };
    line(time, "end", &fields)
}

/// Returns a line with time and name before the fields.
fn line(time: SimTime, event: &str, fields: &impl Serialize) -> String {
    #[derive(Serialize)]
    struct Line<'a, T: Serialize> {
        t: Decimals<6>,
        event: &'a str,
        #[serde(flatten)]
        fields: &'a T,
    }
    let line = Line { t: Decimals(time.as_secs_f64()), event, fields };
    // The maps and numbers of a line always serialise. The fallback still gives one object in each line.
    serde_json::to_string(&line).unwrap_or_else(|error| format!("{{\"error\":\"{error}\"}}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::telemetry::FlightTruth;

    #[test]
    fn the_end_has_its_keys_in_order() {
        let end = End {
            result: "timeout".to_owned(),
            reason: "1800 s are over".to_owned(),
            truth: FlightTruth { battery_used_pct: Some(4.25), ..FlightTruth::default() },
            flown_s: 12.3456,
            wall_s: 0.5,
            hash: None,
        };
        assert_eq!(
            end_line(SimTime(20_000_000), &end),
            "{\"t\":20.0,\"event\":\"end\",\"result\":\"timeout\",\"reason\":\"1800 s are over\",\
             \"battery_used_pct\":4.25,\"waypoints\":[],\"parked_m\":null,\"parked_mps\":null,\"flown_s\":12.346,\
             \"wall_s\":0.5,\"speed_ratio\":24.7}"
        );
    }
}
