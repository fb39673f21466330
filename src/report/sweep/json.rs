//! A sweep as one JSON object.

use serde_json::{Map, Value, json};
use strum::IntoEnumIterator as _;

use super::SweptFlight;
use crate::flight::sweep::{Fate, SweepPoint};

/// Returns the results as one JSON object. Lengths are in metres, times in seconds.
pub fn sweep_json(swept: &SweptFlight<'_>) -> String {
    let counts: Map<String, Value> =
        Fate::iter().map(|fate| (fate.to_string(), json!(swept.count(fate)))).collect();
    let object = json!({
        "event": "sweep",
        "name": swept.name,
        "fault": swept.fault_name(),
        "without": swept.without.map(|(result, reason)| json!({"result": result, "reason": reason})),
        "counts": counts,
        "seconds": swept.points.iter().map(second).collect::<Vec<_>>(),
    });
    object.to_string()
}

fn second(point: &SweepPoint) -> Value {
    let [east, north, up] = point.place_enu;
    json!({
        "second": point.second,
        "fate": point.fate.to_string(),
        "result": point.result.to_string(),
        "reason": point.reason,
        "off_m": point.off_m,
        "after_s": point.after_s,
        "north_m": north,
        "east_m": east,
        "up_m": up,
    })
}
