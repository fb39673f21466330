//! Compares the truth with a mission that is complete for the firmware.

use crate::math;
use crate::plan::WaypointType;
use crate::telemetry::{FlightTruth, ParkedTruth, PlanSource, WaypointTruth};

/// A miss beyond the permitted distance.
struct Miss {
    /// Distance beyond the limit, m.
    excess_m: f64,
    sentence: String,
}

/// Returns the worst miss of the stored plan, as half a sentence. `None` if all waypoints are within their own radius
/// and the tolerance, vertically within the tolerance.
pub(super) fn worst_miss(truth: &FlightTruth, tolerance_m: f64) -> Option<String> {
    let stored = truth.waypoints.iter().filter(|waypoint| waypoint.source == PlanSource::Stored);
    stored
        .flat_map(|waypoint| waypoint_misses(waypoint, tolerance_m))
        .chain(truth.parked.iter().flat_map(|parked| parked_misses(parked, tolerance_m)))
        .flatten()
        .max_by(|a, b| a.excess_m.total_cmp(&b.excess_m))
        .map(|miss| miss.sentence)
}

/// Returns the text for a mission that agrees with the truth: the present place of the craft.
pub(super) fn agreement(truth: &FlightTruth) -> Option<String> {
    if let Some(ParkedTruth { distance_m: Some(distance_m), .. }) = truth.parked {
        return Some(format!("mission complete, parked {distance_m:.1} m from its place"));
    }
    let last = truth.waypoints.last().filter(|last| last.kind == WaypointType::Land)?;
    Some(format!("mission complete, landed {:.1} m from its place and disarmed", last.miss_m))
}

fn waypoint_misses(waypoint: &WaypointTruth, tolerance_m: f64) -> [Option<Miss>; 3] {
    let WaypointTruth { wp, kind, miss_m, alt_error_m, hold_max_m, radius_m, .. } = *waypoint;
    let name = format!("waypoint {wp} ({kind})");
    let reported = |miss: &str| match kind {
        WaypointType::Land => format!("the craft touched down {miss} from {name}"),
        WaypointType::Hold => format!("{name} was not held, the craft was up to {miss} off"),
        WaypointType::Takeoff => format!("the craft was {miss} off in {name}"),
        WaypointType::Flyby if radius_m <= 0.0 => {
            format!("{name} was missed, the craft turned {miss} outside its turn radius")
        }
        _ => format!("{name} was missed, the craft passed {miss} from it"),
    };
    let waited = hold_max_m.filter(|_| kind == WaypointType::Land).and_then(|waited_m| {
        miss(waited_m, radius_m + tolerance_m, |waited| {
            format!("the craft was up to {waited} off while it waited at {name}")
        })
    });
    let vertical = alt_error_m.and_then(|error_m| {
        let too = too(error_m);
        miss(error_m.abs(), tolerance_m, |error| match kind {
            WaypointType::Hold => format!("{name} was not held, the craft was up to {error} {too}"),
            _ => format!("{name} was missed, the craft passed {error} {too}"),
        })
    });
    [miss(miss_m, radius_m + tolerance_m, reported), waited, vertical]
}

fn parked_misses(parked: &ParkedTruth, tolerance_m: f64) -> [Option<Miss>; 2] {
    let ParkedTruth { wp, kind, distance_m, alt_error_m, speed_mps, radius_m } = *parked;
    let name = format!("the craft parked at waypoint {wp} ({kind})");
    let away = distance_m.and_then(|distance_m| {
        miss(distance_m, radius_m + tolerance_m, |distance| {
            format!("{name} was {distance} off at the end, moving at {speed_mps:.1} m/s")
        })
    });
    let vertical = miss(alt_error_m.abs(), tolerance_m, |error| {
        format!("{name} was {error} {} at the end", too(alt_error_m))
    });
    [away, vertical]
}

/// Returns a miss if a value is more than allowed. `reported` puts the value into a sentence.
fn miss(value_m: f64, allowed_m: f64, reported: impl FnOnce(&str) -> String) -> Option<Miss> {
    let excess_m = value_m - allowed_m;
    (excess_m > 0.0).then(|| {
        let decimals = math::decimals_apart(value_m, allowed_m, 1);
        let reported = reported(&format!("{value_m:.decimals$} m"));
        Miss { excess_m, sentence: format!("{reported}; {allowed_m:.decimals$} m are allowed") }
    })
}

