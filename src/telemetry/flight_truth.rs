//! The true course of a flight, in contrast to the firmware's estimate.

use super::nav::PlanSource;
use crate::plan::WaypointType;
use crate::signals::SimTime;

/// The true results of a flight.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FlightTruth {
    /// The waypoints that were flown to their end, in the order in which they ended. Of a waypoint that was
    /// flown again, the last run counts.
    pub waypoints: Vec<WaypointTruth>,
    /// The state of the craft at the end, if the mission left it parked in the air.
    pub parked: Option<ParkedTruth>,
    /// The charge drawn, percent of the capacity; `None` if the battery is unknown.
    pub battery_used_pct: Option<f64>,
}

/// A flown waypoint, measured by its own rule.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WaypointTruth {
    /// The plan of the waypoint.
    pub source: PlanSource,
    /// The index in that plan.
    pub wp: u8,
    /// Type of the waypoint.
    pub kind: WaypointType,
    /// The horizontal miss, m. For a FLYOVER it is the closest approach; for a FLYBY at which the craft
    /// turned, that minus the turn radius; for a HOLD (from its pattern, if it has one) or TAKEOFF, the
    /// greatest distance; for a LAND, the distance of the touchdown.
    pub miss_m: f64,
    /// The true altitude minus the altitude of the leg, m; `None` for LAND.
    pub alt_error_m: Option<f64>,
    /// The greatest distance while a hold time ran, m.
    pub hold_max_m: Option<f64>,
    /// The horizontal limit of the waypoint's own rule, m.
    pub radius_m: f64,
    /// The time at which `miss_m` was measured.
    pub at: SimTime,
}

/// A craft that is parked in the air after its last waypoint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParkedTruth {
    /// The index of the waypoint.
    pub wp: u8,
    /// Type of the waypoint.
    pub kind: WaypointType,
    /// The distance from its target, m; `None` while the pilot flies it or brings it back.
    pub distance_m: Option<f64>,
    /// The altitude minus the altitude of the last leg, m.
    pub alt_error_m: f64,
    /// Ground speed, m/s.
    pub speed_mps: f64,
    /// The horizontal limit of the waypoint's own rule, m.
    pub radius_m: f64,
}
