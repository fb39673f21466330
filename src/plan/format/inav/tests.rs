use proptest::prelude::*;

use super::super::law::{file, plan_file};
use super::super::loss::Severity;
use crate::geo::LatLon;
use crate::plan::format::{Format, PlanError, PlanFile, ReadOptions, read, report, write};
use crate::plan::record::WaypointRecord;
use crate::plan::{HoldPattern, MAX_WAYPOINTS, Waypoint, WaypointType};

mod samples;
mod written;

/// The example of a mission with a home.
const EXAMPLE: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<mission>
  <version value="2.3-pre8"/>
  <mwp cx="-79.51825" cy="40.46350" home-x="-79.5182000" home-y="40.4635000" zoom="17" generator="betadeck"/>
  <missionitem no="1" action="WAYPOINT" lat="40.4640000" lon="-79.5175000" alt="50" parameter1="500" parameter2="0" parameter3="0" flag="0"/>
  <missionitem no="2" action="POSHOLD_TIME" lat="40.4630000" lon="-79.5190000" alt="50" parameter1="30" parameter2="500" parameter3="0" flag="0"/>
  <missionitem no="3" action="LAND" lat="40.4640000" lon="-79.5190000" alt="50" parameter1="0" parameter2="0" parameter3="0" flag="165"/>
</mission>
"#;

fn try_read(text: &str, format: Format, options: &ReadOptions) -> Result<PlanFile, Vec<String>> {
    read("a", text.as_bytes(), format, options)
        .map_err(|errors| errors.iter().map(PlanError::headline).collect())
}

fn read_text(text: &str, format: Format) -> PlanFile {
    read("a", text.as_bytes(), format, &ReadOptions::default())
        .unwrap_or_else(|errors| panic!("{}\n{text}", report(&errors)))
}

fn findings(file: &PlanFile) -> Vec<String> {
    file.losses.findings.iter().map(ToString::to_string).collect()
}

/// Returns each waypoint in a few words.
fn words(file: &PlanFile) -> Vec<String> {
    let word = |waypoint: &Waypoint| {
        let Waypoint { position, altitude, speed, duration, kind, .. } = waypoint;
        format!("{kind} {position} {} m {} m/s {} s", altitude.above_home_m(), speed.mps(), duration.get())
    };
    file.plan.waypoints.iter().map(word).collect()
}

/// Reads `wp` lines without their word and index.
fn cli(items: &[&str], options: &ReadOptions) -> Result<PlanFile, Vec<String>> {
    let lines: Vec<String> =
        (0..).zip(items).map(|(index, item): (usize, _)| format!("wp {index} {item}")).collect();
    try_read(&lines.join("\n"), Format::InavCli, options)
}

fn at_home() -> ReadOptions {
    ReadOptions { home: "40.4635,-79.5182,300".parse().ok(), ..ReadOptions::default() }
}

const A: &str = "404640000 -795175000 5000";

#[test]
fn the_example_reads_and_prints() {
    let file = read_text(EXAMPLE, Format::MwXml);
    assert_eq!(file.home, "40.4635,-79.5182".parse().ok());
    assert_eq!(
        words(&file),
        [
            "FLYBY 40.4640000,-79.5175000 50 m 5 m/s 0 s",
            "HOLD 40.4630000,-79.5190000 50 m 5 m/s 30 s",
            "LAND 40.4640000,-79.5190000 50 m 0 m/s 0 s",
        ]
    );
    assert_eq!(
        findings(&file),
        [
            "assumed  type: 1 WAYPOINT → FLYBY: INAV turns at a WAYPOINT by its own setting: choose with --waypoint-as"
        ]
    );
    assert_eq!((file.losses.items, file.losses.waypoints), (3, 3));
    let written = write(&file, Format::MwXml);
    let public = EXAMPLE.strip_suffix("</mission>\n").unwrap();
    assert!(written.text().starts_with(public), "{}", written.text());
    assert!(written.losses.is_lossless(), "{:?}", written.losses);
}

#[test]
fn every_action_has_its_rule() {
    let file = cli(
        &[
            &format!("1 {A} 51 0 0 0"),
            &format!("1 {A} 50 0 30 0"),
            &format!("2 {A} 0 0 0 0"),
            &format!("3 {A} 0 600 0 0"),
            &format!("3 {A} 20 30 0 0"),
            "5 404640000 -795175000 0 0 0 0 0",
            "7 0 0 0 90 0 0 0",
            &format!("0 {A} 0 0 0 0"),
            &format!("8 {A} 200 12 0 165"),
        ],
        &ReadOptions::default(),
    )
    .unwrap();
    let at = "40.4640000,-79.5175000 50 m";
    assert_eq!(
        words(&file),
        [
            format!("FLYBY {at} 0.51 m/s 0 s"),
            format!("FLYBY {at} 0 m/s 0 s"),
            format!("HOLD {at} 0 m/s 0 s"),
            format!("HOLD {at} 6 m/s 0.1 s"),
            format!("HOLD {at} 0 m/s 20 s"),
            format!("LAND {at} 2 m/s 0 s"),
        ]
    );
    assert_eq!(
        findings(&file),
        [
            "lost     WP 1 (item 1, line 2) user actions: 1, 2, 3, 4: plans switch nothing at a waypoint",
            "changed  WP 1 (item 1, line 2) speed: 0.5 m/s → default: INAV ignores a leg speed up to 0.5 m/s",
            "changed  WP 4 (item 4, line 5) speed: 0.3 m/s → default: INAV ignores a leg speed up to 0.5 m/s",
            "lost     item 5, line 6 nose direction: SET_POI: the nose of the craft follows ap_yaw_mode",
            "lost     item 6, line 7 nose direction: SET_HEAD: the nose of the craft follows ap_yaw_mode",
            "info     item 7, line 8 item: UNASSIGNED: it is an empty item",
            "info     WP 5 (item 8, line 9) ground elevation: 12 m: a LAND finds the ground by its touchdown",
            "assumed  type: 2 WAYPOINT → FLYBY: INAV turns at a WAYPOINT by its own setting: choose with --waypoint-as",
        ]
    );
}

