//! The shipped plans: all can be read, are canonical, are listed in `plans/README.md` and are part of the executable.

use std::path::PathBuf;

use betadeck::plan::WaypointType;
use betadeck::plan::builtin::{BuiltinPlan, PLANS};
use betadeck::plan::estimate::{Assumptions, estimate};
use betadeck::plan::format::{Format, PlanFile, parse, report, write};
use betadeck::plan::review::review;
use strum::IntoEnumIterator as _;

fn folder() -> PathBuf {
    test_support::path("plans")
}

/// Returns the file name, text, format and contents of every plan in the folder.
fn plans() -> Vec<(String, String, Format, PlanFile)> {
    let mut plans = Vec::new();
    for entry in std::fs::read_dir(folder()).expect("the plans folder") {
        let path = entry.expect("a folder entry").path();
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        let Some(format) = Format::from_file_name(&name) else { continue };
        let text = std::fs::read_to_string(&path).expect("a readable plan");
        let file = parse(&name, &text, format).unwrap_or_else(|errors| panic!("{}", report(&errors)));
        plans.push((name, text, format, file));
    }
    assert!(plans.len() > PLANS.len(), "the built-in plans and the guide's text: {}", plans.len());
    plans
}

#[test]
fn every_plan_is_listed_in_the_readme() {
    let readme = std::fs::read_to_string(folder().join("README.md")).expect("plans/README.md");
    for (name, ..) in plans() {
        assert!(readme.contains(&format!("`{name}`")), "{name} is missing in plans/README.md");
    }
    for row in readme.lines().filter_map(|line| line.strip_prefix("| `")) {
        let file = row.split('`').next().unwrap_or_default();
        let of_lab = file.strip_prefix("lab-").map(|name| format!("lab/{name}.toml"));
        let places = [file.to_owned(), format!("scenarios/{file}.toml")].into_iter().chain(of_lab);
        let is_there = places.map(|place| folder().join(place)).any(|path| path.exists());
        assert!(is_there, "plans/README.md lists {file}, which does not exist");
    }
}

#[test]
fn every_toml_plan_is_canonical_and_built_in() {
    for (name, text, format, file) in plans() {
        if format == Format::Toml {
            assert_eq!(write(&file, format).text(), text, "{name} is not in canonical form");
            let plan = BuiltinPlan::find(&file.name).unwrap_or_else(|| panic!("{name} is not built in"));
            assert_eq!(plan.text, text);
            assert_eq!(format!("{}.toml", file.name), name);
        }
    }
}

#[test]
fn every_plan_starts_at_the_default_home_and_every_type_is_shown() {
    let home = "40.4635,-79.5182,300".parse().ok();
    let plans = plans();
    for (name, _, format, file) in &plans {
        assert!(!file.plan.waypoints.is_empty(), "{name} is empty");
        assert!(*format == Format::CliText || file.home == home, "{name}");
    }
    for kind in WaypointType::iter() {
        let shown =
            plans.iter().any(|plan| plan.3.plan.waypoints.iter().any(|waypoint| waypoint.kind == kind));
        assert!(shown, "no plan shows {kind}");
    }
}

#[test]
fn the_guides_text_and_the_square_are_the_same_plan() {
    let text = std::fs::read_to_string(folder().join("guide-square.txt")).expect("the guide's block");
    let guide = parse("guide-square.txt", &text, Format::CliText).expect("the guide's block reads");
    let square = BuiltinPlan::find("square").expect("the demo").read().expect("the demo reads");
    assert_eq!(guide.plan, square.plan);
    assert_eq!(square.settings.len(), 24);
    assert!(square.settings.contains(&"ap_position_cutoff = 5".to_owned()));
}

#[test]
fn the_example_in_the_readme_reads() {
    let readme = std::fs::read_to_string(folder().join("README.md")).expect("plans/README.md");
    let example = readme.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next());
    let file = parse("example.toml", example.expect("an example"), Format::Toml)
        .unwrap_or_else(|errors| panic!("{}", report(&errors)));
    assert_eq!((file.name.as_str(), file.plan.waypoints.len()), ("example", 2));
}

#[test]
fn every_plan_is_flyable_and_short() {
    let home: betadeck::plan::format::HomePosition =
        "40.4635,-79.5182,300".parse().expect("the default home");
    for (name, _, _, file) in plans() {
        let assumptions = Assumptions::from_settings(&file.settings);
        assert_eq!(review(&file.plan, home.position, &assumptions), [], "{name}");
        let estimate = estimate(&file.plan, home.position, &assumptions);
        assert!(
            estimate.time_s.is_some_and(|seconds| (10.0..300.0).contains(&seconds)),
            "{name}: {estimate:?}"
        );
    }
}
