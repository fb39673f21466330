//! Every shipped plan is flown. The other ways to pass a plan are tested too.

use betadeck::plan::builtin::PLANS;
use betadeck::plan::format::{Format, parse};

use crate::binary::support::{Flown, Sandbox, plan, plans};

/// The guide's upload block.
const GUIDE: &str = include_str!("../../vectors/guide-step7.txt");

/// Returns the types of the positional waypoints that were reached, in order.
fn reached(flown: &Flown) -> Vec<&str> {
    flown.all("state").filter(|line| line.text("to") == "ARRIVED").map(|line| line.text("type")).collect()
}

#[test]
fn every_shipped_plan_flies_to_its_end() {
    let mut flown = 0;
    for entry in std::fs::read_dir(plans()).expect("the plans") {
        let path = entry.expect("a file").path();
        let name = path.file_name().and_then(|name| name.to_str()).expect("a plain name");
        let Some(format) = Format::from_file_name(name) else { continue };
        let text = std::fs::read_to_string(&path).expect("a readable plan");
        let file = parse(name, &text, format).unwrap_or_else(|errors| panic!("{errors:?}"));
        let flight = Sandbox::new().fly(&[&plan(name)]);
        assert_eq!(flight.code, Some(0), "{name}: {}", flight.err);
        let flight = flight.ends(0, "complete");
        assert_eq!(flight.first("disarmed").text("reason"), "LANDING", "{name}");
        let places = file.plan.waypoints.iter().filter(|waypoint| waypoint.kind.is_positional());
        let places: Vec<String> = places.map(|waypoint| waypoint.kind.to_string()).collect();
        assert_eq!(reached(&flight), places, "{name}");
        flown += 1;
    }
    assert!(flown >= 12, "only {flown} plans");
}

#[test]
fn the_guides_block_flies_with_the_guides_settings_as_the_demo_does() {
    let sandbox = Sandbox::new();
    let text = std::fs::read_to_string(plan("square.toml")).expect("the square");
    let square = parse("square.toml", &text, Format::Toml).expect("the square reads");
    let lines: String = square.settings.iter().map(|line| format!("set {line}\n")).collect();
    sandbox.write("settings.txt", &lines);
    let guide = plan("guide-square.txt");
    let from_text =
        sandbox.fly(&[&guide, "--settings", "settings.txt", "--noise", "none"]).ends(0, "complete");
    let built_in = sandbox.fly(&["square", "--noise", "none"]).ends(0, "complete");
    let states = |flown: &Flown| flown.all("state").cloned().collect::<Vec<_>>();
    assert_eq!(states(&from_text), states(&built_in));
}

#[test]
fn built_in_plans_go_by_name() {
    let by_name = Sandbox::new().fly(&["hold-none"]).ends(0, "complete");
    let by_file = Sandbox::new().fly(&[&plan("hold-none.toml")]).ends(0, "complete");
    assert_eq!(by_name.lines[..by_name.lines.len() - 1], by_file.lines[..by_file.lines.len() - 1]);
}

#[test]
fn the_built_in_plans_are_listed_by_the_names_that_other_commands_take() {
    let sandbox = Sandbox::new();
    let ran = sandbox.run(&["plan", "list"]).exits(0);
    let names: Vec<&str> = ran.out.lines().filter_map(|line| line.split_whitespace().next()).collect();
    let built_in: Vec<&str> = PLANS.iter().map(|plan| plan.name).collect();
    assert_eq!(names, built_in, "{}", ran.out);
    for (line, plan) in ran.out.lines().zip(PLANS) {
        let file = plan.read().expect("a built-in plan reads");
        let noun = if file.plan.waypoints.len() == 1 { "waypoint" } else { "waypoints" };
        let count = format!(" {} {noun} ", file.plan.waypoints.len());
        assert!(line.contains(&count) && line.ends_with(&file.description), "{line}");
        sandbox.run(&["plan", "show", plan.name]).exits(0);
    }
    assert_eq!(ran.err, "");
}

#[test]
fn an_endless_hold_ends_at_the_timeout() {
    let sandbox = Sandbox::new();
    let text = std::fs::read_to_string(plan("hold-orbit.toml")).expect("a plan");
    sandbox.write("endless.toml", &text.replace("duration_s = 45", "duration_s = 0"));
    let flown = sandbox.fly(&["endless.toml", "--timeout", "200", "--samples", "1"]).ends(1, "timeout");
    let end = flown.lines.last().expect("an end");
    assert!((end.time() - 200.0).abs() < 0.01);
    assert!(end.text("reason").contains("200 s") && end.text("reason").contains("ORBITING"), "{end:?}");
    let holding = flown.all("sample").next_back().expect("samples");
    assert_eq!(holding.number("hold_remaining_ds"), 65535.0);
}

