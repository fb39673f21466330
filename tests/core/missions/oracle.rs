//! An independent check of a craft's true path against its plan, without the program's own judge.

use betadeck_core::geo::LatLon;
use betadeck_core::plan::estimate::Assumptions;
use betadeck_core::plan::{FlightPlan, HoldPattern, Waypoint, WaypointType};
use nalgebra::Vector2;

use crate::missions::mission::{Instant, Outcome};

/// The tolerance beyond a waypoint's own radius, m.
const TOLERANCE_M: f64 = 10.0;
/// The allowed difference between the two ways of measuring, m.
const MEASURE_M: f64 = 0.5;
/// Instants of the path per second.
const INSTANTS_PER_S: f64 = 50.0;

/// Returns the reason why the true path is not a flight of the plan, or `None` if it is. Used for `complete` flights.
pub(crate) fn denies(plan: &FlightPlan, settings: &[String], outcome: &Outcome) -> Option<String> {
    let assumptions = Assumptions::from_settings(settings);
    let last = outcome.path.last()?;
    let place = |position: LatLon| {
        let enu = outcome.frame.to_enu(position.lat_deg(), position.lon_deg(), outcome.frame.alt_amsl_m);
        Vector2::new(enu.y, enu.x)
    };
    for (index, waypoint) in plan.waypoints.iter().enumerate().filter(|(_, wp)| wp.kind.uses_position()) {
        let at = place(waypoint.position);
        let near = |instant: &Instant, radius_m: f64| {
            let level = (instant.alt_m - waypoint.altitude.above_home_m()).abs() <= TOLERANCE_M + MEASURE_M;
            level && (instant.ne - at).norm() <= radius_m + TOLERANCE_M + MEASURE_M
        };
        let reason = match waypoint.kind {
            WaypointType::Land => {
                let away_m = (last.ne - at).norm();
                (away_m > assumptions.hold_radius_m + TOLERANCE_M + MEASURE_M)
                    .then(|| format!("it stands {away_m:.1} m from the LAND"))
            }
            WaypointType::Hold => {
                let radius_m = assumptions.hold_radius_m + pattern_m(waypoint, &assumptions);
                let held_s = longest(&outcome.path, |instant| near(instant, radius_m));
                let asked_s = waypoint.duration.get();
                (held_s < asked_s - 1.0).then(|| format!("held for {held_s:.1} s of {asked_s:.1} s"))
            }
            _ => {
                let speed_mps = assumptions.max_velocity_mps;
                let turn_m = speed_mps.powi(2) / (9.8 * assumptions.max_angle_deg.to_radians().tan());
                let radius_m = match waypoint.kind {
                    WaypointType::Flyby => assumptions.arrival_radius_m.max(1.5 * turn_m),
                    _ => assumptions.arrival_radius_m,
                };
                let passed = outcome.path.iter().any(|instant| near(instant, radius_m));
                (!passed).then(|| "never passed at its height".to_owned())
            }
        };
        if let Some(reason) = reason {
            return Some(format!("waypoint {index} ({}): {reason}", waypoint.kind));
        }
    }
    None
}

/// Returns the greatest distance of a hold pattern from its waypoint, m.
fn pattern_m(waypoint: &Waypoint, assumptions: &Assumptions) -> f64 {
    match waypoint.pattern {
        HoldPattern::None => 0.0,
        HoldPattern::Orbit => assumptions.orbit_radius_m,
        // The missions keep the default width: 20 m to either side.
        HoldPattern::Figure8 => 20.0,
    }
}

/// Returns the longest uninterrupted time for which a condition holds, s.
fn longest(path: &[Instant], holds: impl Fn(&Instant) -> bool) -> f64 {
    let runs = path.split(|instant| !holds(instant)).map(<[Instant]>::len);
    runs.max().unwrap_or(0) as f64 / INSTANTS_PER_S
}
