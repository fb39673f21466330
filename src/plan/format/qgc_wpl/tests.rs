use proptest::prelude::*;

use super::super::mission_item::tests::{plan_file, used};
use super::super::{Format, parse, report, write as write_file};
use super::*;
use crate::plan::{Waypoint, WaypointType};

/// The example of the format.
const EXAMPLE: &str = "QGC WPL 110\n\
    0\t1\t0\t16\t0\t0\t0\t0\t40.4635000\t-79.5182000\t300.000000\t1\n\
    1\t0\t3\t22\t0\t0\t0\t0\t40.4635000\t-79.5182000\t10.000000\t1\n\
    2\t0\t3\t16\t0\t5\t0\t0\t40.4640000\t-79.5175000\t50.000000\t1\n\
    3\t0\t3\t19\t30\t0\t0\t0\t40.4630000\t-79.5190000\t50.000000\t1\n\
    4\t0\t3\t21\t0\t0\t0\t0\t40.4640000\t-79.5190000\t0.000000\t1\n";

fn read_text(text: &str) -> PlanFile {
    assert_eq!(Format::from_contents(text.as_bytes()), Format::QgcWpl);
    parse("square.waypoints", text, Format::QgcWpl).unwrap_or_else(|errors| panic!("{}", report(&errors)))
}

fn fault(text: &str) -> String {
    let errors = parse("x", text, Format::QgcWpl).unwrap_err();
    format!("{} | {}", errors[0].headline(), errors[0].hint)
}

#[test]
fn the_example_reads_and_prints_unchanged() {
    let file = read_text(EXAMPLE);
    assert_eq!(file.home.unwrap().to_string(), "40.4635000,-79.5182000,300");
    let kinds: Vec<_> = file.plan.waypoints.iter().map(|waypoint| waypoint.kind).collect();
    use WaypointType::{Flyover, Hold, Land, Takeoff};
    assert_eq!(kinds, [Takeoff, Flyover, Hold, Land]);
    assert_eq!((file.losses.items, file.losses.waypoints), (4, 4));
    let said: Vec<_> = file.losses.findings.iter().map(ToString::to_string).collect();
    assert_eq!(
        said,
        [
            "changed  WP 3 (item 4, line 6) altitude: 0 m → 50 m: the altitude of a MAVLink LAND is that of the ground"
        ]
    );
    let written = write_file(&file, Format::QgcWpl);
    assert_eq!(written.text(), EXAMPLE);
    assert!(written.losses.is_lossless(), "{:?}", written.losses);
}

#[test]
fn blanks_comments_and_line_ends_do_not_matter() {
    let loose = format!("\u{feff}# mine\r\n\r\n{}", EXAMPLE.replace('\t', "  ").replace('\n', "\r\n"));
    let loose = loose.trim_end().to_owned() + "\r\n# end";
    // The comment before the first line hides the format, so that the name gives it.
    let file = parse("square.waypoints", &loose, Format::QgcWpl).unwrap();
    assert_eq!(file.plan, read_text(EXAMPLE).plan);
    let nan = EXAMPLE.replace("19\t30\t0\t0\t0", "19\t30\tnan\tNaN\t0");
    assert_eq!(read_text(&nan).plan, file.plan);
}

#[test]
fn a_file_without_home_begins_with_a_waypoint() {
    let text = "QGC WPL 110\n0 1 3 22 0 0 0 0 1 2 10 1\n1 0 3 177 0 1 0 0 0 0 0 1\n";
    let file = read_text(text);
    assert_eq!((file.home, file.plan.waypoints.len()), (None, 2));
    let said = file.losses.findings[0].to_string();
    assert!(said.starts_with("assumed  home: the file does not begin with the home"), "{said}");
    assert_eq!(read_text("QGC WPL 110\n0 1 0 16 0 0 0 0 0 0 0 1\n").home, None);
    assert!(fault("QGC WPL 110\n0 1 0 22 0 0 0 0 1 2 310 1\n").contains("add --home"));
    let options = ReadOptions { home: Some("1,2,300".parse().unwrap()), ..ReadOptions::default() };
    let text = b"QGC WPL 110\n0 1 0 22 0 0 0 0 1 2 310 1\n";
    let file = super::super::read("x", text, Format::QgcWpl, &options).unwrap();
    assert!((file.plan.waypoints[0].altitude.above_home_m() - 10.0).abs() < 1e-9);
}

