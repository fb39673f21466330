//! `convert` and the other commands with the files of other programs.

use crate::binary::support::Sandbox;

/// A plan as QGroundControl writes it: take-off, a waypoint, a camera action, a turn around a point, a landing.
const PLAN: &str = include_str!("../../exchange/square.plan");

/// Converts `square` to each format that is written, and returns the names of the files.
fn written(sandbox: &Sandbox) -> Vec<String> {
    let list = sandbox.run(&["convert", "--list"]);
    assert_eq!(list.code, Some(0), "{}", list.err);
    let formats: Vec<String> = list
        .out
        .lines()
        .filter(|line| line.contains("read, write"))
        .filter_map(|line| line.split_whitespace().next().map(str::to_owned))
        .collect();
    assert!(formats.len() >= 10, "{}", list.out);
    formats
        .into_iter()
        .map(|format| {
            let name = format!("square.{format}");
            let ran = sandbox.run(&["convert", "square", &name, "--to", &format]);
            assert_eq!(ran.code, Some(0), "{format}: {}", ran.err);
            name
        })
        .collect()
}

#[test]
fn every_format_that_is_written_is_read_and_flown() {
    let sandbox = Sandbox::new();
    for name in written(&sandbox) {
        let format = name.trim_start_matches("square.");
        let home = "40.4635,-79.5182,300";
        let ran = sandbox.run(&["convert", &name, "back.toml", "--force", "--from", format, "--home", home]);
        assert_eq!(ran.code, Some(0), "{name}: {}", ran.err);
        let flown = sandbox.fly(&["back.toml", "--home", home, "--noise", "none"]);
        assert_eq!(flown.code, Some(0), "{name}: {}", flown.err);
    }
}

#[test]
fn a_plan_of_another_program_is_flown_as_it_is() {
    let sandbox = Sandbox::new();
    sandbox.write("theirs.plan", PLAN);
    let flown = sandbox.run(&["fly", "theirs.plan", "--noise", "none"]);
    assert_eq!(flown.code, Some(0), "{}", flown.err);
    assert!(flown.out.contains("camera (command 2000): 1 item"), "{}", flown.out);
    let piped = sandbox.run_with(&["plan", "show", "-"], PLAN);
    assert_eq!(piped.code, Some(0), "{}", piped.err);
    assert!(piped.out.contains("HOLD ORBIT"), "{}", piped.out);
    sandbox.write("test.toml", "format = 1\nname = 'theirs'\n[plan]\nfile = 'theirs.plan'\n");
    let checked = sandbox.run(&["check", "test.toml"]);
    assert_ne!(checked.code, Some(2), "{}", checked.err);
    assert!(checked.err.contains("theirs.plan: info     camera"), "{}", checked.err);
}

#[test]
fn the_report_names_each_difference_and_strict_makes_it_the_exit_code() {
    let sandbox = Sandbox::new();
    let ran = sandbox.run(&["convert", "square", "square.txt", "--strict"]);
    assert_eq!(ran.code, Some(1), "{}", ran.err);
    assert!(ran.err.contains("lost     home: "), "{}", ran.err);
    assert!(ran.err.lines().last().is_some_and(|line| line.contains("waypoints") && line.contains(" lost")));
    let ran = sandbox.run(&["convert", "square", "square.toml", "--strict"]);
    assert_eq!((ran.code, ran.err.contains("nothing is lost")), (Some(0), true), "{}", ran.err);
    let ran = sandbox.run(&["convert", "square", "square.txt", "--force", "--json"]);
    let report: serde_json::Value = serde_json::from_str(&ran.out).expect("one object");
    assert_eq!(
        (&report["format"], &report["from"], &report["to"]),
        (&1.into(), &"toml".into(), &"txt".into())
    );
    assert_eq!(report["findings"][0]["severity"], "info");
    assert!(report["summary"]["lost"].as_u64() >= Some(1), "{report}");
}

#[test]
fn a_write_that_fails_leaves_the_file_that_was_to_be_replaced() {
    let sandbox = Sandbox::new();
    assert_eq!(sandbox.run(&["convert", "square", "square.plan"]).code, Some(0));
    let before = sandbox.read("square.plan");
    let program = crate::binary::support::PROGRAM;
    // A write beyond the limit of the size of a file fails, as on a full disk.
    let script = format!("trap '' XFSZ; ulimit -f 1; {program} convert flyby square.plan --force");
    let ran = std::process::Command::new("/bin/sh")
        .args(["-c", &script])
        .envs(sandbox.environment())
        .current_dir(sandbox.path("."))
        .output()
        .expect("a shell");
    assert_eq!(ran.status.code(), Some(3), "{}", String::from_utf8_lossy(&ran.stderr));
    assert_eq!(sandbox.read("square.plan"), before);
}

