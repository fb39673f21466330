//! Tests of plans in GPX.

use super::super::{Format, PlanError, PlanFile, ReadOptions, parse, read, report, write};

const PLAN: &str = "name = 'a'\nsettings = ['ap_max_angle = 25']\n\
    [home]\nlat_deg = 40.4635\nlon_deg = -79.5182\nalt_amsl_m = 300\n\
    [[waypoint]]\ntype = 'TAKEOFF'\nalt_m = 10\n\
    [[waypoint]]\ntype = 'HOLD'\nlat_deg = 40.463\nlon_deg = -79.519\nalt_m = 50.25\nduration_s = 30\npattern = 'ORBIT'\n\
    [[waypoint]]\ntype = 'YAW_RATE'\nyaw_rate_dps = 45\n";

fn plan() -> PlanFile {
    parse("p", PLAN, Format::Toml).unwrap_or_else(|errors| panic!("{}", report(&errors)))
}

fn read_with(text: &str, options: &ReadOptions) -> PlanFile {
    read("p.gpx", text.as_bytes(), Format::Gpx, options)
        .unwrap_or_else(|errors| panic!("{}", report(&errors)))
}

fn faults(text: &str) -> Vec<String> {
    let errors = read("p.gpx", text.as_bytes(), Format::Gpx, &ReadOptions::default()).unwrap_err();
    errors.iter().map(|error| format!("{} | {}", PlanError::headline(error), error.hint)).collect()
}

#[test]
fn the_document_is_one_route() {
    let written = write(&plan(), Format::Gpx);
    assert_eq!(
        written.text(),
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
<gpx version=\"1.1\" creator=\"betadeck\" xmlns=\"http://www.topografix.com/GPX/1/1\" xmlns:b=\"urn:betadeck:1\">\n  \
  <metadata>\n    <name>a</name>\n    \
    <extensions><b:betadeck>1</b:betadeck><b:setting>ap_max_angle = 25</b:setting></extensions>\n  </metadata>\n  \
  <wpt lat=\"40.4635000\" lon=\"-79.5182000\"><ele>300</ele><name>Home</name><type>HOME</type>\n    \
    <extensions><b:alt_amsl_m>300</b:alt_amsl_m></extensions>\n  </wpt>\n  \
  <rte>\n    <name>a</name>\n    \
    <rtept lat=\"40.4635000\" lon=\"-79.5182000\"><ele>310</ele><name>WP 0 TAKEOFF</name><type>TAKEOFF</type>\n      \
      <extensions><b:alt_m>10</b:alt_m></extensions>\n    </rtept>\n    \
    <rtept lat=\"40.4630000\" lon=\"-79.5190000\"><ele>350.25</ele><name>WP 1 HOLD</name><type>HOLD</type>\n      \
      <extensions><b:alt_m>50.25</b:alt_m><b:duration_s>30</b:duration_s><b:pattern>ORBIT</b:pattern></extensions>\n    \
    </rtept>\n    \
    <rtept lat=\"40.4630000\" lon=\"-79.5190000\"><name>WP 2 YAW_RATE</name><type>YAW_RATE</type>\n      \
      <extensions><b:yaw_rate_dps>45</b:yaw_rate_dps></extensions>\n    </rtept>\n  \
  </rte>\n</gpx>\n"
    );
    assert!(written.losses.is_lossless());
    let homeless = write(&PlanFile { home: None, ..plan() }, Format::Gpx);
    assert!(!homeless.text().contains("<ele>"));
    assert_eq!(homeless.losses.counts(), "1 lost, 1 info");
}

#[test]
fn routes_come_before_waypoints_and_tracks() {
    let options = ReadOptions { altitude_m: Some(20.0), ..ReadOptions::default() };
    let points = "<wpt lat='1' lon='2'/><wpt lat='1' lon='3'/><wpt lat='1' lon='4'/>";
    let route = "<rte><name>r</name><rtept lat='1' lon='2'/><rtept lat='1' lon='3'/></rte>";
    let track = "<trk><name>t</name><trkseg><trkpt lat='1' lon='2'/><trkpt lat='1' lon='3'/></trkseg></trk>";
    let count = |text: &str| read_with(&format!("<gpx>{text}</gpx>"), &options).plan.waypoints.len();
    assert_eq!(count(&format!("{points}{track}{route}")), 2);
    assert_eq!(count(&format!("{points}{track}")), 3);
    assert!(
        faults(&format!("<gpx>{track}</gpx>"))[0]
            .contains("choose with --feature: 1 \"t\" (track, 2 points)")
    );
    let named = ReadOptions { feature: Some("t".to_owned()), ..options.clone() };
    let text = format!("<gpx>{points}{track}{route}</gpx>");
    assert_eq!(read_with(&text, &named).plan.waypoints.len(), 2);
    assert!(faults(&format!("<gpx>{route}{route}</gpx>"))[0].contains("the file has 2 lines"));
    assert!(faults("<gpx/>")[0].contains("no line and no points"));
}

