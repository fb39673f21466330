//! Scenarios in the executable: the output, files and exit codes of `check`, and `open`.
#![allow(clippy::disallowed_methods, reason = "a program that waits for changes is waited for")]

use std::io::{BufRead as _, BufReader, Read as _};
use std::process::{Child, Stdio};

use serde_json::Value;

use crate::binary::support::Sandbox;

/// A scenario whose craft stays on the ground for two seconds.
const STANDING: &str = "format = 1
description = \"Stands\"
ends = \"2 s after boot\"
[plan]
builtin = \"square\"
[craft]
pilot = \"none\"
[air]
noise = \"none\"
[[expect]]
from = \"boot\"
always = \"altitude in -1..1 m\"
";

/// Returns the same scenario with another bound.
fn standing(bound: &str) -> String {
    STANDING.replace("-1..1 m", bound)
}

/// A process that is killed when its test ends.
struct Guard(Child);

impl Drop for Guard {
    fn drop(&mut self) {
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

fn spawn(sandbox: &Sandbox, arguments: &[&str]) -> Guard {
    let mut command = sandbox.command(arguments);
    Guard(
        command
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("it starts"),
    )
}

fn interrupt(child: &Guard) {
    let id = child.0.id().to_string();
    assert!(std::process::Command::new("kill").args(["-s", "INT", &id]).status().expect("kill").success());
}

fn json(text: &str) -> Vec<Value> {
    text.lines()
        .map(|line| serde_json::from_str(line).unwrap_or_else(|error| panic!("{error}: {line}")))
        .collect()
}

#[test]
fn a_scenario_that_passes_prints_a_line_with_its_tightest_margin() {
    let sandbox = Sandbox::new();
    sandbox.write("calm.toml", STANDING);
    let ran = sandbox.run(&["check", "calm.toml"]).exits(0);
    let lines: Vec<&str> = ran.out.lines().collect();
    assert_eq!(
        lines[0],
        "✓ calm: stopped, tightest: always altitude in -1..1 m, from boot (0.000 m, -1.00 m to 1.00 m, 100 % left)"
    );
    assert!(lines[1].starts_with("1 of 1 flight passed; 2.0 s flown in "), "{}", ran.out);
    assert_eq!(lines.len(), 2);
}

#[test]
fn a_scenario_that_fails_says_where_what_and_how_to_look_at_it() {
    let sandbox = Sandbox::new();
    sandbox.write("low.toml", &standing("2..3 m"));
    sandbox.write("calm.toml", STANDING);
    let ran = sandbox.run(&[
        "check",
        "low.toml",
        "calm.toml",
        "--junit",
        "report.xml",
        "--markdown",
        "summary.md",
        "--json",
        "out.json",
    ]);
    let ran = ran.exits(1);
    for part in [
        "✗ low: stopped, the scenario ended the flight",
        "line 12: always altitude in 2..3 m, from boot: 0.000 m, 2.00 m to 3.00 m at ",
        "      betadeck open low.toml --at boot+",
        "✓ calm: stopped",
        "1 of 2 flights passed",
    ] {
        assert!(ran.out.contains(part), "{part}\n{}", ran.out);
    }
    let xml = sandbox.read("report.xml");
    for part in [
        "<testsuites name=\"betadeck\" tests=\"2\" failures=\"1\"",
        "<testcase classname=\"low\" name=\"flight seed 1\"",
        "<failure message=\"always altitude in 2..3 m, from boot: 0.000 m",
        "<testcase classname=\"calm\" name=\"flight seed 1\" time=\"",
        "</testsuites>",
    ] {
        assert!(xml.contains(part), "{part}\n{xml}");
    }
    let summary = sandbox.read("summary.md");
    for part in [
        "### ❌ Some flights failed",
        "| ❌ low | 0 of 1 |",
        "| ✅ calm | 1 of 1 |",
        "`betadeck open low.toml --at",
    ] {
        assert!(summary.contains(part), "{part}\n{summary}");
    }
    let lines = json(&sandbox.read("out.json"));
    assert_eq!(lines.len(), 3);
    assert_eq!((&lines[0]["event"], &lines[0]["passed"]), (&"flight".into(), &false.into()));
    assert_eq!(lines[0]["expectations"][1]["outcome"], "failed");
    assert_eq!(lines[1]["expectations"][1]["outcome"], "met");
    assert_eq!((&lines[2]["event"], &lines[2]["flights_passed"]), (&"summary".into(), &1.into()));
}

#[test]
fn a_mistake_in_a_scenario_is_reported_with_its_place_and_nothing_is_flown() {
    let sandbox = Sandbox::new();
    sandbox.write("typo.toml", &STANDING.replace("always", "alwais"));
    sandbox.write("unit.toml", &standing("-1..1 s"));
    let ran = sandbox.run(&["check", "typo.toml", "unit.toml", "--junit", "report.xml"]).exits(2);
    assert_eq!(ran.out, "");
    for part in ["typo.toml:12:1: alwais is not a key of expect", "did you mean always?", "unit.toml:12:"] {
        assert!(ran.err.contains(part), "{part}\n{}", ran.err);
    }
    assert!(!sandbox.path("report.xml").exists());
    let ran = sandbox.run(&["check", "guide-11"]).exits(2);
    assert!(ran.err.contains("did you mean guide-1?"), "{}", ran.err);
    sandbox.run(&["check", "missing.toml"]).exits(3);
    sandbox.run(&["check", "typo.toml", "--seeds", "5..1"]).exits(2);
}

#[test]
fn folders_standard_input_lists_and_filters_choose_what_is_flown() {
    let sandbox = Sandbox::new();
    std::fs::create_dir(sandbox.path("tests")).expect("a folder");
    sandbox.write("tests/b.toml", STANDING);
    sandbox.write("tests/a.toml", &format!("{STANDING}[[case]]\nname = \"one\"\n[[case]]\nname = \"two\"\n"));
    sandbox.write("tests/plan.toml", "name = \"a plan, no scenario\"\n");
    let ran = sandbox.run(&["check", "tests"]).exits(0);
    let names: Vec<&str> =
        ran.out.lines().filter_map(|line| line.strip_prefix("✓ ")?.split(':').next()).collect();
    assert_eq!(names, ["a · one", "a · two", "b"]);
    let ran = sandbox.run(&["check", "tests", "--filter", "a two"]).exits(0);
    assert!(ran.out.contains("1 of 1 flight passed"), "{}", ran.out);
    sandbox.run(&["check", "tests", "--filter", "three"]).exits(2);
    let ran = sandbox.run(&["check", "tests", "--list"]).exits(0);
    assert_eq!(ran.out, "a: Stands\n    one\n    two\nb: Stands\n    one case\n");
    let ran = sandbox.run_with(&["check", "-"], STANDING).exits(0);
    assert!(ran.out.starts_with("✓ standard input: stopped"), "{}", ran.out);
    let ran = sandbox.run(&["check", "--list"]).exits(0);
    for name in ["guide-1: ", "guide-8: ", "(slow)"] {
        assert!(ran.out.contains(name), "{name}\n{}", ran.out);
    }
}

#[test]
fn a_comparison_of_cases_without_a_common_seed_fails() {
    let sandbox = Sandbox::new();
    let text = format!(
        "{STANDING}[[measure]]\nname = \"far\"\nmax = \"altitude\"\nfrom = \"boot\"\n\
         [[case]]\nname = \"calm\"\nseeds = 1\n[[case]]\nname = \"pilot's wind\"\nseeds = 2\n\
         [[compare]]\nthat = \"pilot's wind.far - calm.far <= 1 m\"\n"
    );
    sandbox.write("seeds.toml", &text);
    let ran = sandbox.run(&["check", "seeds.toml", "--junit", "report.xml"]).exits(1);
    assert!(ran.out.contains("never judged, no seed was flown by all the cases"), "{}", ran.out);
    let report = std::fs::read_to_string(sandbox.path("report.xml")).expect("a report");
    assert!(report.contains("tests=\"3\" failures=\"1\""), "{report}");
    // There is no such message for a single one of them or for one seed shared by all.
    sandbox.run(&["check", "seeds.toml", "--filter", "calm"]).exits(0);
    let ran = sandbox.run(&["check", "seeds.toml", "--seeds", "4"]).exits(0);
    assert!(ran.out.contains("✓ seeds · seed 4: pilot's wind.far"), "{}", ran.out);
}

#[test]
fn a_scenario_without_a_format_in_a_folder_is_not_passed_over() {
    let sandbox = Sandbox::new();
    std::fs::create_dir(sandbox.path("tests")).expect("a folder");
    sandbox.write("tests/a.toml", &format!("\u{feff}{STANDING}"));
    sandbox.run(&["check", "tests"]).exits(0);
    sandbox.write("tests/b.toml", &STANDING.replace("format = 1\n", ""));
    let ran = sandbox.run(&["check", "tests"]).exits(2);
    assert!(ran.err.contains("format is missing"), "{}", ran.err);
}

#[test]
fn repetitions_are_the_same_to_the_last_bit() {
    let sandbox = Sandbox::new();
    sandbox.write("real.toml", &STANDING.replace("\"none\"\n[[", "\"real\"\n[["));
    let ran =
        sandbox.run(&["check", "real.toml", "--repeat", "5", "--seeds", "3..4", "--json", "-"]).exits(0);
    let lines = json(&ran.out);
    assert_eq!(lines.len(), 11);
    let hashes: Vec<&str> = lines[..10].iter().map(|line| line["hash"].as_str().expect("a hash")).collect();
    assert!(
        hashes[..5].iter().all(|hash| *hash == hashes[0])
            && hashes[5..].iter().all(|hash| *hash == hashes[5])
    );
    assert_ne!(hashes[0], hashes[5], "another seed is another flight");
    assert_eq!(lines[10]["cases"][0]["flights"], 10);
}

#[test]
fn more_than_ten_thousand_flights_are_flown_only_when_they_were_asked_for() {
    let sandbox = Sandbox::new();
    let noisy = STANDING.replace("noise = \"none\"", "noise = \"real\"");
    sandbox.write(
        "many.toml",
        &format!("seeds = \"1..6000\"\n{noisy}[[case]]\nname = \"a\"\n[[case]]\nname = \"b\"\n"),
    );
    sandbox.write("six-thousand.toml", &format!("seeds = \"1..6000\"\n{noisy}"));
    let outcome = sandbox.run(&["check", "many.toml"]).exits(2);
    for part in
        ["many.toml:1:9: the scenario has 12000 flights", "^^^^^^^^^ allowed: 10000", "--max-flights 12000"]
    {
        assert!(outcome.err.contains(part), "{part}\n{}", outcome.err);
    }
    // The scenario alone is small enough.
    let outcome = sandbox.run(&["check", "six-thousand.toml", "--repeat", "2"]).exits(2);
    let sentence = "the run has 12000 flights, and 10000 are allowed: choose fewer with --filter TEXT, --seeds A..B or a \
                    smaller --repeat, or add --max-flights 12000";
    assert!(outcome.err.contains(sentence), "{}", outcome.err);
    let outcome = sandbox.run(&["check", "many.toml", "--max-flights", "12000", "--filter", "nothing of it"]);
    assert!(outcome.err.contains("no flight has nothing of it in its name"), "{}", outcome.err);
    let outcome = sandbox.run(&["check", "six-thousand.toml", "--max-flights", "3", "--seeds", "1..4"]);
    assert!(outcome.err.contains("the scenario has 4 flights"), "{}", outcome.err);
    sandbox.run(&["check", "six-thousand.toml", "--max-flights", "4", "--seeds", "1..4"]).exits(0);
}

#[test]
fn an_expression_of_twelve_thousand_terms_is_refused_with_its_place() {
    let sandbox = Sandbox::new();
    let sum = vec!["altitude"; 12_000].join(" + ");
    sandbox.write("long.toml", &format!("{STANDING}[[expect]]\nmax = \"{sum} <= 9 m\"\n"));
    let outcome = sandbox.run(&["check", "long.toml"]).exits(2);
    let place = format!("long.toml:14:{}: this expression has too many terms", 8 + 11 * 1000);
    for part in [place.as_str(), "^^^^^^^^ allowed: 1000 terms; use measures for parts of it"] {
        assert!(outcome.err.contains(part), "{part}\n{}", outcome.err);
    }
}

#[test]
fn fail_fast_ends_at_the_first_failure() {
    let sandbox = Sandbox::new();
    sandbox.write("a.toml", &standing("2..3 m"));
    sandbox.write("b.toml", STANDING);
    let ran = sandbox
        .run(&["check", "a.toml", "b.toml", "b.toml", "b.toml", "--fail-fast", "--jobs", "1"])
        .exits(1);
    assert!(ran.out.contains("were not flown"), "{}", ran.out);
}

#[test]
fn an_interrupted_run_prints_what_is_done() {
    let sandbox = Sandbox::new();
    sandbox.write("a.toml", STANDING);
    let endless = STANDING.replace("2 s after boot", "900000 s after boot");
    sandbox.write("b.toml", &format!("time_limit_s = 1000000\nsample_hz = 0.1\n{endless}"));
    let mut child = spawn(&sandbox, &["check", "a.toml", "b.toml", "--junit", "report.xml"]);
    let mut reader = BufReader::new(child.0.stdout.take().expect("standard output"));
    let mut text = String::new();
    reader.read_line(&mut text).expect("the first flight");
    interrupt(&child);
    reader.read_to_string(&mut text).expect("the rest");
    assert_eq!(child.0.wait().expect("an end").code(), Some(130), "{text}");
    assert!(
        text.contains("✓ a: stopped") && text.contains("1 of 1 flight passed, 1 were not flown"),
        "{text}"
    );
    assert!(sandbox.read("report.xml").contains("classname=\"a\""));
}

#[test]
fn a_changed_file_is_flown_again_while_it_is_watched() {
    let sandbox = Sandbox::new();
    sandbox.write("a.toml", STANDING);
    let mut child = spawn(&sandbox, &["check", "a.toml", "--watch"]);
    let mut lines = BufReader::new(child.0.stdout.take().expect("standard output")).lines();
    let mut reported = BufReader::new(child.0.stderr.take().expect("standard error")).lines();
    let mut until = |part: &str| {
        lines.by_ref().map(|line| line.expect("a line")).find(|line| line.contains(part)).expect("the line");
    };
    let mut waits = || {
        reported
            .by_ref()
            .map(|line| line.expect("a line"))
            .find(|line| line.contains("Waiting"))
            .expect("it waits");
    };
    until("1 of 1 flight passed");
    waits();
    sandbox.write("a.toml", &standing("22..33 m"));
    until("0 of 1 flight passed");
    waits();
    interrupt(&child);
    assert_eq!(child.0.wait().expect("an end").code(), Some(130));
}

#[test]
fn a_scenario_made_of_a_plan_passes() {
    let sandbox = Sandbox::new();
    let made = sandbox.run(&["check", "--new", "land"]).exits(0);
    sandbox.write("land-test.toml", &made.out);
    sandbox.run(&["check", "land-test.toml"]).exits(0);
    // The scenario fails for another plan.
    sandbox.write("other.toml", &made.out.replace("LAND 30", "HOLD 30"));
    sandbox.run(&["check", "other.toml"]).exits(1);
}

#[cfg(unix)]
#[test]
fn the_worst_moment_is_opened_on_the_screen_and_a_flight_on_the_screen_becomes_a_scenario() {
    let sandbox = Sandbox::new();
    let plan = "waypoint insert 0 40.4635 -79.5182 500 0 LAND 0 NONE\n";
    sandbox.write("near.txt", plan);
    let scenario = "format = 1\n[plan]\nfile = \"near.txt\"\n[craft]\ntakeoff_m = 5\n";
    sandbox.write("near.toml", scenario);
    let path = sandbox.path("near.toml").display().to_string();
    let mut terminal = crate::binary::pty::Terminal::betadeck(120, 40, &["open", &path, "--at", "4"]);
    terminal.until_shown("LANDING");
    terminal.until_shown("fly on");
    terminal.send("e");
    terminal.until_shown("COMPLETE");
    // The flight was flown before, so it can be written as it is.
    let written = sandbox.path("written.toml").display().to_string();
    terminal.send(&format!(":scenario {written}\r"));
    terminal.until_shown("betadeck check");
    terminal.send("q");
    terminal.until("the question or the end", |terminal| {
        !terminal.is_alternate() || terminal.screen().contains("uit")
    });
    terminal.signal("TERM");
    terminal.end();
    let ran = sandbox.run(&["check", "written.toml"]).exits(0);
    assert!(ran.out.contains("complete"), "{}", ran.out);
}

#[test]
fn the_embedded_firmware_keeps_the_properties_that_master_breaks() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("plans/findings");
    let sandbox = Sandbox::new();
    for entry in std::fs::read_dir(folder).expect("the folder of the findings") {
        let file = entry.expect("an entry").path();
        // A plan that leads through the fence is refused at the start.
        let code = i32::from(file.ends_with("fence-slides.toml"));
        sandbox.run(&["check", file.to_str().expect("a plain name"), "--seeds", "1"]).exits(code);
    }
}
