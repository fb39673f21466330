//! Tests of plans in GeoJSON.

use super::super::{Format, PlanError, PlanFile, ReadOptions, parse, read, report, write};
use crate::plan::WaypointType;

fn read_with(text: &str, options: &ReadOptions) -> PlanFile {
    read("p.geojson", text.as_bytes(), Format::GeoJson, options)
        .unwrap_or_else(|errors| panic!("{}", report(&errors)))
}

fn faults(text: &str) -> Vec<String> {
    let errors = read("p.geojson", text.as_bytes(), Format::GeoJson, &ReadOptions::default()).unwrap_err();
    errors.iter().map(|error| format!("{} | {}", PlanError::headline(error), error.hint)).collect()
}

fn collection(features: &[String]) -> String {
    format!("{{\"type\":\"FeatureCollection\",\"features\":[{}]}}", features.join(","))
}

fn point(lon: f64, properties: &str) -> String {
    format!(
        "{{\"type\":\"Feature\",\"properties\":{{{properties}}},\"geometry\":{{\"type\":\"Point\",\"coordinates\":[{lon},2,350]}}}}"
    )
}

const LINE: &str = "{\"type\":\"Feature\",\"properties\":{\"name\":\"l\"},\"geometry\":{\"type\":\"LineString\",\
    \"coordinates\":[[1,2],[1,3],[1,4]]}}";

#[test]
fn the_document_has_one_feature_a_line() {
    let text = "name = 'a \"b\"'\nsettings = ['ap_max_distance_from_home = 100']\n[home]\nlat_deg = 40.4635\n\
                lon_deg = -79.5182\nalt_amsl_m = 300\n[[waypoint]]\ntype = 'DELAY'\nduration_s = 5\n[[waypoint]]\n\
                type = 'LAND'\nlat_deg = 40.464\nlon_deg = -79.5175\nalt_m = 20\n";
    let file = parse("p", text, Format::Toml).unwrap();
    let written = write(&file, Format::GeoJson);
    let text = written.text();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(
        lines[..6],
        [
            "{\"type\":\"FeatureCollection\",",
            "\"betadeck\":{\"version\":1,\"name\":\"a \\\"b\\\"\",\"description\":\"\",\"settings\":[\"ap_max_distance_from_home = 100\"]},",
            "\"features\":[",
            "{\"type\":\"Feature\",\"properties\":{\"featureType\":\"home\",\"name\":\"Home\",\"type\":\"HOME\",\"alt_amsl_m\":300},\
             \"geometry\":{\"type\":\"Point\",\"coordinates\":[-79.5182000,40.4635000,300]}},",
            "{\"type\":\"Feature\",\"properties\":{\"featureType\":\"waypoint\",\"sequenceNumber\":0,\"name\":\"WP 0 DELAY\",\
             \"altitudeRelative\":0,\"type\":\"DELAY\",\"duration_s\":5},\"geometry\":null},",
            "{\"type\":\"Feature\",\"properties\":{\"featureType\":\"waypoint\",\"sequenceNumber\":1,\"name\":\"WP 1 LAND\",\
             \"altitudeRelative\":20,\"altitudeAMSL\":320,\"type\":\"LAND\",\"alt_m\":20},\
             \"geometry\":{\"type\":\"Point\",\"coordinates\":[-79.5175000,40.4640000,320]}},",
        ]
    );
    assert!(written.losses.is_lossless());
}

#[test]
fn points_come_in_the_order_of_their_numbers() {
    let mark = |number: u32| {
        format!("\"featureType\":\"waypoint\",\"altitudeRelative\":30,\"sequenceNumber\":{number}")
    };
    let text = collection(&[
        LINE.to_owned(),
        point(5.0, "\"name\":\"no waypoint\""),
        point(2.0, &mark(2)),
        point(1.0, &format!("{},\"command\":22", mark(1))),
        point(3.0, &format!("{},\"command\":31", mark(3))),
    ]);
    let file = read_with(&text, &ReadOptions::default());
    let found: Vec<(i32, WaypointType, i32)> = file
        .plan
        .waypoints
        .iter()
        .map(|waypoint| (waypoint.position.lon_e7 / 10_000_000, waypoint.kind, waypoint.altitude.cm()))
        .collect();
    assert_eq!(
        found,
        [(1, WaypointType::Takeoff, 3000), (2, WaypointType::Flyby, 3000), (3, WaypointType::Flyby, 3000)]
    );
    assert!(file.losses.findings.iter().any(|finding| {
        finding.to_string().starts_with("lost     item 5, /features/4 command: command 31 → FLYBY")
    }));
}

