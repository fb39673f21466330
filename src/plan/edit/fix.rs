//! Edits that resolve findings of the review.

use nalgebra::Vector2;

use super::PlanDocument;
use crate::geo::{GroundPlane, LatLon, distance_bearing};
use crate::math;
use crate::plan::review::{Before, Finding, LowClearance, Raise, Remedy, SteepLeg};
use crate::plan::validate::{PlanFault, WaypointFault};
use crate::plan::{Altitude, HoldPattern, LegSpeed, Seconds, Then, Waypoint, WaypointType};

/// The distance from home to which a waypoint is moved, as a share of the fence. It leaves room for the turn.
const INSIDE_FENCE: f64 = 0.95;
/// The new altitude of a waypoint that was below the ground, m.
const RAISED_M: f64 = 10.0;

/// The time of a HOLD that only waits for its altitude, s; 0 would hold forever.
const MIN_HOLD_S: f64 = 0.1;
/// The time suggested for a HOLD that lasts forever, s.
const OFFERED_HOLD_S: f64 = 10.0;

/// An edit that the editor suggests.
#[derive(Debug, Clone, PartialEq)]
pub struct Fix {
    /// The effect in a few words.
    pub title: String,
    /// The document after the edit.
    pub document: PlanDocument,
}

/// Returns the first waypoint of a finding.
pub fn waypoint_of(finding: &Finding) -> Option<usize> {
    match finding {
        Finding::Fault(PlanFault::BadWaypoint { index, .. }) => Some(usize::from(*index)),
        Finding::OutsideFence { index, .. }
        | Finding::NeverFlown { index, .. }
        | Finding::NothingToModify { index, .. }
        | Finding::SpeedLimited { index, .. }
        | Finding::SteepLeg(SteepLeg { index, .. })
        | Finding::LowClearance(LowClearance { index, .. })
        | Finding::AboveLimit { index, .. }
        | Finding::FarAboveOthers { index, .. }
        | Finding::AgainstZone { index, .. }
        | Finding::BelowGround { index, .. } => Some(*index),
        Finding::Fault(PlanFault::Empty | PlanFault::Corrupt(_))
        | Finding::StaysInTheAir
        | Finding::OutlastsBattery { .. }
        | Finding::CraftDiffers { .. }
        | Finding::FlownAgainstZone { .. }
        | Finding::NoTouchdownThrottle(_) => None,
    }
}