#[test]
fn elevations_are_above_sea_level() {
    let text = "<gpx><rte><rtept lat='1' lon='2'><ele>350</ele></rtept><rtept lat='1' lon='3'/></rte></gpx>";
    assert!(faults(text)[0].contains("altitude 350 m is above sea level"));
    let options = ReadOptions { home: Some("1,2,300".parse().unwrap()), ..ReadOptions::default() };
    let file = read_with(text, &options);
    let cm: Vec<i32> = file.plan.waypoints.iter().map(|waypoint| waypoint.altitude.cm()).collect();
    assert_eq!(cm, [5000, 1000]);
    assert_eq!(file.losses.counts(), "2 assumed, 1 info");
}

#[test]
fn a_changed_elevation_counts() {
    let text = write(&plan(), Format::Gpx).text().replace("<ele>350.25</ele>", "<ele>360</ele>");
    let file = read_with(&text, &ReadOptions::default());
    assert_eq!(file.plan.waypoints[1].altitude.cm(), 6000);
    assert_eq!(file.losses.counts(), "1 assumed");
    let text = write(&plan(), Format::Gpx).text().replace("<ele>300</ele>", "<ele>290</ele>");
    let file = read_with(&text, &ReadOptions::default());
    assert_eq!(file.home.unwrap().amsl_m, Some(290.0));
}

#[test]
fn a_type_without_its_data_is_a_plain_point() {
    let point = |kind: &str| format!("<rtept lat='1' lon='2'><ele>350</ele><type>{kind}</type></rtept>");
    let words = ["FLYOVER", "HOLD", "TAKEOFF", "DELAY", "ALT_CHANGE", "YAW_RATE", "Hold", "LAND"];
    let text = format!("<gpx><rte>{}</rte></gpx>", words.map(point).concat());
    let home = Some("1,2,300".parse().unwrap());
    let file = read_with(&text, &ReadOptions { home, ..ReadOptions::default() });
    let kinds: Vec<String> = file.plan.waypoints.iter().map(|waypoint| waypoint.kind.to_string()).collect();
    let plain = ["FLYBY"; 6];
    assert_eq!(kinds, [&["FLYOVER"], &plain[..], &["LAND"]].concat());
    assert!(file.plan.waypoints.iter().all(|waypoint| waypoint.altitude.cm() == 5000));
    let lost: Vec<String> = file.losses.findings.iter().map(ToString::to_string).collect();
    let lost: Vec<&String> = lost.iter().filter(|line| line.starts_with("lost ")).collect();
    assert_eq!(lost.len(), 5, "{lost:?}");
    assert_eq!(
        lost[0],
        "lost     WP 1 (item 2, line 1) type: HOLD → FLYBY: the data of the point are missing"
    );
}

#[test]
fn a_delay_of_no_time_comes_back() {
    let delay = parse("p", "[[waypoint]]\ntype = 'DELAY'\nduration_s = 0\n", Format::Toml).unwrap();
    let file = read_with(&write(&delay, Format::Gpx).text(), &ReadOptions::default());
    assert_eq!(file.plan, delay.plan);
    assert!(file.losses.is_lossless());
}

#[test]
fn a_given_altitude_completes_the_home_of_the_file() {
    let text = "<gpx><wpt lat='1' lon='2'><type>HOME</type></wpt><rte><rtept lat='1' lon='3'/></rte></gpx>";
    let home = |given: &str| {
        let options = ReadOptions { home: Some(given.parse().unwrap()), ..ReadOptions::default() };
        read_with(text, &options).home.unwrap().amsl_m
    };
    assert_eq!(home("1,2.000001,300"), Some(300.0));
    assert_eq!((home("1,2.1,300"), home("1,2")), (None, None));
}

#[test]
fn a_point_that_does_not_say_how_it_is_passed_is_assumed() {
    let options = ReadOptions { altitude_m: Some(20.0), ..ReadOptions::default() };
    let file = read_with("<gpx><rte><rtept lat='1' lon='2'/><rtept lat='1' lon='3'/></rte></gpx>", &options);
    let lines: Vec<String> = file.losses.findings.iter().map(ToString::to_string).collect();
    assert_eq!(
        lines,
        ["assumed  type: FLYBY: the file does not say how a point is passed: set it with --waypoint-as"]
    );
}