#[test]
fn returns_and_places_at_home_need_the_home() {
    let items = [
        &format!("1 {A} 0 0 0 0")[..],
        "1 1 2 4000 0 0 0 72",
        "4 0 0 0 1 0 0 0",
        &format!("2 {A} 0 0 0 165"),
    ];
    let file = cli(&items, &at_home()).unwrap();
    assert_eq!(
        words(&file)[1..],
        [
            "FLYBY 40.4635000,-79.5182000 40 m 0 m/s 0 s",
            "FLYOVER 40.4635000,-79.5182000 40 m 0 m/s 0 s",
            "LAND 40.4635000,-79.5182000 40 m 0 m/s 0 s",
        ]
    );
    assert_eq!(
        findings(&file)[..3],
        [
            "assumed  WP 1 (item 1, line 2) position: 0.0000001,0.0000002 → 40.4635000,-79.5182000: the item is at the \
             home of the flight",
            "changed  WP 2 (item 2, line 3) item: RTH → FLYOVER and LAND at home: plans have no return: they fly home \
             at the altitude of the last waypoint",
            "lost     WP 4 (item 2, line 3) items: 1 after it: the mission ends with this RTH",
        ]
    );
    assert_eq!(
        cli(&items, &ReadOptions::default()).unwrap_err(),
        [
            "a:2:1: an item at home needs the home, and the file does not have it",
            "a:3:1: an RTH needs the home, and the file does not have it",
        ]
    );
    let hold = cli(&["1 0 0 2500 0 0 0 0", "4 0 0 3000 0 0 0 165"], &at_home()).unwrap();
    assert_eq!(
        words(&hold),
        ["FLYBY", "FLYOVER", "HOLD"].map(|kind| format!("{kind} 40.4635000,-79.5182000 25 m 0 m/s 0 s"))
    );
    let alone = cli(&["4 0 0 3000 0 0 0 165"], &at_home()).unwrap();
    assert!(words(&alone)[1].starts_with("HOLD 40.4635000,-79.5182000 30 m"));
}

#[test]
fn altitudes_above_sea_level_need_the_altitude_of_the_home() {
    let items = ["1 404640000 -795175000 35000 0 0 1 165"];
    assert!(words(&cli(&items, &at_home()).unwrap())[0].contains(" 50 m "));
    let without = ReadOptions { home: "40.4635,-79.5182".parse().ok(), ..ReadOptions::default() };
    assert_eq!(
        cli(&items, &without).unwrap_err(),
        ["a:1:1: altitude 350 m is above sea level, and the altitude of the home is unknown: add --home \
             LAT,LON,AMSL"]
    );
}

#[test]
fn jumps_are_unrolled_or_refused() {
    let jump = |jump: &str| {
        let items =
            [&format!("1 {A} 0 0 0 0")[..], &format!("1 {A} 0 0 2 0"), jump, &format!("8 {A} 0 0 0 165")];
        cli(&items, &ReadOptions::default())
    };
    let file = jump("6 0 0 0 0 2 0 0").unwrap();
    assert_eq!((file.plan.waypoints.len(), file.losses.items), (7, 4));
    assert_eq!(
        findings(&file)[..2],
        [
            "lost     WP 1 (item 1, line 2) user actions: 1: plans switch nothing at a waypoint",
            "changed  item 2, line 3 item: JUMP to item 0, repeats: 2: plans have no jumps: the waypoints are repeated",
        ]
    );
    assert_eq!(
        jump("6 0 0 0 0 -1 0 0").unwrap_err(),
        ["a:3:1: the JUMP repeats without end, a plan has an end"]
    );
    assert_eq!(
        jump("6 0 0 0 0 20 0 0").unwrap_err(),
        ["a:3:1: the repeats of this JUMP give more than 30 waypoints"]
    );
    assert_eq!(jump("6 0 0 0 4 1 0 0").unwrap_err(), ["a:3:1: the JUMP has no item 4 as its target"]);
}

