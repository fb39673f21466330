//! Laws of the plan formats: a written plan reads back, canonical text prints unchanged, and no text causes a panic.

use betadeck::geo::LatLon;
use betadeck::plan::WaypointRecord;
use betadeck::plan::format::{Format, HomePosition, PlanFile, degrees_e7, parse, report, write};
use betadeck::plan::{FlightPlan, HoldPattern, MAX_WAYPOINTS, Waypoint, WaypointType};
use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;
use strum::IntoEnumIterator as _;

fn place() -> impl Strategy<Value = LatLon> {
    (-900_000_000..=900_000_000, -1_800_000_000..=1_800_000_000).prop_map(|(lat, lon)| LatLon::new(lat, lon))
}

prop_compose! {
    fn waypoint()(
        position in prop_oneof![Just(LatLon::default()), place()],
        alt_cm in any::<i32>(),
        speed in any::<u16>(),
        duration_ds in any::<u16>(),
        kind in proptest::sample::select(WaypointType::iter().collect::<Vec<_>>()),
        pattern in proptest::sample::select(HoldPattern::iter().collect::<Vec<_>>()),
    ) -> WaypointRecord {
        WaypointRecord { position, alt_cm, speed, duration_ds, kind, pattern }
    }
}

prop_compose! {
    fn plan_file()(
        name in "\\PC{1,12}",
        description in "\\PC{0,40}",
        home in option::of((place(), option::of(-500..9000))),
        settings in vec("[a-z_]{1,12} = [A-Z0-9.]{1,6}", 0..4),
        waypoints in vec(waypoint(), 0..=MAX_WAYPOINTS),
    ) -> PlanFile {
        let home = home.map(|(position, amsl)| HomePosition { position, amsl_m: amsl.map(f64::from) });
        let mut plan = FlightPlan::default();
        plan.waypoints.extend(waypoints.into_iter().map(Waypoint::from));
        PlanFile { name, description, home, settings, plan, ..PlanFile::default() }
    }
}

fn read(text: &str, format: Format) -> PlanFile {
    parse("law", text, format).unwrap_or_else(|errors| panic!("{}\n{text}", report(&errors)))
}

/// Generates lines that are nearly waypoint lines.
fn nearly_a_line() -> impl Strategy<Value = String> {
    let word = prop_oneof![
        Just("waypoint".to_owned()),
        Just("insert".to_owned()),
        Just("remove".to_owned()),
        Just("FLYBY".to_owned()),
        "[-+0-9.m]{0,8}",
        "\\PC{0,6}",
    ];
    vec(word, 0..12).prop_map(|words| words.join(" "))
}

#[test]
fn every_format_has_a_row_on_its_page() {
    let page = include_str!("../../../docs/exchange.md");
    let rows: Vec<&str> = page.lines().filter(|line| line.starts_with("| `")).collect();
    for format in Format::iter() {
        let info = format.info();
        let name = format!("`{format}`");
        let row = rows.iter().find(|row| row.contains(&name)).unwrap_or_else(|| panic!("{name} has no row"));
        for extension in info.extensions {
            assert!(row.contains(&format!("`.{extension}`")), "{name}: .{extension} is missing");
        }
        assert_eq!(row.contains("read only"), !info.writes, "{name}");
    }
}

proptest! {
    #[test]
    fn toml_carries_everything(file in plan_file()) {
        let written = write(&file, Format::Toml);
        prop_assert!(written.losses.findings.is_empty());
        let back = read(&written.text(), Format::Toml);
        prop_assert_eq!(&back, &file);
        prop_assert_eq!(write(&back, Format::Toml).contents, written.contents);
    }

    #[test]
    fn a_record_survives_the_way_through_si(record in waypoint()) {
        prop_assert_eq!(WaypointRecord::from(Waypoint::from(record)), record);
    }

    #[test]
    fn text_carries_the_waypoints(file in plan_file()) {
        let written = write(&file, Format::CliText);
        let back = read(&written.text(), Format::CliText);
        prop_assert_eq!(&back.plan, &file.plan);
        let again = write(&back, Format::CliText);
        prop_assert_eq!(again.contents, written.contents);
        prop_assert!(again.losses.findings.is_empty());
    }

    #[test]
    fn crlf_and_lf_read_the_same(file in plan_file()) {
        for format in [Format::Toml, Format::CliText] {
            let text = write(&file, format).text().into_owned();
            prop_assert_eq!(read(&text.replace('\n', "\r\n"), format), read(&text, format));
        }
    }

    #[test]
    fn no_text_panics_and_every_problem_has_a_place(text in "\\PC{0,200}|(.|\n){0,300}") {
        for format in [Format::Toml, Format::CliText] {
            if let Err(errors) = parse("any", &text, format) {
                let lines = text.split(['\n', '\r']).count();
                prop_assert!(!errors.is_empty());
                for error in errors {
                    prop_assert!((1..=lines).contains(&error.line) && error.column >= 1, "{error}");
                }
            }
        }
    }

    #[test]
    fn nearly_right_lines_do_not_panic(lines in vec(nearly_a_line(), 0..50)) {
        if let Ok(file) = parse("any", &lines.join("\n"), Format::CliText) {
            prop_assert!(file.plan.waypoints.len() <= MAX_WAYPOINTS);
        }
    }

    #[test]
    fn degrees_read_what_they_print(value in any::<i32>(), cut in "[0-9]{0,5}") {
        let text = format!("{}{cut}", betadeck::geo::Degrees7(value));
        // The lowest i32 has no positive counterpart, but it is a valid value.
        prop_assert_eq!(degrees_e7(&text), Some(value));
    }
}
