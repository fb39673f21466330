//! The true values of a flight, as sentences.

use crate::plan::WaypointType;
use crate::signals::SimTime;
use crate::telemetry::{FlightTruth, PlanSource, WaypointTruth};

/// Returns a line for each flown waypoint, with the time of its measurement, and a line for the parked craft at the
/// end.
pub fn lines(end: SimTime, truth: &FlightTruth) -> Vec<String> {
    let mut lines: Vec<String> =
        truth.waypoints.iter().map(|waypoint| line(waypoint.at, &sentence(waypoint))).collect();
    if let Some(parked) = truth.parked {
        let place = parked
            .distance_m
            .map_or_else(String::new, |distance| format!("{distance:.2} m from its place, "));
        let height = too(parked.alt_error_m);
        lines.push(line(end, &format!("parked {place}{height}, moving at {:.2} m/s", parked.speed_mps)));
    }
    if let Some(used) = truth.battery_used_pct {
        lines.push(line(end, &format!("{used:.1} % of the battery used")));
    }
    lines
}

fn line(time: SimTime, sentence: &str) -> String {
    format!("{:>7.1} s  Truth: {sentence}.", time.as_secs_f64())
}

fn sentence(waypoint: &WaypointTruth) -> String {
    let WaypointTruth { source, wp, kind, miss_m, alt_error_m, .. } = *waypoint;
    let of = match source {
        PlanSource::Stored => "",
        PlanSource::Rth => " of the return home",
        PlanSource::Emergency => " of the emergency landing",
    };
    let done = match kind {
        WaypointType::Hold => format!("held within {miss_m:.2} m"),
        WaypointType::Land => format!("touched down {miss_m:.2} m from it"),
        WaypointType::Takeoff => format!("climbed within {miss_m:.2} m"),
        WaypointType::Flyby if waypoint.radius_m <= 0.0 && miss_m <= 0.0 => {
            "turned inside its turn radius".to_owned()
        }
        WaypointType::Flyby if waypoint.radius_m <= 0.0 => {
            format!("turned {miss_m:.2} m outside its turn radius")
        }
        _ => format!("passed {miss_m:.2} m from it"),
    };
    let height = alt_error_m.map_or_else(String::new, |error_m| format!(", {}", too(error_m)));
    format!("waypoint {wp} ({kind}){of} {done}{height}")
}

/// Returns `0.30 m too low`.
fn too(error_m: f64) -> String {
    format!("{:.2} m too {}", error_m.abs(), if error_m < 0.0 { "low" } else { "high" })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::telemetry::ParkedTruth;

    #[test]
    fn truth_is_reported_in_sentences() {
        let flown = |wp, kind, miss_m, alt_error_m| WaypointTruth {
            source: PlanSource::Stored,
            wp,
            kind,
            miss_m,
            alt_error_m,
            hold_max_m: None,
            radius_m: 0.0,
            at: SimTime::from_secs_f64(12.3),
        };
        let parked = ParkedTruth {
            wp: 2,
            kind: WaypointType::Hold,
            distance_m: Some(0.4),
            alt_error_m: 0.1,
            speed_mps: 0.05,
            radius_m: 2.0,
        };
        let home = WaypointTruth { source: PlanSource::Rth, ..flown(1, WaypointType::Land, 0.9, None) };
        let truth = FlightTruth {
            waypoints: vec![
                flown(0, WaypointType::Flyover, 0.83, Some(-0.3)),
                flown(1, WaypointType::Flyby, 0.0, Some(0.2)),
                flown(2, WaypointType::Hold, 1.0, Some(0.2)),
                home,
            ],
            parked: Some(parked),
            battery_used_pct: Some(4.23),
        };
        assert_eq!(
            lines(SimTime::from_secs_f64(99.0), &truth),
            [
                "   12.3 s  Truth: waypoint 0 (FLYOVER) passed 0.83 m from it, 0.30 m too low.",
                "   12.3 s  Truth: waypoint 1 (FLYBY) turned inside its turn radius, 0.20 m too high.",
                "   12.3 s  Truth: waypoint 2 (HOLD) held within 1.00 m, 0.20 m too high.",
                "   12.3 s  Truth: waypoint 1 (LAND) of the return home touched down 0.90 m from it.",
                "   99.0 s  Truth: parked 0.40 m from its place, 0.10 m too high, moving at 0.05 m/s.",
                "   99.0 s  Truth: 4.2 % of the battery used.",
            ]
        );
    }
}