#[test]
fn a_mission_is_chosen() {
    let items = [
        &format!("1 {A} 0 0 0 165")[..],
        &format!("2 {A} 0 0 0 0"),
        "6 0 0 0 0 1 0 0",
        &format!("8 {A} 0 0 0 165"),
    ];
    let first = cli(&items, &ReadOptions::default()).unwrap();
    assert_eq!((first.plan.waypoints.len(), first.losses.items), (1, 1));
    assert_eq!(
        findings(&first)[0],
        "lost     missions: mission 2 (3 items): a plan is one mission: choose it with --mission N"
    );
    let second = cli(&items, &ReadOptions { mission: 2, ..ReadOptions::default() }).unwrap();
    assert_eq!(second.plan.waypoints.len(), 3);
    assert!(findings(&second)[0].contains("mission 1 (1 items)"));
    let third = cli(&items, &ReadOptions { mission: 3, ..ReadOptions::default() });
    assert_eq!(third.unwrap_err(), ["a:1:1: the file has no mission 3"]);
}

#[test]
fn a_home_that_no_place_has_costs_a_finding_not_the_plan() {
    for (was, wrong, from) in [
        ("home-y=\"40.4635000\"", "home-y=\"404.635\"", "404.635,-79.5182"),
        ("home-x=\"-79.5182000\"", "home-x=\"\"", "40.4635000, → unknown: longitude is missing"),
        (
            "home-x=\"-79.5182000\"",
            "home-x=\"west\"",
            "40.4635000,west → unknown: longitude west is not a number",
        ),
    ] {
        let file = read_text(&EXAMPLE.replace(was, wrong), Format::MwXml);
        assert_eq!((file.home, file.plan.waypoints.len()), (None, 3));
        let found = findings(&file).concat();
        assert!(found.contains("lost     line 4 home: ") && found.contains(from), "{found}");
        assert!(found.contains("add --home LAT,LON,AMSL"), "{found}");
    }
}

#[test]
fn faults_have_their_place_and_value() {
    let text = EXAMPLE
        .replace("lat=\"40.4640000\" lon=\"-79.5175000\"", "lat=\"91\" lon=\"-79.5175000\"")
        .replace(
            "lon=\"-79.5190000\" alt=\"50\" parameter1=\"30\"",
            "lon=\"-79,5\" alt=\"nan\" parameter1=\"3.5\"",
        )
        .replace("action=\"LAND\"", "action=\"LNAD\"");
    assert_eq!(
        try_read(&text, Format::MwXml, &ReadOptions::default()).unwrap_err(),
        [
            "a:5:3: latitude 91 is out of range, allowed: -90 to 90",
            "a:6:3: lon -79,5 has a decimal comma: write a point",
            "a:6:3: alt nan is not a number",
            "a:6:3: parameter1 3.5 is not a whole number",
            "a:7:3: LNAD is not an action of INAV",
        ]
    );
    let xml = |text: &str| try_read(text, Format::MwXml, &ReadOptions::default()).unwrap_err();
    assert_eq!(xml("<kml/>"), ["a:1:1: the first element is kml, that of a mission is mission"]);
    assert_eq!(xml(""), ["a:1:1: the file has no element mission"]);
    assert_eq!(xml("<mission><missionitem/></mission>"), ["a:1:10: the item has no action"]);
    assert!(xml("<mission><missionitem action='LAND'/></mission>")[0].contains("lat is missing"));
    assert!(xml("<mission><a>")[0].contains("ends inside an element"));
    assert_eq!(
        cli(
            &["1 1,5 2 3 0 0 0 0", "9 1 2 3 0 0 0 0", "1 1 2 3", "1 910000000 2 3000000 40000 0 0 0"],
            &ReadOptions::default()
        )
        .unwrap_err(),
        [
            "a:1:1: latitude 1,5 is not a whole number: a decimal comma is not read",
            "a:2:1: 9 is not an action of INAV",
            "a:3:1: wp takes 9 values",
            "a:4:1: altitude 30000 is out of range, allowed: -20000 to 20000 m",
            "a:4:1: latitude 91 is out of range, allowed: -90 to 90",
            "a:4:1: parameter 1 40000 is out of range",
        ]
    );
}

#[test]
fn large_files_are_refused_with_their_number() {
    let item = "<missionitem action='WAYPOINT' lat='1' lon='2' alt='3'/>\n";
    let many = |count: usize| format!("<mission>{}</mission>", item.repeat(count));
    let say = |count| try_read(&many(count), Format::MwXml, &ReadOptions::default()).unwrap_err();
    assert_eq!(read_text(&many(30), Format::MwXml).plan.waypoints.len(), 30);
    assert_eq!(say(31), ["a:1:10: the mission has 31 waypoints"]);
    assert_eq!(say(10_000), ["a:1:10: the mission has 10000 waypoints"]);
    assert_eq!(say(20_000), ["a:10001:1: the file has more than 10000 items"]);
    let lines: Vec<String> = (0..31).map(|index| format!("wp {index} 1 1 2 3 0 0 0 0")).collect();
    assert_eq!(
        try_read(&lines.join("\n"), Format::InavCli, &ReadOptions::default()).unwrap_err(),
        ["a:1:1: the mission has 31 waypoints"]
    );
}
