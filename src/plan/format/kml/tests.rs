//! Tests of plans in KML.

use super::super::{
    Format, HomePosition, PlanError, PlanFile, ReadOptions, WriteOptions, parse, read, report, write_with,
};
use crate::plan::{HoldPattern, WaypointType};

const PLAN: &str = "name = 'a & b'\ndescription = 'two'\nsettings = ['ap_max_distance_from_home = 500']\n\
    [home]\nlat_deg = 40.4635\nlon_deg = -79.5182\nalt_amsl_m = 300\n\
    [[waypoint]]\ntype = 'TAKEOFF'\nalt_m = 10\n\
    [[waypoint]]\ntype = 'FLYOVER'\nlat_deg = 40.464\nlon_deg = -79.5175\nalt_m = 50\nspeed_mps = 5\n\
    [[waypoint]]\ntype = 'HOLD'\nlat_deg = 40.463\nlon_deg = -79.519\nalt_m = 50.25\nduration_s = 30\npattern = 'ORBIT'\n";

fn plan() -> PlanFile {
    parse("p", PLAN, Format::Toml).unwrap_or_else(|errors| panic!("{}", report(&errors)))
}

fn document(body: &str) -> String {
    format!("<kml xmlns=\"http://www.opengis.net/kml/2.2\"><Document>{body}</Document></kml>")
}

fn line(name: &str, mode: &str, coordinates: &str) -> String {
    format!(
        "<Placemark><name>{name}</name><LineString><altitudeMode>{mode}</altitudeMode>\
         <coordinates>{coordinates}</coordinates></LineString></Placemark>"
    )
}

fn read_with(text: &str, options: &ReadOptions) -> PlanFile {
    read("p.kml", text.as_bytes(), Format::Kml, options)
        .unwrap_or_else(|errors| panic!("{}", report(&errors)))
}

fn findings(file: &PlanFile) -> Vec<String> {
    file.losses.findings.iter().map(ToString::to_string).collect()
}

fn faults(text: &str, options: &ReadOptions) -> Vec<String> {
    let errors = read("p.kml", text.as_bytes(), Format::Kml, options).unwrap_err();
    errors.iter().map(|error| format!("{} | {}", PlanError::headline(error), error.hint)).collect()
}

