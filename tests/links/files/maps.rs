//! Plans in KML, KMZ, GPX and GeoJSON: the law of the round trip, and files as other programs write them.

use betadeck::geo::LatLon;
use betadeck::plan::WaypointRecord;
use betadeck::plan::feature::{Feature, Shape};
use betadeck::plan::format::loss::Severity;
use betadeck::plan::format::{
    Format, HomePosition, PlanFile, ReadOptions, WriteOptions, read, read_features, report, write_with,
};
use betadeck::plan::{FlightPlan, HoldPattern, MAX_WAYPOINTS, Waypoint, WaypointType};
use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;
use strum::IntoEnumIterator as _;

const MAPS: [Format; 4] = [Format::Kml, Format::Kmz, Format::Gpx, Format::GeoJson];

fn place() -> impl Strategy<Value = LatLon> {
    (-900_000_000..=900_000_000, -1_800_000_000..=1_800_000_000).prop_map(|(lat, lon)| LatLon::new(lat, lon))
}

prop_compose! {
    fn waypoint()(
        position in prop_oneof![Just(LatLon::default()), place()],
        alt_cm in prop_oneof![-10_000..100_000, any::<i32>()],
        speed in prop_oneof![Just(0), any::<u16>()],
        duration_ds in prop_oneof![Just(0), any::<u16>()],
        kind in proptest::sample::select(WaypointType::iter().collect::<Vec<_>>()),
        pattern in proptest::sample::select(HoldPattern::iter().collect::<Vec<_>>()),
    ) -> WaypointRecord {
        WaypointRecord { position, alt_cm, speed, duration_ds, kind, pattern }
    }
}

prop_compose! {
    fn plan_file()(
        name in "\\PC{0,6}[a-z<&\"\u{1}\r]\\PC{0,6}x",
        description in "[\\PC\n\r\t]{0,40}",
        home in option::of((place(), option::of(prop_oneof![(-500..9000).prop_map(f64::from), -500.0..9000.0]))),
        fence in option::of(0_u32..5000),
        settings in vec("[a-z_]{1,12} = [A-Z0-9.<&]{1,6}", 0..4),
        waypoints in vec(waypoint(), 1..=MAX_WAYPOINTS),
    ) -> PlanFile {
        let home = home.map(|(position, amsl_m)| HomePosition { position, amsl_m });
        let fence = fence.map(|metres| format!("ap_max_distance_from_home = {metres}"));
        let settings = settings.into_iter().chain(fence).collect();
        let mut plan = FlightPlan::default();
        plan.waypoints.extend(waypoints.into_iter().map(Waypoint::from));
        PlanFile { name, description, home, settings, plan, ..PlanFile::default() }
    }
}

fn back(contents: &[u8], format: Format) -> PlanFile {
    read("law", contents, format, &ReadOptions::default())
        .unwrap_or_else(|errors| panic!("{}\n{}", report(&errors), String::from_utf8_lossy(contents)))
}

proptest! {
    #[test]
    fn maps_carry_everything_but_what_the_findings_name(file in plan_file(), absolute in any::<bool>()) {
        for format in MAPS {
            let options = WriteOptions { absolute };
            let written = write_with(&file, format, &options);
            if written.is_refused() {
                prop_assert!(absolute && file.home.and_then(|home| home.amsl_m).is_none());
                continue;
            }
            let found = back(&written.contents, format);
            prop_assert_eq!(&found.plan, &file.plan);
            prop_assert_eq!(found.home, file.home);
            prop_assert!(found.losses.is_lossless(), "{:?}", found.losses);
            let named = |field: &str| {
                let findings = &written.losses.findings;
                findings.iter().any(|finding| finding.severity > Severity::Info && finding.field == field)
            };
            prop_assert_eq!(found.name != file.name, named("name"), "{:?}", file.name);
            prop_assert_eq!(found.description != file.description, named("description"), "{:?}", file.description);
            prop_assert_eq!(found.settings != file.settings, named("settings"));
            let again = write_with(&found, format, &options);
            prop_assert_eq!(&again.contents, &written.contents);
            prop_assert!(again.losses.findings.iter().all(|finding| written.losses.findings.contains(finding)));
            prop_assert_eq!(Format::from_contents(&written.contents), format);
            prop_assert!(read_features("law", &written.contents).is_ok());
        }
    }

    #[test]
    fn no_map_panics(
        file in plan_file(),
        at in any::<prop::sample::Index>(),
        noise in vec(any::<u8>(), 0..4),
        is_cut in any::<bool>(),
    ) {
        for format in MAPS {
            let mut contents = write_with(&file, format, &WriteOptions::default()).contents;
            let at = at.index(contents.len());
            if is_cut {
                contents.truncate(at);
            } else {
                contents.splice(at..(at + noise.len()).min(contents.len()), noise.iter().copied());
            }
            let errors = read("any", &contents, format, &ReadOptions::default()).err();
            prop_assert!(errors.is_none_or(|errors| !errors.is_empty()));
            let errors = read_features("any", &contents).err();
            prop_assert!(errors.is_none_or(|errors| !errors.is_empty()));
        }
    }
}