#[test]
fn wrong_files_give_one_sentence_with_its_place() {
    let line = |text: &str| format!("QGC WPL 110\n0 1 0 16 0 0 0 0 1 2 300 1\n{text}\n");
    for (text, sentence) in [
        ("QGC WPL 100\n0\t1", "x:1:1: QGC WPL 100 is an old format"),
        ("QGC WPL PB 110\n", "x:1:1: QGC WPL PB 110 is a format of another program"),
        ("", "x:1:1: the text is empty"),
        ("hello", "x:1:1: this is not a waypoint file"),
        (
            &line("1 0 3 5001 4 0 0 0 1 2 0 1\n2 0 3 5100 0 0 0 0 1 2 0 1"),
            "x:3:1: this is a fence, not a plan",
        ),
        (&line("1 0 3 5100 0 0 0 0 1 2 0 1"), "x:3:1: this is a list of rally points, not a plan"),
        (&line("1 0 3 16 0 0 0 0 1 2 50"), "x:3:1: the line has 11 fields"),
        (&line("1 0 3 16 0 0 0 0 1 2 50 1 7"), "x:3:1: the line has 13 fields"),
        (&line("1 0 3 16 0 0 0 0 91 2 50 1"), "x:3:1: item 1: latitude 91 is out of range"),
        (&line("1 0 3 16 0 0 0 0 nan 2 50 1"), "x:3:18: latitude nan is not a finite number"),
        (&line("1 0 3 16 inf 0 0 0 1 2 50 1"), "x:3:10: parameter 1 inf is not a finite number"),
        (&line("1 0 3 16 0 0 0 0 1 2 1e5 1"), "x:3:1: item 1: altitude 100000 is out of range"),
        (&line("1 0 3 16 0 0 0 0 40,5 2 50 1"), "x:3:18: latitude 40,5 has a decimal comma"),
        (&line("x 0 3 16 0 0 0 0 1 2 50 1"), "x:3:1: sequence number x is not a number"),
        (&line("1 0 3 -16 0 0 0 0 1 2 50 1"), "x:3:1: command -16 is out of range"),
        (&line("1 0 1 16 0 0 0 0 1 2 50 1"), "x:3:1: item 1: frame 1 is not one of a plan"),
    ] {
        let said = fault(text);
        assert!(said.starts_with(sentence), "{said}\n{sentence}");
    }
    let many = "QGC WPL 110\n".to_owned() + &"1 0 3 16 0 0 0 0 1 2 50 1\n".repeat(10_050);
    assert!(fault(&many).contains("more than 10000 items"));
    let many = "QGC WPL 110\n".to_owned() + &"1 0 3 16 0 0 0 0 1 2 50 1\n".repeat(500);
    assert!(fault(&many).contains("waypoint 30 does not fit: the file has 500"));
}

#[test]
fn an_implausible_home_costs_a_finding_not_the_plan() {
    let plan = "QGC WPL 110\n0 1 0 16 0 0 0 0 40.4635 -79.5182 29064.960852 1\n1 0 3 16 0 0 0 0 40.461 -79.5173 1.8288 1\n";
    for (text, line) in [
        (plan.to_owned(), "lost     line 2 home altitude: 29064.960852 m → unknown: allowed: -500 to 9000 m"),
        (
            plan.replace("40.4635", "140"),
            "lost     line 2 home: 140,-79.5182 → unknown: latitude 140 is out of range",
        ),
    ] {
        let file = read_text(&text);
        assert_eq!(file.plan.waypoints.len(), 1);
        let findings: Vec<String> = file.losses.findings.iter().map(ToString::to_string).collect();
        assert!(findings.iter().any(|finding| finding.starts_with(line)), "{findings:?}");
    }
}

