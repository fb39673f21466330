use proptest::prelude::*;

use super::super::law::{file, plan_file};
use super::*;
use crate::geo::LatLon;
use crate::plan::HoldPattern;
use crate::plan::format::{Format, HomePosition, PlanError, parse, report, write as write_format};
use crate::plan::record::WaypointRecord;

fn read_text(text: &str) -> PlanFile {
    parse("a.csv", text, Format::Csv).unwrap_or_else(|errors| panic!("{}", report(&errors)))
}

fn headlines(text: &str) -> Vec<String> {
    parse("a.csv", text, Format::Csv).unwrap_err().iter().map(PlanError::headline).collect()
}

const TWO: &str = "type,lat_deg,lon_deg,alt_m,speed_mps,duration_s,pattern\n\
    FLYOVER,40.4640000,-79.5175000,50,0,0,NONE\n\
    HOLD,-27.4900000,153.0100000,-1.5,10.05,60.5,FIGURE8\n";

#[test]
fn the_table_is_canonical() {
    let file = read_text(TWO);
    assert_eq!((file.name.as_str(), file.losses.items), ("a", 2));
    assert_eq!(file.plan.waypoints[1].pattern, HoldPattern::Figure8);
    assert_eq!(file.plan.records()[1].speed, 1005);
    let written = write_format(&PlanFile { name: String::new(), ..file }, Format::Csv);
    assert_eq!((written.text().as_ref(), written.losses.findings.len()), (TWO, 0));
}

#[test]
fn tables_of_spreadsheets_are_read() {
    let text = "\u{feff}TYPE;alt_m;Lat_Deg;lon_deg;note\r\n\"flyby\";20;40.5;-79.5;\"a; \"\"b\"\"\"\r\n;;;;\r\n\r\n\
                alt_change;30;;;\r\n";
    let file = read_text(text);
    let kinds: Vec<_> = file.plan.waypoints.iter().map(|waypoint| waypoint.kind).collect();
    assert_eq!(kinds, [WaypointType::Flyby, WaypointType::AltChange]);
    assert_eq!(file.plan.waypoints[0].position, LatLon::new(405_000_000, -795_000_000));
    assert_eq!(file.losses.findings[0].to_string(), "info     columns: note: a plan has no such values");
}

#[test]
fn a_yaw_rate_has_its_own_column() {
    let waypoint = WaypointRecord { kind: WaypointType::YawRate, speed: 45, ..Default::default() };
    let written = write_format(&file(&[waypoint, WaypointRecord::default()]), Format::Csv);
    assert_eq!(
        written.text(),
        "type,lat_deg,lon_deg,alt_m,speed_mps,duration_s,pattern,yaw_rate_dps\n\
         YAW_RATE,0.0000000,0.0000000,0,0,0,NONE,45\nFLYOVER,0.0000000,0.0000000,0,0,0,NONE,\n"
    );
    assert_eq!(read_text(&written.text()).plan.records()[0], waypoint);
}