/// Returns an edit of the plan that resolves the finding, if there is one.
pub fn fix(document: &PlanDocument, finding: &Finding, home: LatLon) -> Option<Fix> {
    let mut fixed = document.clone();
    let waypoints = &mut fixed.plan.waypoints;
    let title = match *finding {
        Finding::OutsideFence { index, limit_m, .. } => {
            let wp = waypoints.get_mut(index)?;
            let (_, bearing) = distance_bearing(home, wp.position);
            let inside = Vector2::new(math::cos(bearing), math::sin(bearing)) * (INSIDE_FENCE * limit_m);
            wp.position = GroundPlane::new(home).to_position(inside);
            format!("move WP{index} inside the fence")
        }
        Finding::NeverFlown { index, kind } if kind.capability().then == Then::Hold => {
            waypoints.get_mut(index)?.duration = Seconds::new(OFFERED_HOLD_S);
            format!("hold WP{index} for {OFFERED_HOLD_S} s")
        }
        Finding::NeverFlown { index, .. } => {
            let behind = waypoints.len().checked_sub(index + 1)?;
            waypoints.truncate(index + 1);
            format!("delete the {behind} after WP{index}")
        }
        Finding::NothingToModify { index, kind } => {
            waypoints.pop_at(index)?;
            format!("delete WP{index} {kind}")
        }
        Finding::SpeedLimited { index, .. } => {
            waypoints.get_mut(index)?.speed = LegSpeed::default();
            format!("fly WP{index} at ap_max_velocity")
        }
        Finding::BelowGround { index, .. } => {
            waypoints.get_mut(index)?.altitude = Altitude::above_home(RAISED_M);
            format!("raise WP{index} to {RAISED_M} m")
        }
        Finding::AboveLimit { index, limit_m: lower_m, .. }
        | Finding::FarAboveOthers { index, usual_m: lower_m, .. } => {
            waypoints.get_mut(index)?.altitude = Altitude::above_home((lower_m * 100.0).floor() / 100.0);
            let decimals = usize::from(lower_m.fract() != 0.0);
            format!("lower WP{index} to {lower_m:.decimals$} m")
        }
        Finding::SteepLeg(SteepLeg { index, remedy: Remedy::Slow { speed }, .. }) => {
            waypoints.get_mut(index)?.speed = speed;
            format!("fly WP{index} at {:.1} m/s", speed.mps())
        }
        Finding::SteepLeg(SteepLeg { index, alt_m, remedy: Remedy::HoldFirst, .. }) => {
            let before = waypoints.get(..index)?.iter().rposition(|wp| wp.kind.is_positional());
            let place = before.and_then(|before| {
                waypoints[..=before].iter().rev().find(|wp| wp.kind.uses_position()).map(|wp| wp.position)
            });
            let hold = Waypoint {
                kind: WaypointType::Hold,
                position: place.unwrap_or(home),
                altitude: Altitude::above_home(alt_m),
                duration: Seconds::new(MIN_HOLD_S),
                pattern: HoldPattern::None,
                ..Waypoint::default()
            };
            waypoints.try_insert(before.map_or(0, |before| before + 1), hold).ok()?;
            format!("reach {alt_m:.0} m in a HOLD before WP{index}")
        }
        Finding::LowClearance(LowClearance { raise, .. }) => raised(&mut fixed, raise)?,
        Finding::StaysInTheAir => {
            let last = *waypoints.iter().rev().find(|wp| wp.kind.uses_position())?;
            let land = Waypoint {
                kind: WaypointType::Land,
                position: last.position,
                altitude: last.altitude,
                ..Waypoint::default()
            };
            waypoints.try_push(land).ok()?;
            "add a LAND at the last place".to_owned()
        }
        Finding::Fault(PlanFault::BadWaypoint { index, fault }) => {
            let position = &mut waypoints.get_mut(usize::from(index))?.position;
            match fault {
                WaypointFault::Latitude => position.lat_e7 = position.lat_e7.clamp(-900_000_000, 900_000_000),
                WaypointFault::Longitude => position.lon_e7 = wrapped(position.lon_e7),
                WaypointFault::Unknown => return None,
            }
            format!("bring WP{index} back onto the globe")
        }
        Finding::NoTouchdownThrottle(_) => {
            fixed.settings.retain(|line| !line.starts_with("ap_landing_throttle_threshold"));
            fixed.settings.push("ap_landing_throttle_threshold = 100".to_owned());
            "set the threshold to 100".to_owned()
        }
        // An upload resolves it, not an edit, and the way around a zone is the pilot's choice.
        Finding::CraftDiffers { .. }
        | Finding::AgainstZone { .. }
        | Finding::FlownAgainstZone { .. }
        | Finding::Fault(PlanFault::Empty | PlanFault::Corrupt(_))
        | Finding::OutlastsBattery { .. } => return None,
    };
    Some(Fix { title, document: fixed })
}

/// Raises the plan above the ground, and returns the title of the edit.
fn raised(document: &mut PlanDocument, Raise { to_m, waypoint, before }: Raise) -> Option<String> {
    let Some(index) = waypoint else {
        document.settings.retain(|line| !line.starts_with("gps_rescue_return_alt"));
        document.settings.push(format!("gps_rescue_return_alt = {to_m:.0}"));
        return Some(format!("set gps_rescue_return_alt to {to_m:.0} m"));
    };
    let waypoints = &mut document.plan.waypoints;
    let mut raise = |index: usize| {
        let altitude = &mut waypoints.get_mut(index)?.altitude;
        *altitude = Altitude::above_home(altitude.above_home_m().max(to_m));
        Some(())
    };
    raise(index)?;
    match before {
        Before::Nothing => Some(format!("raise WP{index} to {to_m:.0} m")),
        Before::Waypoint(before) => {
            raise(before)?;
            Some(format!("raise WP{before} and WP{index} to {to_m:.0} m"))
        }
        Before::Takeoff => {
            let altitude = Altitude::above_home(to_m);
            let takeoff = Waypoint { kind: WaypointType::Takeoff, altitude, ..Waypoint::default() };
            waypoints.try_insert(0, takeoff).ok()?;
            Some(format!("climb to {to_m:.0} m in a TAKEOFF first"))
        }
    }
}

