//! Tests of the clearance over tiles in memory.

use std::sync::Arc;

use nalgebra::Vector2;

use super::*;
use crate::plan::edit::PlanDocument;
use crate::plan::edit::fix::fix;
use crate::plan::{Altitude, LegSpeed, Seconds, WaypointType};
use crate::terrain::{Grid, Samples, Square, Tiles};

const HOME: LatLon = LatLon::new(405_000_000, -795_000_000);
/// Rows and columns of the grid.
const SIDE: usize = 1201;

/// Returns ground at 300 m above sea level, with a ridge of `ridge_m` 500 m to 700 m north of home.
fn relief(ridge_m: i16) -> Relief {
    let mut metres = vec![300_i16; SIDE * SIDE];
    // Rows of 92.8 m; home is in row 600.
    for row in 593..=594 {
        metres[row * SIDE..(row + 1) * SIDE].fill(300 + ridge_m);
    }
    let step_deg = 1.0 / 1200.0;
    let grid = Grid {
        rows: SIDE,
        cols: SIDE,
        north_deg: 41.0,
        west_deg: -80.0,
        lat_step_deg: step_deg,
        lon_step_deg: step_deg,
        samples: Samples::Metres(metres),
    };
    let mut tiles = Tiles::default();
    tiles.insert(Square::of(HOME), grid);
    Relief::new(Arc::new(tiles), HOME).unwrap()
}

fn wp(kind: WaypointType, north_m: f64, alt_m: f64) -> Waypoint {
    let position = offset_to_latlon(HOME, Vector2::new(north_m, 0.0));
    let altitude = Altitude::above_home(alt_m);
    Waypoint { kind, position, altitude, duration: Seconds::new(20.0), ..Waypoint::default() }
}

fn document(waypoints: &[Waypoint]) -> PlanDocument {
    let mut document = PlanDocument::default();
    document.plan.waypoints.extend(waypoints.iter().copied());
    document
}

fn found(document: &PlanDocument, relief: &Relief) -> Clearances {
    let assumptions = Assumptions::from_settings(&document.settings);
    clearances(&document.plan, &assumptions, relief, CLEARANCE_M)
}

use WaypointType::{Flyover, Hold, Land};

#[test]
fn a_leg_over_a_ridge_and_the_way_home_behind_it_are_reported() {
    let document = document(&[wp(Flyover, 1000.0, 40.0), wp(Land, 1100.0, 40.0)]);
    let found = found(&document, &relief(60));
    let text: Vec<String> = found.findings.iter().map(ToString::to_string).collect();
    assert_eq!(text.len(), 2, "{text:?}");
    assert!(text[0].starts_with("the leg to waypoint 0 goes 20 m into the ground 5"), "{}", text[0]);
    assert!(text[0].ends_with(",-79.5000000; the clearance (--clearance) is 15 m"), "{}", text[0]);
    assert!(text[1].starts_with("the way home from waypoint 0 goes 10 m into the ground"), "{}", text[1]);
    let (clearance_m, index, along_m) = found.lowest.unwrap();
    assert!((clearance_m + 20.0).abs() < 0.5 && index == 0 && (530.0..660.0).contains(&along_m));
    assert!(found.unknown.is_empty());
}

#[test]
fn a_plan_that_is_high_enough_or_over_level_ground_has_no_findings() {
    let high = document(&[wp(Flyover, 400.0, 80.0), wp(Flyover, 1000.0, 80.0), wp(Land, 1100.0, 80.0)]);
    assert_eq!(found(&high, &relief(60)).findings, []);
    let level = document(&[wp(Flyover, 1000.0, 20.0), wp(Land, 1100.0, 20.0)]);
    assert_eq!(found(&level, &relief(0)).findings, [], "the climb at home is none");
    assert_eq!(
        found(&document(&[wp(Land, 50.0, 10.0)]), &relief(0)).findings.len(),
        1,
        "10 m are less than 15 m"
    );
}

#[test]
fn ground_is_compared_with_that_at_home_not_with_sea_level() {
    // 300 m above sea level everywhere: nothing is in the way at 20 m above home.
    let document = document(&[wp(Hold, 300.0, 20.0), wp(Land, 0.0, 20.0)]);
    let found = found(&document, &relief(0));
    assert!((found.lowest.unwrap().0 - 10.0).abs() < 0.01, "the start, 10 m above home: {found:?}");
    assert!(found.findings.is_empty());
}