#[test]
fn a_file_that_cannot_be_taken_is_refused_with_its_place_and_nothing_is_written() {
    let sandbox = Sandbox::new();
    for (name, text, reported) in [
        ("bad.plan", PLAN.replace("40.464,", "91,"), "latitude 91"),
        ("bad.plan", "{\"fileType\":\"Plan\",\"fileType\":\"Plan\"}".to_owned(), "is there twice"),
        ("bad.gpx", "<!DOCTYPE a [<!ENTITY b \"c\">]><gpx/>".to_owned(), "document type"),
        ("bad.kml", "<kml>".repeat(100), "nested deeper"),
        ("bad.waypoints", "QGC WPL 100\n".to_owned(), "100"),
        ("bad.csv", "type,lat_deg,lon_deg\nFLYBY,40\u{2c}5;3\n".to_owned(), "bad.csv"),
        ("bad.geojson", "{\"type\":\"Point\",\"coordinates\":[1e999,2]}".to_owned(), "bad.geojson"),
    ] {
        sandbox.write(name, &text);
        let ran = sandbox.run(&["convert", name, "out.toml"]);
        assert_eq!(ran.code, Some(2), "{name}: {}", ran.err);
        assert!(ran.err.contains(reported) && ran.err.contains(name), "{name}: {}", ran.err);
        assert!(!sandbox.path("out.toml").exists());
    }
}

#[test]
fn a_format_without_a_home_needs_one_for_altitudes_above_sea_level() {
    let sandbox = Sandbox::new();
    sandbox.write(
        "route.gpx",
        "<gpx><rte><rtept lat='40.464' lon='-79.518'><ele>320</ele></rtept>\
         <rtept lat='40.465' lon='-79.518'><ele>320</ele></rtept></rte></gpx>",
    );
    let ran = sandbox.run(&["convert", "route.gpx", "route.toml"]);
    assert_eq!(ran.code, Some(2), "{}", ran.err);
    assert!(ran.err.contains("--home LAT,LON,AMSL"), "{}", ran.err);
    let shown = sandbox.run(&["fly", "route.gpx", "--home", "40.4635,-79.5182,300", "--timeout", "60"]);
    assert_ne!(shown.code, Some(2), "{}", shown.err);
    let ran = sandbox.run(&["convert", "route.gpx", "route.toml", "--home", "40.4635,-79.5182,300"]);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    assert!(sandbox.read("route.toml").contains("alt_m = 20\n"), "{}", sandbox.read("route.toml"));
}

#[test]
fn a_file_with_75_waypoints_is_shown_simplified_and_split_and_not_flown() {
    let sandbox = Sandbox::new();
    let line = |index: u32| {
        let east = index % 2;
        format!("waypoint insert {index} 40.46{index:02}000 -79.51820{east}0 3000 0 FLYBY 0 NONE\n")
    };
    sandbox.write("long.txt", &(0..75).map(line).collect::<String>());
    let shown = sandbox.run(&["plan", "show", "long.txt"]).exits(2).out;
    assert!(
        shown.starts_with("75 waypoints, 0.82 km in all: a plan holds at most 30, so 3 parts"),
        "{shown}"
    );
    assert!(shown.contains("long 1\n") && shown.contains("\n17 waypoints, "), "{shown}");
    for command in
        [&["fly", "long.txt"][..], &["check", "--new", "long.txt"], &["convert", "long.txt", "x.toml"]]
    {
        let ran = sandbox.run(command).exits(2);
        assert!(ran.err.contains("75") && ran.err.contains("--simplify METRES"), "{command:?}: {}", ran.err);
        assert!(ran.err.contains("with --split it writes several plans"), "{command:?}: {}", ran.err);
    }
    sandbox.run(&["convert", "long.txt", "near.toml", "--simplify", "2"]).exits(0);
    assert_eq!(sandbox.read("near.toml").matches("[[waypoint]]").count(), 2);
    sandbox.run(&["convert", "long.txt", "part.toml", "--split"]).exits(0);
    let part = |number: u32| sandbox.read(&format!("part-{number}.toml"));
    let counts = [1, 2, 3].map(|number| part(number).matches("[[waypoint]]").count());
    assert_eq!(counts, [30, 30, 17]);
    assert!(part(1).contains("40.4629000") && part(2).contains("40.4629000"), "the joint is in both");
    sandbox.run(&["plan", "show", "part-2.toml"]).exits(0);
    std::fs::remove_file(sandbox.path("part-1.toml")).expect("removed");
    let ran = sandbox.run(&["convert", "long.txt", "part.toml", "--split"]).exits(3);
    assert!(ran.err.contains("part-2.toml exists"), "{}", ran.err);
    assert!(!sandbox.path("part-1.toml").exists(), "all parts are written, or none");
    let one = ["convert", "part-2.toml", "one.txt", "--split"];
    sandbox.run(&one).exits(0);
    assert!(sandbox.path("one.txt").exists(), "a plan that fits is one file");
}
