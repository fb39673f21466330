//! The comparison as one JSON object.

use serde::Serialize;

use super::track::Track;
use super::{Comparison, Row, Side, Statistics};
use crate::report::number::Milli;

#[derive(Serialize)]
struct Object<'a> {
    plan: &'a str,
    conditions: &'a str,
    firmware: [Firmware<'a>; 2],
    measures: Vec<Line>,
    /// The distance to the nearest place of the other track, root mean square.
    tracks_apart_rms_m: Apart,
}

#[derive(Serialize)]
struct Firmware<'a> {
    name: &'a str,
    repeatable: bool,
    flights: Vec<Flight<'a>>,
}

#[derive(Serialize)]
struct Flight<'a> {
    result: &'a str,
    reason: &'a str,
    flown_s: Option<Milli>,
}

#[derive(Serialize)]
struct Line {
    measure: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    wp: Option<u8>,
    a: Option<Value>,
    b: Option<Value>,
    difference: Option<Value>,
}

#[derive(Serialize)]
struct Value {
    mean: Milli,
    spread: Option<Milli>,
    flights: usize,
}

#[derive(Serialize)]
struct Apart {
    between: Option<Value>,
    a: Option<Value>,
    b: Option<Value>,
}

/// Returns the object in one line.
pub(super) fn object(comparison: &Comparison) -> String {
    let [a, b] = comparison.apart.among.map(|side| side.map(Value::from));
    let object = Object {
        plan: &comparison.plan,
        conditions: &comparison.conditions,
        firmware: comparison.sides.each_ref().map(Firmware::from),
        measures: comparison.rows.iter().map(Line::from).collect(),
        tracks_apart_rms_m: Apart { between: comparison.apart.between.map(Value::from), a, b },
    };
    // Numbers and texts always serialise.
    serde_json::to_string(&object).unwrap_or_default()
}

impl<'a> From<&'a Side> for Firmware<'a> {
    fn from(side: &'a Side) -> Self {
        let flights = side.flights.iter().map(Flight::from).collect();
        Self { name: &side.name, repeatable: side.repeatable, flights }
    }
}

impl<'a> From<&'a Track> for Flight<'a> {
    fn from(track: &'a Track) -> Self {
        Self { result: &track.result, reason: &track.reason, flown_s: track.flown_s.map(Milli::from) }
    }
}

impl From<&Row> for Line {
    fn from(row: &Row) -> Self {
        let (measure, wp) = row.measure.key();
        let [a, b] = row.sides.map(|side| side.map(Value::from));
        Self { measure, wp, a, b, difference: row.difference().map(Value::from) }
    }
}

impl From<Statistics> for Value {
    fn from(value: Statistics) -> Self {
        Self { mean: value.mean.into(), spread: value.spread.map(Milli::from), flights: value.count }
    }
}
