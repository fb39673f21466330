//! The true values of a flight, as fields of its last line.

use serde::Serialize;

use crate::report::number::{Centi, Decimals, Milli};
use crate::telemetry::{FlightTruth, WaypointTruth};

/// The fields, in their order.
#[derive(Serialize)]
pub(super) struct Fields {
    battery_used_pct: Option<Centi>,
    waypoints: Vec<Waypoint>,
    parked_m: Option<Milli>,
    parked_mps: Option<Milli>,
}

#[derive(Serialize)]
struct Waypoint {
    wp: u8,
    #[serde(rename = "type")]
    kind: &'static str,
    miss_m: Milli,
    miss_alt_m: Option<Milli>,
    hold_max_m: Option<Milli>,
    at: Decimals<6>,
    source: String,
}

impl Fields {
    pub(super) fn of(truth: &FlightTruth) -> Self {
        Self {
            battery_used_pct: truth.battery_used_pct.map(Decimals),
            waypoints: truth.waypoints.iter().map(Waypoint::of).collect(),
            parked_m: truth.parked.and_then(|parked| parked.distance_m).map(Decimals),
            parked_mps: truth.parked.map(|parked| Decimals(parked.speed_mps)),
        }
    }
}

impl Waypoint {
    fn of(truth: &WaypointTruth) -> Self {
        Self {
            wp: truth.wp,
            kind: truth.kind.into(),
            miss_m: Decimals(truth.miss_m),
            miss_alt_m: truth.alt_error_m.map(|error_m| Decimals(error_m.abs())),
            hold_max_m: truth.hold_max_m.map(Decimals),
            at: Decimals(truth.at.as_secs_f64()),
            source: truth.source.to_string(),
        }
    }
}
