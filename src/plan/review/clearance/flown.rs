//! The clearance of a flight that was flown ahead of time: in the wind, with real climbs and shorter corners.

use super::{Before, LowClearance, Raise, SHORT_M, Way};
use crate::geo::LatLon;
use crate::plan::estimate::{Assumptions, estimate};
use crate::plan::review::{Finding, leg_altitudes};
use crate::plan::{FlightPlan, Then};
use crate::terrain::Relief;

/// The landing begins this near the end of the plan, m.
const AT_THE_END_M: f64 = 1.0;

/// A place of the flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlownPlace {
    /// The place.
    pub place: LatLon,
    /// The distance flown along the plan, m.
    pub along_m: f64,
    /// Above home, m.
    pub alt_m: f64,
}

/// Returns the legs whose flight comes closer to the ground than `margin_m`, without those of `known`. The climb at
/// home and the landing are left out.
pub fn low_in_flight(
    plan: &FlightPlan,
    assumptions: &Assumptions,
    relief: &Relief,
    margin_m: f64,
    path: impl IntoIterator<Item = FlownPlace>,
    known: &[Finding],
) -> Vec<Finding> {
    let estimated = estimate(plan, relief.home(), assumptions);
    let altitudes: Vec<_> = leg_altitudes(&plan.waypoints).collect();
    // The end of each leg along the plan, m.
    let mut end_m = 0.0;
    let ends: Vec<f64> = altitudes
        .iter()
        .map(|leg| {
            end_m += estimated.legs.get(leg.index).and_then(|leg| leg.distance_m).unwrap_or(0.0);
            end_m
        })
        .collect();
    let lands = plan.waypoints.iter().any(|waypoint| waypoint.kind.capability().then == Then::Land);
    let landing_m = if lands { end_m - AT_THE_END_M } else { f64::INFINITY };
    let mut lowest: Vec<Option<LowClearance>> = vec![None; altitudes.len()];
    for FlownPlace { place, along_m, alt_m } in path {
        if along_m <= 0.0 || along_m >= landing_m {
            continue;
        }
        let leg = ends.partition_point(|&end_m| end_m < along_m);
        let (Some(altitude), Some(ground_m)) = (altitudes.get(leg), relief.above_home_m(place)) else {
            continue;
        };
        let clearance_m = alt_m - ground_m;
        let start_m = assumptions.start_alt_m.max(0.0);
        let margin_here_m = if leg == 0 { margin_m.min(start_m) } else { margin_m };
        if clearance_m >= margin_here_m - SHORT_M
            || lowest[leg].is_some_and(|lowest| lowest.clearance_m <= clearance_m)
        {
            continue;
        }
        let begin_m = leg.checked_sub(1).map_or(0.0, |before| ends[before]);
        let raise = Raise {
            to_m: (altitude.alt_m + margin_m - clearance_m).ceil(),
            waypoint: Some(altitude.said_by),
            before: leg
                .checked_sub(1)
                .map_or(Before::Nothing, |before| Before::Waypoint(altitudes[before].said_by)),
        };
        lowest[leg] = Some(LowClearance {
            index: altitude.index,
            way: Way::Flown,
            place,
            along_m: along_m - begin_m,
            clearance_m,
            margin_m,
            raise,
        });
    }
    let is_known = |low: &LowClearance| {
        known.iter().any(|finding| {
            matches!(finding, Finding::LowClearance(known) if known.way == Way::Leg && known.index == low.index)
        })
    };
    lowest.into_iter().flatten().filter(|low| !is_known(low)).map(Finding::LowClearance).collect()
}
