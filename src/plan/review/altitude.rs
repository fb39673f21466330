//! Altitudes that are probably a mistake: above a limit of the user, or far above all others of the plan.

use super::Finding;
use crate::plan::{Modifier, Waypoint};

/// An altitude is far above the others if it is this many times their median …
const TIMES_THE_OTHERS: f64 = 5.0;
/// … and this far above the highest of them, m.
const ABOVE_THE_OTHERS_M: f64 = 50.0;
/// The least number of others; fewer than that have no usual altitude.
const FEWEST_OTHERS: usize = 2;

/// The altitude of the leg to a waypoint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegAltitude {
    /// The positional waypoint.
    pub index: usize,
    /// The waypoint that gives the altitude: the same one, or the ALT_CHANGE before it.
    pub said_by: usize,
    /// The altitude above home, m.
    pub alt_m: f64,
}

/// Returns the altitude of the leg to each positional waypoint.
pub fn legs(waypoints: &[Waypoint]) -> impl Iterator<Item = LegAltitude> {
    let mut changed = None;
    waypoints.iter().enumerate().filter_map(move |(index, waypoint)| {
        let own = (index, waypoint.altitude.above_home_m());
        if waypoint.kind.modifier() == Some(Modifier::Altitude) {
            changed = Some(own);
        }
        if !waypoint.kind.is_positional() {
            return None;
        }
        let (said_by, alt_m) = changed.take().unwrap_or(own);
        Some(LegAltitude { index, said_by, alt_m })
    })
}

/// Returns the legs that are flown too high, those far above the others first.
pub(super) fn too_high(waypoints: &[Waypoint], limit_m: Option<f64>) -> Vec<Finding> {
    let altitudes = altitudes(waypoints);
    let far_above = (0..altitudes.len()).filter_map(|at| far_above_the_others(&altitudes, at));
    let above_the_limit = altitudes.iter().filter_map(|&(index, alt_m)| {
        let limit_m = limit_m.filter(|&limit_m| alt_m > limit_m)?;
        Some(Finding::AboveLimit { index, alt_m, limit_m })
    });
    far_above.chain(above_the_limit).collect()
}

fn altitudes(waypoints: &[Waypoint]) -> Vec<(usize, f64)> {
    legs(waypoints).map(|leg| (leg.said_by, leg.alt_m)).collect()
}

fn far_above_the_others(altitudes: &[(usize, f64)], at: usize) -> Option<Finding> {
    let (index, alt_m) = altitudes[at];
    let others = altitudes.iter().enumerate().filter(|(other, _)| *other != at);
    let mut others: Vec<f64> = others.map(|(_, &(_, alt_m))| alt_m).collect();
    others.sort_by(f64::total_cmp);
    let highest_m = *others.last().filter(|_| others.len() >= FEWEST_OTHERS)?;
    let usual_m = others[others.len() / 2];
    // If the others are at or below home, there is no usual altitude and no value to lower it to.
    let is_far =
        usual_m > 0.0 && alt_m > TIMES_THE_OTHERS * usual_m && alt_m > highest_m + ABOVE_THE_OTHERS_M;
    is_far.then_some(Finding::FarAboveOthers { index, alt_m, usual_m })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Altitude, WaypointType};

    fn found(altitudes_m: &[i32], limit_m: Option<f64>) -> Vec<String> {
        let at =
            |&alt_m: &i32| Waypoint { altitude: Altitude::above_home(alt_m.into()), ..Waypoint::default() };
        let waypoints: Vec<Waypoint> = altitudes_m.iter().map(at).collect();
        too_high(&waypoints, limit_m).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn a_digit_too_many_is_reported() {
        assert_eq!(
            found(&[50, 500, 50, 20], None),
            ["waypoint 1 is 500 m above home, far above the others (50 m)"]
        );
        assert!(found(&[10, 55, 10], None).is_empty(), "not 50 m above the highest of the others");
        assert!(found(&[50, 200, 50], None).is_empty(), "not five times as high");
        assert!(found(&[5, 500], None).is_empty(), "which of two is meant is not known");
        assert!(found(&[50, 500, 400], None).is_empty(), "another is as high");
        assert!(found(&[-5, -5, 46], None).is_empty(), "it would be lowered into the ground");
        assert!(found(&[0, 0, 60], None).is_empty(), "it would be lowered to the ground");
    }

    #[test]
    fn every_waypoint_above_the_limit_is_reported() {
        assert_eq!(
            found(&[120, 121, 150], Some(120.0)),
            [
                "waypoint 1 is 121 m above home, the limit (max_altitude_m) is 120 m",
                "waypoint 2 is 150 m above home, the limit (max_altitude_m) is 120 m",
            ]
        );
    }

    #[test]
    fn the_waypoint_that_says_the_altitude_is_reported() {
        let change = Waypoint {
            kind: WaypointType::AltChange,
            altitude: Altitude::above_home(200.0),
            ..Waypoint::default()
        };
        let waypoints = [change, Waypoint { altitude: Altitude::above_home(50.0), ..Waypoint::default() }];
        let found = too_high(&waypoints, Some(120.0));
        assert_eq!(found, [Finding::AboveLimit { index: 0, alt_m: 200.0, limit_m: 120.0 }]);
    }
}