fn too(error_m: f64) -> &'static str {
    if error_m < 0.0 { "too low" } else { "too high" }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signals::SimTime;

    fn flown(kind: WaypointType, miss_m: f64, alt_error_m: Option<f64>) -> WaypointTruth {
        WaypointTruth {
            source: PlanSource::Stored,
            wp: 2,
            kind,
            miss_m,
            alt_error_m,
            hold_max_m: None,
            radius_m: 5.0,
            at: SimTime::ZERO,
        }
    }

    fn worst(waypoints: &[WaypointTruth]) -> Option<String> {
        let truth = FlightTruth { waypoints: waypoints.to_vec(), ..FlightTruth::default() };
        worst_miss(&truth, 10.0)
    }

    #[test]
    fn the_radius_and_the_tolerance_are_allowed() {
        assert_eq!(worst(&[flown(WaypointType::Flyover, 14.9, Some(-9.9))]), None);
        let beside = worst(&[flown(WaypointType::Flyover, 15.2, Some(0.0))]);
        assert_eq!(
            beside.as_deref(),
            Some("waypoint 2 (FLYOVER) was missed, the craft passed 15.2 m from it; 15.0 m are allowed")
        );
        for (miss_m, shown) in [
            (15.05, "15.1 m from it; 15.0 m are allowed"),
            (15.000_4, "15.0004 m from it; 15.0000 m are allowed"),
            (15.000_000_1, "15.0000001 m from it; 15.0000000 m are allowed"),
        ] {
            let close = worst(&[flown(WaypointType::Flyover, miss_m, Some(0.0))]).unwrap();
            assert!(close.ends_with(shown), "{close}");
        }
        let below = worst(&[flown(WaypointType::Hold, 0.0, Some(-19.7))]);
        assert_eq!(
            below.as_deref(),
            Some("waypoint 2 (HOLD) was not held, the craft was up to 19.7 m too low; 10.0 m are allowed")
        );
    }

    #[test]
    fn the_worst_one_is_named() {
        let far = flown(WaypointType::Land, 819.2, None);
        let reported = worst(&[flown(WaypointType::Flyover, 16.0, None), far]).unwrap();
        assert_eq!(reported, "the craft touched down 819.2 m from waypoint 2 (LAND); 15.0 m are allowed");
        let injected = WaypointTruth { source: PlanSource::Rth, ..far };
        assert_eq!(worst(&[injected]), None, "a plan of the firmware is not the user's");
    }

    #[test]
    fn a_parked_craft_is_looked_at() {
        let parked = ParkedTruth {
            wp: 0,
            kind: WaypointType::Hold,
            distance_m: Some(174.0),
            alt_error_m: 0.1,
            speed_mps: 7.0,
            radius_m: 2.0,
        };
        let truth = FlightTruth { parked: Some(parked), ..FlightTruth::default() };
        assert_eq!(
            worst_miss(&truth, 10.0).as_deref(),
            Some(
                "the craft parked at waypoint 0 (HOLD) was 174.0 m off at the end, moving at 7.0 m/s; 12.0 m are \
                 allowed"
            )
        );
        assert_eq!(worst_miss(&truth, 200.0), None);
    }

    #[test]
    fn a_parked_craft_is_too_low_only_beyond_the_tolerance() {
        let parked = |alt_error_m| {
            let parked = ParkedTruth {
                wp: 0,
                kind: WaypointType::Hold,
                distance_m: Some(0.0),
                alt_error_m,
                speed_mps: 0.0,
                radius_m: 2.0,
            };
            worst_miss(&FlightTruth { parked: Some(parked), ..FlightTruth::default() }, 10.0)
        };
        assert_eq!((parked(-9.6), parked(9.6)), (None, None), "within the tolerance");
        assert_eq!(
            parked(-10.4).as_deref(),
            Some("the craft parked at waypoint 0 (HOLD) was 10.4 m too low at the end; 10.0 m are allowed")
        );
    }
}
