use super::super::{Format, PlanError, parse, read as read_with, report, write};
use super::*;
use crate::plan::HoldPattern;

const HUB: &str = include_str!("../../../../tests/exchange/litchi/hub.csv");
const SHORT: &str = include_str!("../../../../tests/exchange/litchi/short.csv");
const HEADER: &str = "latitude,longitude,altitude(m),curvesize(m),actiontype1,actionparam1,actiontype2,actionparam2,\
                      altitudemode,speed(m/s)\n";

fn read_text(text: &str) -> PlanFile {
    parse("a.csv", text, Format::Litchi).unwrap_or_else(|errors| panic!("{}", report(&errors)))
}

fn findings(file: &PlanFile) -> Vec<String> {
    file.losses.findings.iter().map(ToString::to_string).collect()
}

#[test]
fn a_mission_of_the_hub_reads() {
    assert_eq!(Format::detect("hub.csv", HUB.as_bytes()), (Format::Litchi, None));
    let file = read_text(HUB);
    let waypoints: Vec<String> = file
        .plan
        .waypoints
        .iter()
        .map(|waypoint| {
            assert_eq!(waypoint.pattern, HoldPattern::None);
            let Waypoint { kind, altitude, speed, duration, .. } = waypoint;
            format!("{kind} {} m {} m/s {} s", altitude.above_home_m(), speed.mps(), duration.get())
        })
        .collect();
    assert_eq!(
        waypoints,
        ["FLYOVER 30 m 0 m/s 0 s", "FLYBY 30 m 5.5 m/s 0 s", "HOLD 35.5 m 0 m/s 4 s", "FLYBY 25 m 4 m/s 0 s",]
    );
    assert_eq!(file.plan.waypoints[3].position.to_string(), "40.4630000,-79.5190000");
    assert_eq!(
        findings(&file),
        [
            "changed  WP 1 (item 2, line 3) curve: 5 m → 2.6 m: a FLYBY begins its turn at the radius of its speed",
            "lost     WP 2 (item 3, line 4) action: rotate to 90°: the nose of the craft follows ap_yaw_mode",
            "changed  WP 3 (item 4, line 5) curve: 12.5 m → 1.4 m: a FLYBY begins its turn at the radius of its speed",
            "assumed  altitude reference: 1 above ground → above home: altitudes above ground are taken as above home, \
             which is right on flat ground only",
            "lost     headings: 3: the nose of the craft follows ap_yaw_mode",
            "info     gimbal modes: 1: plans have no camera",
            "info     points of interest: 1: plans have no camera",
            "info     photos: 1: plans have no camera",
            "info     recordings: 2: plans have no camera",
            "info     camera tilts: 1: plans have no camera",
        ]
    );
}

#[test]
fn a_short_header_reads() {
    let file = read_text(SHORT);
    assert_eq!(file.plan.waypoints[0].kind, WaypointType::Flyby);
    assert_eq!(file.plan.waypoints[1].duration, Seconds::new(1.5));
    assert_eq!(findings(&file).last().unwrap(), "info     curves at stays: 1: the craft stops there");
    let file = read_text("latitude,longitude,altitude(m)\n1,2,3\n");
    assert_eq!(file.plan.waypoints[0].kind, WaypointType::Flyover);
    assert!(file.losses.findings.is_empty());
}

#[test]
fn stays_and_altitude_modes_have_rules() {
    let file =
        read_text(&format!("{HEADER}1,2,3,0,0,1250,0,20,0,0\n1,2,3,0,0,0,-1,0,0,0\n1,2,3,0,9,0,-1,0,0,0\n"));
    assert_eq!(file.plan.waypoints[0].duration, Seconds::new(1.3));
    assert_eq!(file.plan.waypoints[1].kind, WaypointType::Flyover);
    assert_eq!(
        findings(&file),
        [
            "changed  WP 0 (item 1, line 2) duration: 1.27 s → 1.3 s: a HOLD lasts tenths of a second, up to 6553.5 s",
            "lost     WP 2 (item 3, line 4) action: action 9: this action of Litchi is not known",
        ]
    );
    let home = "40.4635,-79.5182,300".parse().ok();
    let options = ReadOptions { flat: true, home, ..ReadOptions::default() };
    let file =
        read_with("a.csv", format!("{HEADER}1,2,3,0,-1,0,-1,0,1,0\n").as_bytes(), Format::Litchi, &options)
            .unwrap();
    assert_eq!((findings(&file), file.home), (vec![], home));
}

#[test]
fn faults_have_their_place() {
    let text = format!(
        "{HEADER}91,2,3,0,-1,0,-1,0,0,0\n1,2,30000,0,-1,0,-1,0,0,0\n1,2,3,0,0,x,-1,0,0,0\n1,2,3,0,-1,0,-1,0,7,0\n\
         1,2,,0,-1,0,-1,0,0,0\n1,2,3,0,-1,0,-1,0,0,\"1,5\"\n"
    );
    let errors = parse("a.csv", &text, Format::Litchi).unwrap_err();
    let headlines: Vec<String> = errors.iter().map(PlanError::headline).collect();
    assert_eq!(
        headlines,
        [
            "a.csv:2:1: latitude 91 is out of range, allowed: -90 to 90",
            "a.csv:3:5: altitude 30000 is out of range, allowed: -20000 to 20000 m",
            "a.csv:4:11: the stay x is not a number",
            "a.csv:5:19: altitudemode 7 is not known, allowed: 0, 1",
            "a.csv:6:5: altitude is missing",
            "a.csv:7:22: speed 1,5 has a decimal comma: write a point",
        ]
    );
    let many = format!("{HEADER}{}", "1,2,3,0,-1,0,-1,0,0,0\n".repeat(31));
    let errors = parse("a.csv", &many, Format::Litchi).unwrap_err();
    assert_eq!(errors.len(), 1);
    assert!(errors[0].headline().ends_with("the mission has 31 waypoints"));
}

#[test]
fn nothing_is_written() {
    let written = write(&read_text(SHORT), Format::Litchi);
    assert!(written.is_refused() && written.contents.is_empty());
    assert_eq!(written.losses.findings[0].to_string(), "refused  format: Litchi mission files are only read");
}