/// Returns a longitude wrapped to ±180° by whole turns.
fn wrapped(lon_e7: i32) -> i32 {
    let turn = 3_600_000_000_i64;
    let wrapped = (i64::from(lon_e7) + turn / 2).rem_euclid(turn) - turn / 2;
    i32::try_from(wrapped).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::estimate::{Assumptions, TouchdownThrottle};
    use crate::plan::review::review;

    fn wp(kind: WaypointType, n: f64, alt_cm: i32) -> Waypoint {
        let altitude = Altitude::above_home(f64::from(alt_cm) / 100.0);
        let position = GroundPlane::new(home()).to_position(Vector2::new(n, 0.0));
        Waypoint { kind, position, altitude, ..Waypoint::default() }
    }

    fn home() -> LatLon {
        LatLon::from_degrees(40.4635, -79.5182)
    }

    #[test]
    fn every_fix_takes_its_finding_away() {
        use WaypointType::{Delay, Flyover, Land};
        let fast = Waypoint { speed: LegSpeed::from_mps(20.0), ..wp(Flyover, 10.0, 2000) };
        let lost = Waypoint { position: LatLon::new(950_000_000, 0), ..wp(Flyover, 0.0, 2000) };
        let turned = Waypoint { position: LatLon::new(0, 1_900_000_000), ..wp(Flyover, 0.0, 2000) };
        let steep = Waypoint { speed: LegSpeed::from_mps(10.0), ..wp(Flyover, 85.7, 8000) };
        let plans: [&[Waypoint]; 12] = [
            &[wp(Flyover, 300.0, 12_100), wp(Land, 0.0, 12_000)],
            &[wp(Flyover, 100.0, 1100), wp(Flyover, 400.0, 11_000), wp(Land, 0.0, 1000)],
            &[wp(Flyover, 55.7, 1500), steep, wp(Land, 0.0, 1500)],
            &[wp(Flyover, 12.0, 9000), wp(Delay, 0.0, 10), wp(Flyover, 15.0, 2000), wp(Land, 0.0, 2000)],
            &[wp(Flyover, 700.0, 2000), wp(Land, 0.0, 2000)],
            &[wp(Land, 0.0, 2000), wp(Flyover, 50.0, 2000)],
            &[wp(Land, 0.0, 2000), wp(Delay, 0.0, 0)],
            &[fast, wp(Land, 0.0, 2000)],
            &[wp(Flyover, 20.0, -300), wp(Land, 0.0, 2000)],
            &[wp(Flyover, 20.0, 2000)],
            &[lost],
            &[turned],
        ];
        let assumptions = Assumptions { fence_m: Some(500.0), ..Assumptions::default() };
        for waypoints in plans {
            let mut document = PlanDocument::default();
            document.plan.waypoints = waypoints.iter().copied().collect();
            let findings = review(&document.plan, home(), &assumptions);
            assert!(!findings.is_empty(), "{waypoints:?}");
            for finding in findings {
                let fixed =
                    fix(&document, &finding, home()).unwrap_or_else(|| panic!("no fix for {finding}"));
                let left = review(&fixed.document.plan, home(), &assumptions);
                assert!(!left.contains(&finding), "{}: {left:?}", fixed.title);
            }
        }
        let throttle =
            Finding::NoTouchdownThrottle(TouchdownThrottle { threshold_us: 300.0, ..Default::default() });
        let fixed = fix(&PlanDocument::default(), &throttle, home()).unwrap();
        let assumed = Assumptions::from_settings(&fixed.document.settings);
        assert!(!assumed.touchdown_throttle.is_never_met());
    }
}