#[test]
fn numbers_have_no_exponent() {
    for (value, text) in
        [(0.0, "0"), (1e-9, "0"), (0.25, "0.25"), (1e9, "1000000000"), (30.0, "30"), (-1.0, "-1")]
    {
        assert_eq!(short(value), text);
    }
}

#[test]
fn a_plan_without_home_is_refused() {
    let file = PlanFile { home: None, ..read_text(EXAMPLE) };
    let written = write_file(&file, Format::QgcWpl);
    assert!(written.is_refused() && written.contents.is_empty());
    assert!(written.losses.findings[0].why.contains("--home"));
}

/// Returns `true` if a finding above info names the field of the waypoint.
fn names(losses: &LossReport, index: usize, field: &str) -> bool {
    let named = |finding: &Finding| finding.waypoint == Some(index) && finding.field == field;
    losses.findings.iter().any(|finding| named(finding) && finding.severity > Severity::Info)
}

/// Checks that waypoints differ in the named fields only.
fn check_fields(losses: &LossReport, before: &[Waypoint], after: &[Waypoint]) -> Result<(), TestCaseError> {
    prop_assert_eq!(before.len(), after.len());
    for (index, (before, after)) in before.iter().zip(after).enumerate() {
        let (mut before, after) = (used(*before), used(*after));
        if names(losses, index, "speed") {
            before.speed = after.speed;
        }
        if names(losses, index, "altitude") {
            before.altitude = after.altitude;
        }
        if names(losses, index, "position") {
            before.position = after.position;
        }
        if names(losses, index, "pattern") {
            before.pattern = after.pattern;
        }
        if names(losses, index, "duration") {
            before.duration = after.duration;
        }
        prop_assert_eq!(before, after, "waypoint {}: {:?}", index, losses);
    }
    Ok(())
}

proptest! {
    #[test]
    fn the_findings_name_what_differs(file in plan_file()) {
        let written = write_file(&file, Format::QgcWpl);
        prop_assert!(!written.is_refused());
        let text = written.text().into_owned();
        prop_assert!(!text.contains('e') && !text.contains("nan"));
        let options = ReadOptions::default();
        match super::super::read("law", text.as_bytes(), Format::QgcWpl, &options) {
            // HOLD before a LAND and after a TAKEOFF can be too many.
            Err(errors) => prop_assert!(report(&errors).contains("does not fit")),
            Ok(back) => {
                if !written.losses.findings.iter().any(|finding| finding.field == "type") {
                    check_fields(&written.losses, &file.plan.waypoints, &back.plan.waypoints)?;
                }
                let again = write_file(&back, Format::QgcWpl);
                // The radii follow the settings, which are not in the file.
                if file.settings.is_empty() {
                    prop_assert_eq!(again.text(), written.text());
                }
                let twice = parse("law", &again.text(), Format::QgcWpl).unwrap();
                prop_assert_eq!(&twice.plan, &back.plan);
                prop_assert_eq!(twice.home, back.home);
                let fields = ["type", "speed", "altitude", "position", "pattern", "duration", "home"];
                let new = |finding: &&Finding| fields.contains(&finding.field.as_str()) && finding.severity > Severity::Info;
                let new: Vec<_> = again.losses.findings.iter().filter(new).collect();
                prop_assert!(new.is_empty(), "{:?}", new);
            }
        }
    }

    #[test]
    fn no_text_panics(lines in proptest::collection::vec("[-0-9. \tnaine,]{0,60}", 0..20)) {
        let _ = parse("any", &format!("QGC WPL 110\n{}", lines.join("\n")), Format::QgcWpl);
    }
}