#[test]
fn every_problem_has_its_place_and_value() {
    let text = "type,lat_deg,lon_deg,alt_m,speed_mps,duration_s,pattern,yaw_rate_dps\n\
                FLYOVR,1,2,3,,,,\n\
                FLYBY,91,2,3,,,,\n\
                FLYBY,1,-400,3,,,,\n\
                FLYBY,\"40,5\",2,3,,,,\n\
                FLYBY,40,5,2,3,,,,,\n\
                FLYBY,1,2,NaN,-1,,,\n\
                FLYBY,1,2,30000,700,7000,CIRCLE,5\n\
                YAW_RATE,,,,3,,,\n\
                HOLD,,2,3,,inf,,\n\
                ,1,2,3\n";
    assert_eq!(
        headlines(text),
        [
            "a.csv:2:1: FLYOVR is not a waypoint type; did you mean FLYOVER? allowed: FLYOVER, FLYBY, HOLD, LAND, \
             TAKEOFF, ALT_CHANGE, DELAY, YAW_RATE",
            "a.csv:3:7: latitude 91 is out of range, allowed: -90 to 90",
            "a.csv:4:7: longitude -400 is out of range, allowed: -180 to 180",
            "a.csv:5:8: latitude 40,5 has a decimal comma: write a point",
            "a.csv:6:1: the line has 10 values, the first line 8: a decimal comma is not read",
            "a.csv:7:11: altitude NaN is not a number",
            "a.csv:7:15: speed -1 is out of range; allowed: 0 to 655.35 m/s",
            "a.csv:8:11: altitude 30000 is out of range, allowed: -20000 to 20000 m",
            "a.csv:8:17: speed 700 is out of range; allowed: 0 to 655.35 m/s",
            "a.csv:8:21: duration 7000 is out of range; allowed: 0 to 6553.5 s",
            "a.csv:8:26: CIRCLE is not a hold pattern; allowed: NONE, ORBIT, FIGURE8",
            "a.csv:8:33: yaw_rate_dps 5 belongs to a YAW_RATE only",
            "a.csv:9:13: a YAW_RATE has no speed, its rate is in the column yaw_rate_dps",
            "a.csv:9:17: a YAW_RATE needs the column yaw_rate_dps",
            "a.csv:10:6: latitude is missing",
            "a.csv:10:12: duration inf is not a number",
            "a.csv:11:1: the type is missing",
        ]
    );
    assert_eq!(
        headlines("lat,lon\n1,2"),
        ["a.csv:1:1: the first line has no column type, lat_deg, lon_deg, alt_m"]
    );
}

#[test]
fn a_message_is_one_line() {
    let text = "type,lat_deg,lon_deg,alt_m\n\"a\r\nb\",1,2,3\n";
    assert!(
        headlines(text)[0].starts_with("a.csv:2:2: a  b is not a waypoint type"),
        "{:?}",
        headlines(text)
    );
}

#[test]
fn rounded_values_are_named() {
    let file = read_text("type,lat_deg,lon_deg,alt_m,duration_s\nHOLD,1,181,3,0.01\n");
    let findings: Vec<String> = file.losses.findings.iter().map(ToString::to_string).collect();
    assert_eq!(
        findings,
        [
            "changed  WP 0 (item 1, line 2) longitude: 181 → -179.0000000: a longitude of a plan is within 180 degrees",
            "changed  WP 0 (item 1, line 2) duration: 0.01 s → 0.1 s: a duration of 0 is endless",
        ]
    );
}

#[test]
fn more_than_a_plan_holds_is_one_problem() {
    let text = |count: usize| format!("type,lat_deg,lon_deg,alt_m\n{}", "FLYBY,1,2,3\n".repeat(count));
    assert_eq!(read_text(&text(30)).plan.waypoints.len(), 30);
    assert_eq!(headlines(&text(33)), ["a.csv:32:1: the table has 33 waypoints"]);
    assert_eq!(headlines(&text(20_000)), ["a.csv:10002:1: the table has more than 10000 rows"]);
}

#[test]
fn parts_without_a_column_are_named() {
    let file = PlanFile {
        name: "n".to_owned(),
        description: "d".to_owned(),
        home: "40,-79,300".parse::<HomePosition>().ok(),
        settings: vec!["ap_max_angle = 25".to_owned()],
        ..PlanFile::default()
    };
    assert_eq!(write_format(&file, Format::Csv).losses.counts(), "2 lost, 2 info");
    let high = super::super::law::file(&[WaypointRecord { alt_cm: 2_000_001, ..Default::default() }]);
    assert!(write_format(&high, Format::Csv).is_refused());
}

proptest! {
    #[test]
    fn the_table_carries_the_waypoints(file in plan_file()) {
        let written = write_format(&file, Format::Csv);
        let back = read_text(&written.text());
        prop_assert_eq!(&back.plan, &file.plan);
        prop_assert_eq!(&read_text(&written.text().replace('\n', "\r\n")).plan, &file.plan);
        prop_assert!(back.losses.findings.is_empty());
        let again = write_format(&PlanFile { name: String::new(), ..back }, Format::Csv);
        prop_assert_eq!(again.contents, written.contents);
        prop_assert!(again.losses.findings.is_empty());
    }

    #[test]
    fn no_table_panics(text in "type,lat_deg,lon_deg,alt_m\n(\\PC|[,;\"\n0-9.]){0,80}") {
        let _ = parse("any", &text, Format::Csv);
    }
}