/// The number of waypoints of a file, its heaviest finding, and the number of its shapes on a map.
struct Sample {
    file: &'static str,
    options: ReadOptions,
    waypoints: usize,
    worst: Severity,
    shapes: usize,
}

fn samples() -> Vec<Sample> {
    let home: HomePosition = "40.4635,-79.5182,300".parse().expect("a home");
    let with_home = ReadOptions { home: Some(home), ..ReadOptions::default() };
    let sample = |file, options: &ReadOptions, waypoints, worst, shapes| Sample {
        file,
        options: options.clone(),
        waypoints,
        worst,
        shapes,
    };
    let ring = ReadOptions { ring: true, ..ReadOptions::default() };
    let track = ReadOptions { feature: Some("Morning".to_owned()), ..with_home.clone() };
    let plain = ReadOptions::default();
    vec![
        sample("google-earth.kml", &plain, 3, Severity::Assumed, 1),
        sample("google-earth-polygon.kml", &ring, 4, Severity::Assumed, 1),
        sample("google-earth-track.kml", &track, 3, Severity::Assumed, 1),
        sample("qgis.kml", &with_home, 3, Severity::Assumed, 1),
        sample("qgis.geojson", &plain, 3, Severity::Assumed, 2),
        sample("geojson-io.geojson", &plain, 2, Severity::Assumed, 2),
        sample("gpsbabel.gpx", &with_home, 3, Severity::Assumed, 1),
        sample("garmin.gpx", &with_home, 2, Severity::Assumed, 2),
        sample("litchi.kml", &plain, 3, Severity::Assumed, 4),
        sample("qgroundcontrol.kml", &with_home, 3, Severity::Assumed, 3),
        sample("qgroundcontrol.geojson", &plain, 2, Severity::Changed, 3),
    ]
}

#[test]
fn files_of_other_programs_are_read() {
    let folder = test_support::path("tests/exchange/maps");
    let samples = samples();
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), samples.len(), "a file without a row");
    for Sample { file, options, waypoints, worst, shapes } in samples {
        let contents = std::fs::read(folder.join(file)).unwrap();
        let (format, finding) = Format::detect(file, &contents);
        assert_eq!(finding, None, "{file}");
        let plan =
            read(file, &contents, format, &options).unwrap_or_else(|errors| panic!("{}", report(&errors)));
        assert_eq!(plan.plan.waypoints.len(), waypoints, "{file}");
        assert_eq!(plan.losses.worst(), Some(worst), "{file}: {:#?}", plan.losses);
        let features = read_features(file, &contents).unwrap();
        assert_eq!(features.len(), shapes, "{file}: {features:?}");
        assert!(features.iter().flat_map(Feature::vertices).all(|v| v.position.is_on_globe()));
        for format in MAPS {
            let written = write_with(&plan, format, &WriteOptions::default());
            assert_eq!(back(&written.contents, format).plan, plan.plan, "{file} to {format}");
        }
    }
}

#[test]
fn a_backdrop_shows_the_fence_of_a_plan_as_an_area() {
    let text = "name = 'x'\nsettings = ['ap_max_distance_from_home = 250']\n[home]\nlat_deg = 40.4635\n\
                lon_deg = -79.5182\n[[waypoint]]\ntype = 'LAND'\nlat_deg = 40.4635\nlon_deg = -79.5182\nalt_m = 20\n";
    let file = read("x.toml", text.as_bytes(), Format::Toml, &ReadOptions::default()).unwrap();
    for format in [Format::Kml, Format::Kmz, Format::GeoJson] {
        let written = write_with(&file, format, &WriteOptions::default());
        let features = read_features("x", &written.contents).unwrap();
        let fence = features.iter().find(|feature| feature.zone.is_some()).unwrap();
        let Shape::Area(rings) = &fence.shape else { panic!("{fence:?}") };
        assert_eq!((fence.name.as_str(), rings.len(), rings[0].len()), ("Fence", 1, 72), "{format}");
        let home = file.home.unwrap().position;
        for vertex in &rings[0] {
            let (distance_m, _) = betadeck::geo::distance_bearing(home, vertex.position);
            assert!((distance_m - 250.0).abs() < 0.1, "{distance_m}");
        }
    }
}
