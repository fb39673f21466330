//! The check that a stored plan can be flown.

use super::{FlightPlan, MAX_WAYPOINTS, Waypoint};

/// The reason why a plan cannot be flown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, thiserror::Error)]
pub enum PlanFault {
    /// The plan has no waypoint.
    #[error("the plan has no waypoints: add one")]
    Empty,
    /// The stored count is impossible.
    #[error(
        "the stored plan is damaged (it claims {0} waypoints, at most {max} fit): upload it again",
        max = MAX_WAYPOINTS
    )]
    Corrupt(usize),
    /// A record is invalid.
    #[error("waypoint {index}: {fault}")]
    BadWaypoint {
        /// Index of the waypoint.
        index: u8,
        /// The fault of the waypoint.
        fault: WaypointFault,
    },
}

/// A fault of one waypoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, thiserror::Error)]
pub enum WaypointFault {
    /// The type or the pattern has an unknown code.
    #[error("its type or pattern is unknown")]
    Unknown,
    /// The latitude is beyond a pole.
    #[error("its latitude is outside -90 to 90 degrees")]
    Latitude,
    /// The longitude is beyond ±180°.
    #[error("its longitude is outside -180 to 180 degrees")]
    Longitude,
}

/// Checks one waypoint. Modifiers and TAKEOFF have no position of their own, so their position is ignored.
///
/// # Errors
/// Returns the fault if the position is not on the globe.
pub fn check_waypoint(waypoint: &Waypoint) -> Result<(), WaypointFault> {
    if !waypoint.kind.uses_position() {
        return Ok(());
    }
    if waypoint.position.lat_e7.unsigned_abs() > 900_000_000 {
        return Err(WaypointFault::Latitude);
    }
    if waypoint.position.lon_e7.unsigned_abs() > 1_800_000_000 {
        return Err(WaypointFault::Longitude);
    }
    Ok(())
}

/// Checks stored records. `count` is the stored count; `records` are those that could be read, with `None` for a
/// record of an unknown type or pattern. A count above the limit is never used as an index.
///
/// # Errors
/// Returns the first fault in flight order if the plan cannot be flown.
pub fn check_records(
    count: usize,
    records: impl IntoIterator<Item = Option<Waypoint>>,
) -> Result<(), PlanFault> {
    if count == 0 {
        return Err(PlanFault::Empty);
    }
    if count > MAX_WAYPOINTS {
        return Err(PlanFault::Corrupt(count));
    }
    for (index, record) in (0_u8..).zip(records.into_iter().take(count)) {
        let fault = match record {
            None => Err(WaypointFault::Unknown),
            Some(waypoint) => check_waypoint(&waypoint),
        };
        fault.map_err(|fault| PlanFault::BadWaypoint { index, fault })?;
    }
    Ok(())
}

/// Checks a plan.
///
/// # Errors
/// Returns the first fault in flight order if the plan cannot be flown.
pub fn check_plan(plan: &FlightPlan) -> Result<(), PlanFault> {
    check_records(plan.waypoints.len(), plan.waypoints.iter().copied().map(Some))
}
