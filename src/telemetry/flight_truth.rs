//! What truth says about a flight, beside what the firmware believes.

use super::nav::PlanSource;
use crate::plan::WaypointType;
use crate::signals::SimTime;

/// What truth says about a flight.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FlightTruth {
    /// The waypoints that were flown to their end, in the order in which they ended; of one that was flown again the
    /// last run.
    pub waypoints: Vec<WaypointTruth>,
    /// Where the craft was parked at the end, when the mission left it in the air.
    pub parked: Option<ParkedTruth>,
    /// Charge drawn, percent of the capacity; `None` when nobody knows the battery.
    pub battery_used_pct: Option<f64>,
}

/// A waypoint that was flown, measured by its own rule.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WaypointTruth {
    /// The plan it belongs to.
    pub source: PlanSource,
    /// Index in that plan.
    pub wp: u8,
    pub kind: WaypointType,
    /// Horizontal miss, m: the closest approach of a FLYOVER, that less the turn radius of a FLYBY that was turned at it,
    /// the greatest distance of a HOLD (from its pattern, if it has one) or TAKEOFF, the touchdown distance of a LAND.
    pub miss_m: f64,
    /// True altitude less the altitude of the leg, m; `None` for LAND.
    pub alt_error_m: Option<f64>,
    /// Greatest distance while a hold time ran, m.
    pub hold_max_m: Option<f64>,
    /// What the waypoint's own rule allows horizontally, m.
    pub radius_m: f64,
    /// When `miss_m` was measured.
    pub at: SimTime,
}

/// A craft that is parked in the air after its last waypoint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParkedTruth {
    /// Index of the waypoint.
    pub wp: u8,
    pub kind: WaypointType,
    /// Distance from where it should stay, m; `None` while the pilot flies it or brings it back.
    pub distance_m: Option<f64>,
    /// Altitude less the altitude of the last leg, m.
    pub alt_error_m: f64,
    /// Ground speed, m/s.
    pub speed_mps: f64,
    /// What the waypoint's own rule allows horizontally, m.
    pub radius_m: f64,
}