#[test]
fn all_points_count_if_none_is_marked_else_a_line() {
    let options = ReadOptions { home: Some("1,2,300".parse().unwrap()), ..ReadOptions::default() };
    let both = collection(&[LINE.to_owned(), point(1.0, ""), point(2.0, "")]);
    let file = read_with(&both, &options);
    assert_eq!((file.plan.waypoints.len(), file.plan.waypoints[0].altitude.cm()), (2, 5000));
    assert_eq!(file.losses.counts(), "2 assumed, 1 info");
    let line = ReadOptions { feature: Some("l".to_owned()), ..options.clone() };
    assert_eq!(read_with(&both, &line).plan.waypoints.len(), 3);
    assert_eq!(read_with(&collection(&[LINE.to_owned()]), &options).plan.waypoints.len(), 3);
    let two = faults(&collection(&[LINE.to_owned(), LINE.to_owned()]));
    assert!(two[0].contains("the file has 2 lines | choose with --feature: 1 \"l\" (3 points)"), "{two:?}");
    let needs = faults(&collection(&[point(1.0, ""), point(2.0, "")]));
    assert_eq!(needs.len(), 1);
    assert!(needs[0].contains("/features/0: altitude 350 m is above sea level"), "{needs:?}");
    assert!(faults(&collection(&[]))[0].contains("no line and no points"));
}

#[test]
fn wrong_values_have_their_pointer() {
    let text = collection(&[point(
        1.0,
        "\"featureType\":\"waypoint\",\"type\":\"HOLD\",\"alt_m\":5,\"duration_s\":-1",
    )]);
    assert_eq!(
        faults(&text),
        ["p.geojson:1:1: /features/0: duration_s -1 is out of range | allowed: 0 to 6553.5 s"]
    );
    let text = collection(&[point(1.0, "\"featureType\":\"waypoint\",\"altitudeRelative\":99999")]);
    assert!(faults(&text)[0].contains("/features/0: altitude 99999 is out of range"));
    let other = "{\"type\":\"FeatureCollection\",\"betadeck\":{\"version\":2},\"features\":[]}";
    assert!(!faults(other).is_empty());
}

#[test]
fn properties_of_a_converted_kml_are_read() {
    let text = collection(&[point(
        1.0,
        "\"Name\":\"WP 0 HOLD\",\"altitudeMode\":\"relativeToGround\",\"type\":\"HOLD\",\"alt_m\":\"350\",\"duration_s\":\"5\"",
    )]);
    let file = read_with(&text, &ReadOptions::default());
    let hold = file.plan.waypoints[0];
    assert_eq!((hold.kind, hold.altitude.cm(), hold.duration.ds()), (WaypointType::Hold, 35_000, 50));
    assert_eq!(file.losses.counts(), "1 assumed");
    let changed = text.replace("\"350\"", "\"50\",\"altitudeRelative\":60");
    let file = read_with(&changed, &ReadOptions::default());
    assert_eq!(file.plan.waypoints[0].altitude.cm(), 6000);
    assert_eq!(file.losses.counts(), "2 assumed");
}

#[test]
fn a_mavlink_landing_has_the_altitude_before() {
    let command = |number: u32, altitude_m: i32| {
        format!("\"featureType\":\"waypoint\",\"command\":{number},\"altitudeRelative\":{altitude_m}")
    };
    let text = collection(&[point(1.0, &command(22, 20)), point(2.0, &command(21, 0))]);
    let file = read_with(&text, &ReadOptions::default());
    let land = file.plan.waypoints[1];
    assert_eq!((land.kind, land.altitude.cm()), (WaypointType::Land, 2000));
    let lines: Vec<String> = file.losses.findings.iter().map(ToString::to_string).collect();
    let expected = "changed  WP 1 (item 2, /features/1) altitude: 0 m → 20 m: the altitude of a MAVLink LAND is that \
                    of the ground";
    assert_eq!(lines, [expected]);
}
