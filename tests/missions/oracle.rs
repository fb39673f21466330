//! Whether the true path of a craft was a flight of its plan, found without the judge of the program.

use betadeck::geo::LatLon;
use betadeck::plan::estimate::Assumptions;
use betadeck::plan::{FlightPlan, HoldPattern, Waypoint, WaypointType};
use nalgebra::Vector2;

use crate::mission::{Instant, Outcome};

/// What is allowed beyond a waypoint's own radius, m.
const TOLERANCE_M: f64 = 10.0;
/// What the two ways of measuring may differ by, m.
const MEASURE_M: f64 = 0.5;
/// Instants of the path in a second.
const INSTANTS_PER_S: f64 = 50.0;

/// Why the path of a flight that is called complete is no flight of the plan.
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
            let level = (instant.alt_m - f64::from(waypoint.alt_cm) / 100.0).abs() <= TOLERANCE_M + MEASURE_M;
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
                let asked_s = f64::from(waypoint.duration_ds) / 10.0;
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

/// How far a pattern leads from its waypoint, m.
fn pattern_m(waypoint: &Waypoint, assumptions: &Assumptions) -> f64 {
    match waypoint.pattern {
        HoldPattern::None => 0.0,
        HoldPattern::Orbit => assumptions.orbit_radius_m,
        // Its width is left at the default: 20 m to either side.
        HoldPattern::Figure8 => 20.0,
    }
}

/// The longest time without interruption in which a condition holds, s.
fn longest(path: &[Instant], holds: impl Fn(&Instant) -> bool) -> f64 {
    let runs = path.split(|instant| !holds(instant)).map(<[Instant]>::len);
    runs.max().unwrap_or(0) as f64 / INSTANTS_PER_S
}