#[test]
fn the_document_shows_points_path_and_fence() {
    let written = write_with(&plan(), Format::Kml, &WriteOptions::default());
    let text = written.text();
    for part in [
        "<name>a &amp; b</name>",
        "<Data name=\"betadeck\"><value>1</value></Data>",
        "<Data name=\"setting\"><value>ap_max_distance_from_home = 500</value></Data>",
        "<Point><altitudeMode>absolute</altitudeMode><coordinates>-79.5182000,40.4635000,300</coordinates></Point>",
        "<LineString><altitudeMode>relativeToGround</altitudeMode><coordinates>\n      \
         -79.5175000,40.4640000,50\n      -79.5190000,40.4630000,50.25\n",
        "<name>WP 2 HOLD</name>",
        "<Data name=\"pattern\"><value>ORBIT</value></Data>",
        "<Data name=\"featureType\"><value>geofence</value></Data>",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
    let lines: Vec<String> = written.losses.findings.iter().map(ToString::to_string).collect();
    assert_eq!(lines.len(), 3, "{lines:?}");
    assert!(written.losses.is_lossless());
    let absolute = write_with(&plan(), Format::Kml, &WriteOptions { absolute: true });
    assert!(
        absolute
            .text()
            .contains("<altitudeMode>absolute</altitudeMode><coordinates>-79.5190000,40.4630000,350.25<")
    );
    let homeless = PlanFile { home: None, ..plan() };
    let refused = write_with(&homeless, Format::Kml, &WriteOptions { absolute: true });
    assert!(refused.is_refused() && refused.contents.is_empty());
}

#[test]
fn a_changed_point_counts() {
    let text = write_with(&plan(), Format::Kml, &WriteOptions::default()).text().into_owned();
    let moved = text.replace("-79.5190000,40.4630000,50.25</", "-79.52,40.4630000,60</");
    let file = read_with(&moved, &ReadOptions::default());
    let hold = file.plan.waypoints[2];
    assert_eq!((hold.kind, hold.pattern, hold.altitude.cm()), (WaypointType::Hold, HoldPattern::Orbit, 6000));
    assert_eq!(hold.position.lon_e7, -795_200_000);
    assert_eq!(
        findings(&file),
        [format!(
            "assumed  WP 2 (item 5, line {}) altitude: 50.25 m → 60 m: another program changed the altitude of the \
             point, the point counts",
            moved[..moved.find("<name>WP 2 HOLD").unwrap()].lines().count() - 1
        )]
    );
    let other = text.replace("\"betadeck\"><value>1<", "\"betadeck\"><value>2<");
    let file = read_with(&other, &ReadOptions { feature: Some("Path".to_owned()), ..ReadOptions::default() });
    assert!(findings(&file)[0].starts_with("info     lines") || findings(&file).len() > 1);
    let file = read_with(&other, &ReadOptions::default());
    assert!(
        findings(&file).iter().any(|line| line.starts_with("assumed  betadeck data: version 2")),
        "{file:?}"
    );
    assert_eq!((file.settings.len(), file.plan.waypoints.len()), (0, 2));
    let wrong = text.replace("<value>ORBIT</value>", "<value>CIRCLE</value>");
    assert!(faults(&wrong, &ReadOptions::default())[0].contains("CIRCLE is not a hold pattern"));
}

#[test]
fn altitudes_have_the_reference_of_their_mode() {
    let home: HomePosition = "40.4635,-79.5182,300".parse().unwrap();
    let with_home = ReadOptions { home: Some(home), ..ReadOptions::default() };
    let cm = |file: &PlanFile| file.plan.waypoints.iter().map(|w| w.altitude.cm()).collect::<Vec<_>>();
    let absolute = document(&line("a", "absolute", "1,2,350 1,2.1,340.5"));
    assert_eq!(cm(&read_with(&absolute, &with_home)), [5000, 4050]);
    let faults_of = faults(&absolute, &ReadOptions::default());
    assert_eq!(faults_of.len(), 1);
    assert!(faults_of[0].contains("altitude 350 m is above sea level"), "{faults_of:?}");

    let ground = document(&line("a", "relativeToGround", "1,2,35 1,2.1,34.5"));
    let file = read_with(&ground, &ReadOptions::default());
    assert_eq!(cm(&file), [3500, 3450]);
    assert_eq!(
        findings(&file).iter().filter(|line| line.starts_with("assumed  altitude reference")).count(),
        1
    );
    let flat = read_with(&ground, &ReadOptions { flat: true, ..ReadOptions::default() });
    assert_eq!(flat.losses.counts(), "1 assumed");

    let clamped = document(&line("a", "clampToGround", "1,2,35 1,2.1"));
    let file = read_with(&clamped, &ReadOptions::default());
    assert_eq!(cm(&file), [1000, 1000]);
    assert_eq!(
        findings(&file)[0],
        "assumed  WP 0 (item 1, line 1) altitude: 10 m: the point has no altitude: set it with --altitude"
    );
    let given = read_with(&clamped, &ReadOptions { altitude_m: Some(42.0), ..ReadOptions::default() });
    assert_eq!(cm(&given), [4200, 4200]);
    assert_eq!(given.losses.counts(), "1 assumed");
    let zero =
        read_with(&document(&line("a", "relativeToGround", "1,2,0 1,2.1,20")), &ReadOptions::default());
    assert_eq!(cm(&zero), [1000, 2000]);
}

#[test]
fn one_of_several_lines_is_chosen() {
    let body = [
        line("one", "relativeToGround", "1,2,5 1,3,5"),
        line("two", "relativeToGround", "1,4,5 1,5,5 1,6,5"),
    ];
    let text = document(&format!("{}\n{}", body[0], body[1]));
    let found = faults(&text, &ReadOptions::default());
    assert_eq!(
        found,
        [
            "p.kml:2:1: the file has 2 lines | choose with --feature: 1 \"one\" (2 points), 2 \"two\" (3 points)"
        ]
    );
    for word in ["2", "two"] {
        let options = ReadOptions { feature: Some(word.to_owned()), ..ReadOptions::default() };
        let file = read_with(&text, &options);
        assert_eq!((file.plan.waypoints.len(), file.losses.items), (3, 3));
        assert!(findings(&file)[0].contains("lines: 1: other lines of the file are not part of the plan"));
    }
    let options = ReadOptions { feature: Some("three".to_owned()), ..ReadOptions::default() };
    assert!(faults(&text, &options)[0].contains("there is no line three"));
    let same = document(&format!("{}{}", body[0], body[0]));
    let options = ReadOptions { feature: Some("one".to_owned()), ..ReadOptions::default() };
    assert!(faults(&same, &options)[0].contains("2 lines have the name one"));
}

#[test]
fn rings_and_tracks_are_taken_on_request() {
    let ring = document(
        "<Placemark><name>f</name><Polygon><outerBoundaryIs><LinearRing><coordinates>0,0 1,0 1,1 0,0</coordinates>\
         </LinearRing></outerBoundaryIs></Polygon></Placemark>",
    );
    assert!(
        faults(&ring, &ReadOptions::default())[0]
            .contains("the file has polygons only | take the outer ring")
    );
    let options = ReadOptions { ring: true, ..ReadOptions::default() };
    assert_eq!(read_with(&ring, &options).plan.waypoints.len(), 3);
    let zone = ring.replace(
        "<Polygon>",
        "<ExtendedData><Data name='zone'><value>exclusion</value></Data></ExtendedData><Polygon>",
    );
    assert!(!faults(&zone, &options).is_empty());
    let track = document(
        "<Placemark><name>t</name><Track><coord>1 2 5</coord><coord>1 3 5</coord></Track></Placemark>",
    );
    let found = faults(&track, &ReadOptions::default());
    assert!(
        found[0].contains("recorded tracks only | choose with --feature: 1 \"t\" (track, 2 points)"),
        "{found:?}"
    );
    let options = ReadOptions { feature: Some("1".to_owned()), ..ReadOptions::default() };
    assert_eq!(read_with(&track, &options).plan.waypoints.len(), 2);
    assert!(faults(&document(""), &ReadOptions::default())[0].contains("no line and no points"));
    let link = document(&format!(
        "<NetworkLink><Link><href>http://x</href></Link></NetworkLink>{}",
        line("a", "x", "1,2 1,3")
    ));
    assert!(
        findings(&read_with(&link, &ReadOptions::default()))[0].contains("info     line 1 NetworkLink: 1")
    );
}

#[test]
fn long_lines_need_a_tolerance() {
    let points: Vec<String> = (0..100)
        .map(|at| format!("1.{at:03},2.{:03},50", if at % 3 == 0 { at % 7 + 1 } else { 0 }))
        .collect();
    let text = document(&line("a", "relativeToGround", &points.join(" ")));
    let found = faults(&text, &ReadOptions::default());
    assert_eq!(found.len(), 1);
    assert!(found[0].contains("the line has 100 points, a plan holds at most 30"), "{found:?}");
    let hint = found[0].split("--simplify ").nth(1).unwrap().split(' ').next().unwrap();
    let options =
        |metres: f64| ReadOptions { simplify_m: Some(metres), flat: true, ..ReadOptions::default() };
    let file = read_with(&text, &options(hint.parse().unwrap()));
    assert!(file.plan.waypoints.len() <= 30);
    assert!(findings(&file)[0].starts_with("changed  line 1 points: 100 → "), "{:?}", findings(&file));
    assert!(faults(&text, &options(0.01))[0].contains("more than 30 remain with --simplify 0.01"));
    let points = "<Placemark><Point><coordinates>1,2,5</coordinates></Point></Placemark>";
    let many = faults(&document(&points.repeat(31)), &ReadOptions { flat: true, ..ReadOptions::default() });
    assert!(many[0].contains("the file has 31 waypoints, a plan holds at most 30"), "{many:?}");
    let items = faults(&document(&points.repeat(10_001)), &ReadOptions::default());
    assert!(items.len() == 1 && items[0].contains("more than 10000 shapes"), "{items:?}");
}

#[test]
fn longitudes_are_wrapped_with_a_finding() {
    let text = document(&line("a", "clampToGround", "359,2 -181,3"));
    let file = read_with(&text, &ReadOptions { altitude_m: Some(5.0), ..ReadOptions::default() });
    assert_eq!(file.plan.waypoints[0].position.lon_e7, -10_000_000);
    assert!(findings(&file)[0].starts_with("changed  line 1 longitude"));
}

#[test]
fn an_archive_is_read_as_its_document() {
    let written = write_with(&plan(), Format::Kmz, &WriteOptions::default());
    let file = read("p.kmz", &written.contents, Format::Kmz, &ReadOptions::default()).unwrap();
    assert_eq!((file.plan, file.home), (plan().plan, plan().home));
    let errors = read("p.kmz", b"<kml/>", Format::Kmz, &ReadOptions::default()).unwrap_err();
    assert!(errors[0].headline().contains("the archive cannot be read"));
}
