//! Files in the manner of QGroundControl, Mission Planner and MAVProxy. They were made by hand.

use std::path::Path;

use betadeck::plan::WaypointType;
use betadeck::plan::WaypointType::{Flyby, Flyover, Hold, Land, Takeoff};
use betadeck::plan::format::{Format, PlanFile, ReadOptions, qgc_fences, read, report, write};

/// Reads a file, writes it again in both formats and reads that.
fn import(name: &str, format: Format) -> (PlanFile, Vec<String>) {
    let path = Path::new("tests/exchange/qgc").join(name);
    let contents = std::fs::read(&path).unwrap_or_else(|error| panic!("{name}: {error}"));
    let (found, finding) = Format::detect(name, &contents);
    assert_eq!((found, finding), (format, None), "{name}");
    let file = read(name, &contents, found, &ReadOptions::default())
        .unwrap_or_else(|errors| panic!("{}", report(&errors)));
    for format in [Format::QgcPlan, Format::QgcWpl] {
        let written = write(&file, format);
        let back = read("back", &written.contents, format, &ReadOptions::default())
            .unwrap_or_else(|errors| panic!("{}", report(&errors)));
        let lost = written.losses.findings.iter().any(|finding| finding.waypoint.is_some());
        assert!(lost || back.plan == file.plan, "{name} as {format}: {:?}", written.losses);
    }
    let findings = file.losses.findings.iter().map(ToString::to_string).collect();
    (file, findings)
}

fn kinds(file: &PlanFile) -> Vec<WaypointType> {
    file.plan.waypoints.iter().map(|waypoint| waypoint.kind).collect()
}

/// Checks the beginnings of the findings.
#[track_caller]
fn check(findings: &[String], expected: &[&str]) {
    let begin = findings.iter().zip(expected).all(|(found, expected)| found.starts_with(expected));
    assert!(begin && findings.len() == expected.len(), "{findings:#?}");
}

#[test]
fn a_survey_of_qgroundcontrol() {
    let (file, findings) = import("qgroundcontrol-survey.plan", Format::QgcPlan);
    assert_eq!(kinds(&file), [Takeoff, Flyby, Flyby, Flyby, Flyby, Flyby, Hold, Flyover, Land]);
    assert_eq!(file.settings, ["ap_max_distance_from_home = 250"]);
    check(
        &findings,
        &[
            "changed  item 4, /mission/items/3 survey: survey of 5 items → 5 items",
            "changed  fence: 250.5 m → 250 m",
            "changed  WP 7 (item 11, /mission/items/6) return: 1 item → 2 waypoints",
            "assumed  waypoint type: 5 items → FLYBY",
            "info     camera (command 206): 1 item",
            "info     camera (command 530): 1 item",
            "lost     fence polygon 0: stay outside",
            "lost     rally points: 1 point",
        ],
    );
    let contents = std::fs::read_to_string("tests/exchange/qgc/qgroundcontrol-survey.plan").unwrap();
    assert_eq!(qgc_fences(&contents).len(), 1);
}

#[test]
fn an_old_plan_of_qgroundcontrol() {
    let (file, findings) = import("qgroundcontrol-old.plan", Format::QgcPlan);
    assert_eq!(kinds(&file), [Takeoff, Flyby, Flyby, Hold]);
    assert_eq!(file.home.unwrap().to_string(), "47.3977419,8.5455938");
    check(
        &findings,
        &[
            "info     WP 0 (item 1, /mission/items/0) pitch: 15 deg",
            "lost     WP 2 (item 3, /mission/items/2) spline: curve → straight",
            "changed  WP 3 (item 4, /mission/items/3) radius: 15 m → 10 m",
            "lost     WP 3 (item 4, /mission/items/3) direction",
            "assumed  waypoint type: 2 items → FLYBY",
        ],
    );
}

#[test]
fn a_plan_of_qgroundcontrol_above_terrain() {
    let (file, _) = import("qgroundcontrol-terrain.plan", Format::QgcPlan);
    let altitudes: Vec<f64> =
        file.plan.waypoints.iter().map(|waypoint| waypoint.altitude.above_home_m()).collect();
    assert_eq!(altitudes, [24.0, 25.25, 25.25]);
}

#[test]
fn a_mission_of_mission_planner() {
    let (file, findings) = import("mission-planner.waypoints", Format::QgcWpl);
    assert_eq!(kinds(&file), [Takeoff, Hold, Hold, Hold, Hold, Hold, Hold, Flyover, Takeoff, Flyover, Land]);
    check(
        &findings,
        &[
            "changed  item 6, line 8 jump: to item 2, 1 time → unrolled",
            "changed  WP 2 (item 4, line 6) radius: 8 m → 10 m",
            "assumed  WP 3 (item 5, line 7) position: 47.3983000,8.5462000, 30 m",
            "changed  WP 3 (item 5, line 7) radius",
            "changed  WP 5 (item 4, line 6) radius",
            "assumed  WP 6 (item 5, line 7) position",
            "changed  WP 6 (item 5, line 7) radius",
            "changed  WP 7 (item 9, line 11) loiter to altitude",
            "changed  WP 9 (item 10, line 12) return",
            "lost     nose direction (command 115): 1 item",
            "lost     servo or relay (command 183): 1 item",
            "lost     nose direction (command 201): 2 items",
        ],
    );
}

#[test]
fn a_mission_of_mavproxy() {
    let (file, findings) = import("mavproxy.txt", Format::QgcWpl);
    assert_eq!(kinds(&file), [Takeoff, Flyby, Hold, Flyby, Land]);
    check(
        &findings,
        &[
            "assumed  WP 2 (item 3, line 6) delay: 20 s → HOLD",
            "assumed  WP 3 (item 4, line 7) altitude reference: above ground → above home",
            "changed  WP 4 (item 5, line 9) altitude: 0 m → 20 m",
            "assumed  waypoint type: 2 items → FLYBY",
        ],
    );
}

#[test]
fn a_table_of_qgroundcontrol() {
    let (file, findings) = import("qgroundcontrol.csv", Format::QgcCsv);
    assert_eq!(kinds(&file), [Takeoff, Flyby, Hold, Land]);
    check(
        &findings,
        &[
            "info     WP 0 (item 1, line 3) altitude reference: 503.07 m above sea level → 15 m above home",
            "info     WP 1 (item 2, line 4) altitude reference: 518.07 m above sea level → 30 m above home",
            "info     WP 2 (item 4, line 6) altitude reference: 518.07 m above sea level → 30 m above home",
            "changed  WP 3 (item 5, line 7) altitude: 488.07 m → 30 m",
            "assumed  waypoint type: 1 item → FLYBY",
        ],
    );
}

#[test]
fn a_fence_is_no_plan() {
    let contents = std::fs::read("tests/exchange/qgc/fence.waypoints").unwrap();
    let errors = read("fence.waypoints", &contents, Format::QgcWpl, &ReadOptions::default()).unwrap_err();
    assert_eq!(errors[0].headline(), "fence.waypoints:3:1: this is a fence, not a plan");
}
