//! Whether a stored plan can be flown at all.

use super::{FlightPlan, MAX_WAYPOINTS, Waypoint};

/// Why a plan cannot be flown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, thiserror::Error)]
pub enum PlanFault {
    #[error("the plan has no waypoints: add one")]
    Empty,
    /// The stored count is impossible.
    #[error("the stored plan is damaged (it claims {0} waypoints, {max} is the most): upload it again", max = MAX_WAYPOINTS)]
    Corrupt(usize),
    /// A record is invalid.
    #[error("waypoint {index}: {fault}")]
    BadWaypoint {
        /// Index of the waypoint.
        index: u8,
        /// What is wrong with it.
        fault: WaypointFault,
    },
}

/// What is wrong with one waypoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, thiserror::Error)]
pub enum WaypointFault {
    /// Type or pattern has a code nobody knows.
    #[error("its type or pattern is unknown")]
    Unknown,
    /// The latitude is beyond a pole.
    #[error("its latitude is outside -90 to 90 degrees")]
    Latitude,
    /// The longitude is beyond ±180°.
    #[error("its longitude is outside -180 to 180 degrees")]
    Longitude,
}

/// Checks one waypoint. Modifiers and TAKEOFF have no position of their own, so theirs is not looked at.
///
/// # Errors
/// When its position is off the globe.
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

/// Checks stored records: `count` as stored, `records` as far as they could be read, `None` for one whose type or
/// pattern is unknown. A count above the limit is never used as an index.
///
/// # Errors
/// When the plan cannot be flown; the first fault in flight order.
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
/// When it cannot be flown; the first fault in flight order.
pub fn check_plan(plan: &FlightPlan) -> Result<(), PlanFault> {
    check_records(plan.waypoints.len(), plan.waypoints.iter().copied().map(Some))
}