#[test]
fn the_edits_raise_the_plan_until_it_is_clear() {
    let fast = Waypoint { speed: LegSpeed::from_mps(15.0), ..wp(Flyover, 620.0, 200.0) };
    let plans: [&[Waypoint]; 5] = [
        &[wp(Flyover, 1000.0, 40.0), wp(Land, 1100.0, 40.0)],
        &[wp(Flyover, 100.0, 20.0), wp(Flyover, 620.0, 40.0), wp(Land, 1100.0, 40.0)],
        &[wp(Flyover, 500.0, 20.0), fast, wp(Land, 1100.0, 90.0)],
        &[wp(Flyover, 560.0, 90.0), wp(Land, 1100.0, 90.0)],
        &[wp(Flyover, 300.0, 90.0), wp(Hold, 600.0, 60.0), wp(Land, 0.0, 90.0)],
    ];
    let relief = relief(60);
    for waypoints in plans {
        let mut document = document(waypoints);
        for round in 0.. {
            let Clearances { findings, .. } = found(&document, &relief);
            let Some(finding) = findings.first() else { break };
            assert!(round < 6, "still {finding} after {round} edits: {:?}", document.plan);
            let fixed = fix(&document, finding, HOME).unwrap_or_else(|| panic!("no edit for {finding}"));
            assert_ne!(fixed.document, document, "{}", fixed.title);
            document = fixed.document;
        }
    }
}

#[test]
fn a_fixed_return_altitude_is_raised_by_its_setting() {
    let mut document = document(&[wp(Flyover, 1000.0, 80.0), wp(Land, 1100.0, 80.0)]);
    document.settings =
        vec!["gps_rescue_alt_mode = FIXED_ALT".to_owned(), "gps_rescue_return_alt = 50".to_owned()];
    let relief = relief(60);
    let Clearances { findings, .. } = found(&document, &relief);
    assert_eq!(findings.len(), 1, "{findings:?}");
    let fixed = fix(&document, &findings[0], HOME).unwrap();
    assert_eq!(fixed.title, "set gps_rescue_return_alt to 75 m");
    assert_eq!(fixed.document.settings.last().unwrap(), "gps_rescue_return_alt = 75");
    assert!(found(&fixed.document, &relief).findings.is_empty());
}

#[test]
fn unknown_ground_is_no_ground_at_zero() {
    let far = LatLon::new(415_000_000, -795_000_000);
    let mut document = document(&[wp(Flyover, 100.0, 30.0)]);
    document.plan.waypoints.push(Waypoint { position: far, ..wp(Land, 0.0, 30.0) });
    let found = found(&document, &relief(0));
    assert_eq!(found.unknown, [1]);
    assert!(found.findings.is_empty(), "{found:?}");
}

#[test]
fn a_flight_lower_than_the_plan_is_reported_once() {
    let document = document(&[wp(Flyover, 400.0, 80.0), wp(Flyover, 1000.0, 80.0), wp(Land, 1100.0, 80.0)]);
    let relief = relief(60);
    let assumptions = Assumptions::default();
    let path = (0..=1100).step_by(10).map(|metres| {
        let north_m = f64::from(metres);
        let place = offset_to_latlon(HOME, Vector2::new(north_m, 0.0));
        FlownPlace { place, along_m: north_m, alt_m: if north_m < 1099.0 { 70.0 } else { 0.0 } }
    });
    let low = |known: &[Finding]| {
        low_in_flight(&document.plan, &assumptions, &relief, CLEARANCE_M, path.clone(), known)
    };
    let findings = low(&[]);
    assert_eq!(findings.len(), 1, "{findings:?}");
    let Finding::LowClearance(found) = findings[0] else { panic!("{findings:?}") };
    assert!(
        (found.clearance_m - 10.0).abs() < 0.5 && found.index == 1 && found.raise.to_m >= 85.0,
        "{found:?}"
    );
    assert!(findings[0].to_string().contains("as flown in the estimate"));
    let planned = Finding::LowClearance(LowClearance { way: Way::Leg, ..found });
    assert!(low(&[planned]).is_empty());
}