#[test]
fn a_plan_without_a_landing_ends_parked() {
    let sandbox = Sandbox::new();
    sandbox.write("parked.txt", "waypoint insert 0 40.4637000 -79.5182000 1200 500 FLYOVER 0 ORBIT\n");
    let flown = sandbox.fly(&["parked.txt"]).ends(0, "complete");
    assert_eq!(flown.states(), ["APPROACHING 0", "ARRIVED 0", "COMPLETE 0"]);
    assert_eq!(flown.all("disarmed").count(), 0);
    let complete = flown.all("state").next_back().expect("states").time();
    assert!((flown.lines.last().expect("an end").time() - complete - 5.0).abs() < 0.1);
}

#[test]
fn the_guides_block_is_a_plan_unchanged_and_on_standard_input() {
    let sandbox = Sandbox::new();
    // As copied from a web page: no line end on the last line, and Windows line ends.
    sandbox.write("guide.txt", GUIDE.trim_end());
    sandbox.write("dos.txt", &GUIDE.replace('\n', "\r\n"));
    let from_file = sandbox.fly(&["guide.txt"]).ends(0, "complete");
    assert_eq!(reached(&from_file), ["FLYOVER", "FLYBY", "HOLD", "LAND"]);
    let from_dos = sandbox.fly(&["dos.txt"]).ends(0, "complete");
    let piped = sandbox.run_with(&["fly", "--json", "-", "-"], GUIDE).exits(0);
    let piped = crate::binary::lines::Line::read_all(&piped.out);
    for other in [&from_dos.lines, &piped] {
        let states = |lines: &[crate::binary::lines::Line]| -> Vec<crate::binary::lines::Line> {
            lines.iter().filter(|line| line.event() == "state").cloned().collect()
        };
        assert_eq!(states(other), states(&from_file.lines));
    }
    // A notice names the skipped lines.
    let notices: Vec<&str> = from_file.all("notice").map(|line| line.text("text")).collect();
    assert!(notices.iter().any(|text| text.contains("save")), "{notices:?}");
}

#[test]
fn a_far_plan_flies_where_it_lies_or_where_home_says() {
    let sandbox = Sandbox::new();
    let block = "waypoint insert 0 -33.8567000 151.2153000 1500 500 FLYOVER 0 ORBIT\n\
                 waypoint insert 1 -33.8565000 151.2153000 1500 500 LAND 0 ORBIT\n";
    sandbox.write("sydney.txt", block);
    let flown = sandbox.fly(&["sydney.txt", "--samples", "1"]).ends(0, "complete");
    let at = flown.first("sample");
    assert!((at.number("lat") + 33.8567).abs() < 1e-6 && (at.number("lon") - 151.2153).abs() < 1e-6);
    assert!(flown.all("notice").any(|line| line.text("text").contains("--home")));
    let near =
        sandbox.fly(&["sydney.txt", "--home", "-33.8568,151.2150,40", "--samples", "1"]).ends(0, "complete");
    assert!((near.first("sample").number("lon") - 151.2150).abs() < 1e-6);
    // A chosen home stays, and a notice gives its distance.
    let far = sandbox.fly(&["hold-none", "--home", "10,10", "--timeout", "5"]).ends(1, "timeout");
    assert!(far.all("notice").any(|line| line.text("text").contains(" km from home")), "{far:?}");
    // A home on the other side of the world, and a plan that crosses the date line.
    sandbox.write(
        "date-line.txt",
        "waypoint insert 0 -16.8000000 179.9998000 1500 500 FLYOVER 0 ORBIT\n\
         waypoint insert 1 -16.8000000 -179.9998000 1500 500 LAND 0 ORBIT\n",
    );
    let crossed = sandbox.fly(&["date-line.txt", "--home", "-16.8001,179.9998"]).ends(0, "complete");
    assert!(crossed.first("end").number("flown_s") < 120.0, "no detour round the world");
}

#[test]
fn a_mission_beyond_the_fence_is_refused_with_the_numbers() {
    let flown = Sandbox::new().fly(&["square", "--set", "ap_max_distance_from_home=50"]).ends(1, "refused");
    let refused = flown.first("engage_refused");
    assert_eq!((refused.text("reason"), refused.number("wp")), ("GEOFENCE", 0.0));
    assert!(refused.text("text").contains("50 m"), "{refused:?}");
    assert_eq!(flown.all("state").count(), 0);
}
