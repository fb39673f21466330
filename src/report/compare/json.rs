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
    /// Written for a log only.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    is_log: bool,
    repeatable: bool,
    flights: Vec<Flight<'a>>,
}

#[derive(Serialize)]
struct Flight<'a> {
    seed: u64,
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
    difference: Option<Milli>,
    beyond_spread: Option<bool>,
}

#[derive(Serialize)]
struct Value {
    median: Milli,
    min: Milli,
    max: Milli,
    /// The number of flights, or of pairs of flights.
    count: usize,
}

#[derive(Serialize)]
struct Apart {
    between: Option<Value>,
    a: Option<Value>,
    b: Option<Value>,
    beyond_spread: Option<bool>,
}

/// Returns the object in one line.
pub(super) fn object(comparison: &Comparison) -> String {
    let apart = comparison.apart;
    let [a, b] = apart.among.map(|side| side.map(Value::from));
    let object = Object {
        plan: &comparison.plan,
        conditions: &comparison.conditions,
        firmware: comparison.sides.each_ref().map(Firmware::from),
        measures: comparison.rows.iter().map(Line::from).collect(),
        tracks_apart_rms_m: Apart {
            between: apart.between.map(Value::from),
            a,
            b,
            beyond_spread: apart.is_beyond,
        },
    };
    // Numbers and texts always serialise.
    serde_json::to_string(&object).unwrap_or_default()
}

impl<'a> From<&'a Side> for Firmware<'a> {
    fn from(side: &'a Side) -> Self {
        let flights = side.flights.iter().map(Flight::from).collect();
        Self { name: &side.name, is_log: side.is_log, repeatable: side.repeatable, flights }
    }
}

impl<'a> From<&'a Track> for Flight<'a> {
    fn from(track: &'a Track) -> Self {
        let flown_s = track.flown_s.map(Milli::from);
        Self { seed: track.seed, result: &track.result, reason: &track.reason, flown_s }
    }
}

impl From<&Row> for Line {
    fn from(row: &Row) -> Self {
        let (measure, wp) = row.measure.key();
        let [a, b] = row.sides.map(|side| side.map(Value::from));
        let difference = row.difference.map(Milli::from);
        Self { measure, wp, a, b, difference, beyond_spread: row.is_beyond }
    }
}

impl From<Statistics> for Value {
    fn from(value: Statistics) -> Self {
        let Statistics { median, min, max, count } = value;
        Self { median: median.into(), min: min.into(), max: max.into(), count }
    }
}
