//! `check`, `fly` and `compare` with a firmware outside: the drop-in as the child, in real time.

use std::path::Path;

use serde_json::Value;

use super::program::Program;
use super::stand_in::free_ports;
use super::stand_in::program::Ports;

/// Flies a little way north and lands there, low and near, for time is real.
const PLAN: &str = "\
name = \"hop\"
settings = [\"ap_hover_throttle = 1500\", \"ap_max_angle = 25\"]
[home]
lat_deg = 40.4635
lon_deg = -79.5182
alt_amsl_m = 300
[[waypoint]]
type = \"LAND\"
lat_deg = 40.4635900
lon_deg = -79.5182
alt_m = 4
";

/// A craft that stands, so that all expectations are met that can be judged.
const STANDING: &str = "\
format = 1
ends = \"4 s after boot\"
[plan]
builtin = \"square\"
[craft]
pilot = \"none\"
[[expect]]
always = \"altitude in -0.1..0.1 m and not armed\"
from = \"boot\"
[[expect]]
never = \"throttle > 1200 us\"
from = \"boot\"
";

/// A run with the drop-in as the firmware.
fn start(command: &[&str]) -> Program {
    let Ports { raw, motors, fdm, rc, tcp } = free_ports();
    let (udp, tcp) = (format!("--udp-ports={raw},{motors},{fdm},{rc}"), format!("--tcp-port={tcp}"));
    let mut arguments = command.to_vec();
    arguments.extend(["--firmware", env!("CARGO_BIN_EXE_betadeck"), &udp, &tcp]);
    for argument in ["sitl", &udp, &tcp, "--ws-port=0"] {
        arguments.extend(["--firmware-arg", argument]);
    }
    Program::start(&arguments)
}

/// The exit code and the last line of JSON.
fn end(mut program: Program) -> (i32, Value) {
    let code = program.end();
    let lines = program.seen();
    let last = lines.iter().rev().find_map(|line| serde_json::from_str(line).ok());
    (code, last.unwrap_or_else(|| panic!("no JSON in\n{}", lines.join("\n"))))
}

fn write(directory: &Path, name: &str, text: &str) -> String {
    let path = directory.join(name);
    std::fs::write(&path, text).unwrap();
    path.display().to_string()
}

#[test]
fn a_scenario_is_judged_by_truth_and_what_is_not_told_is_skipped() {
    let directory = tempfile::tempdir().unwrap();
    let scenario = write(directory.path(), "standing.toml", STANDING);
    let (code, summary) = end(start(&["check", &scenario, "--json", "-"]));
    assert_eq!(
        (code, &summary["event"], &summary["passed"]),
        (0, &"summary".into(), &true.into()),
        "{summary}"
    );
    assert_eq!((&summary["skipped"], &summary["flights_passed"]), (&1.into(), &1.into()), "{summary}");
}

#[test]
fn a_case_that_only_the_embedded_firmware_flies_is_skipped_unflown() {
    let directory = tempfile::tempdir().unwrap();
    let orders = format!("{STANDING}[[input]]\nat = \"boot\"\ndo = \"hold here\"\n");
    let scenario = write(directory.path(), "orders.toml", &orders);
    let (code, summary) = end(start(&["check", &scenario, "--json", "-"]));
    assert_eq!((code, &summary["flights_skipped"], &summary["flights_passed"]), (0, &1.into(), &0.into()));
}

#[test]
fn a_plan_is_flown_to_its_landing_and_compared_with_the_embedded_firmware() {
    let directory = tempfile::tempdir().unwrap();
    let (plan, svg) = (write(directory.path(), "hop.toml", PLAN), directory.path().join("tracks.svg"));
    let picture = svg.display().to_string();
    let options = ["--takeoff", "4", "--repeat", "1", "--json", "-", "--svg", &picture];
    let (code, compared) = end(start(&[&["compare", &plan][..], &options].concat()));
    assert_eq!(code, 0, "{compared}");
    let measure = |name: &str, side: &str| {
        let all = compared["measures"].as_array().unwrap();
        let found =
            all.iter().find(|line| line["measure"] == name).unwrap_or_else(|| panic!("{name} in {compared}"));
        found[side]["mean"].as_f64().unwrap()
    };
    for side in ["a", "b"] {
        assert!((2.0..60.0).contains(&measure("flown_s", side)), "{compared}");
        assert!(measure("touchdown_distance_m", side) < 5.0, "{compared}");
    }
    let apart = compared["tracks_apart_rms_m"]["between"]["mean"].as_f64().unwrap();
    assert!(apart < 5.0, "{compared}");
    let svg = std::fs::read_to_string(svg).unwrap();
    assert!(svg.contains("A: embedded</text>") && svg.contains("B: betadeck</text>"), "{svg}");
}

#[test]
fn what_cannot_fly_is_told_before_anything_starts() {
    let directory = tempfile::tempdir().unwrap();
    let none = directory.path().join("none.elf").display().to_string();
    for (arguments, code, part) in [
        (&["fly", "square", "--firmware", &none][..], 3, "there is no such file"),
        (&["fly", "square", "--firmware", "attach", "--speed", "4"], 2, "--fdm-stamps sim"),
        (&["serve", "--firmware", "attach", "--physics", "external"], 2, "leave out one of the two"),
        (&["compare", "square"], 2, "--firmware"),
        (&["check", "guide-1", "--betaloop", &none], 3, "cannot open"),
    ] {
        let mut program = Program::start(arguments);
        assert_eq!(program.end(), code, "{arguments:?}");
        let said = program.seen().join("\n");
        assert!(said.contains(part), "{arguments:?}: {said}");
    }
}

#[test]
fn a_comparison_that_is_interrupted_tells_what_was_flown() {
    let directory = tempfile::tempdir().unwrap();
    let plan = write(directory.path(), "hop.toml", PLAN);
    let picture = write(directory.path(), "tracks.svg", "before");
    let mut program = start(&["compare", &plan, "--takeoff", "4", "--svg", &picture]);
    program.wait("end of the first flight", |line| {
        line.starts_with("embedded, flight 1 of 1: complete").then_some(())
    });
    let id = program.id().to_string();
    assert!(std::process::Command::new("kill").args(["-s", "INT", &id]).status().unwrap().success());
    assert_eq!(program.end(), 130);
    let said = program.seen().join("\n");
    assert!(said.contains("A: embedded, one flight") && said.contains("B: betadeck, not flown"), "{said}");
    assert_eq!(std::fs::read_to_string(picture).unwrap(), "before");
}
