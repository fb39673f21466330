//! `check`, `fly` and `compare` with a remote firmware: the drop-in as the child, in real time.

use std::path::Path;

use serde_json::Value;

use super::stand_in::free_ports;
use super::stand_in::process::{self, Trouble, VARIABLE};
use super::stand_in::program::Ports;
use crate::doors::program::Program;

/// A plan that flies a short way north and lands there. It is low and near because the flight runs in real time.
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

/// A scenario with a craft that stays on the ground, so that every expectation that can be judged is met.
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

/// Starts a run with the drop-in as the firmware.
fn start(command: &[&str]) -> Program {
    let [udp, tcp] = port_options(free_ports());
    let mut arguments = command.to_vec();
    arguments.extend(["--clock=real", "--firmware", env!("CARGO_BIN_EXE_betadeck"), &udp, &tcp]);
    for argument in ["sitl", &udp, &tcp, "--ws-port=0"] {
        arguments.extend(["--firmware-arg", argument]);
    }
    Program::start(&arguments)
}

/// Returns the options that name a firmware's ports.
fn port_options(ports: Ports) -> [String; 2] {
    let Ports { raw, motors, fdm, rc, tcp } = ports;
    [format!("--udp-ports={raw},{motors},{fdm},{rc}"), format!("--tcp-port={tcp}")]
}

/// Starts a run with the stand-in as the firmware. The run uses the ports `named`, the stand-in uses `ports`.
fn start_stand_in(command: &[&str], ports: Ports, named: Ports, trouble: Trouble) -> Program {
    let [udp, tcp] = port_options(named);
    let (program, arguments) = process::command();
    let variable = format!("{VARIABLE}={}", process::variable(ports, trouble));
    let program = program.display().to_string();
    let mut all = command.to_vec();
    all.extend(["--clock=real", "--firmware", "/usr/bin/env", &udp, &tcp]);
    for argument in [&variable[..], &program].into_iter().chain(arguments) {
        all.extend(["--firmware-arg", argument]);
    }
    Program::start(&all)
}

/// Waits for the end and returns the exit code and the whole output.
fn end_said(mut program: Program) -> (i32, String) {
    let code = program.end();
    (code, program.seen().join("\n"))
}

/// Waits for the end and returns the exit code and the last line of JSON.
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
fn a_scenario_is_judged_by_truth_and_unreported_values_are_skipped() {
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
    // A run that judged nothing has not passed.
    assert_eq!((code, &summary["flights_skipped"], &summary["flights_passed"]), (1, &1.into(), &0.into()));
}

#[test]
fn a_plan_is_flown_to_its_landing_and_compared_with_the_embedded_firmware() {
    let directory = tempfile::tempdir().unwrap();
    let (plan, svg) = (write(directory.path(), "hop.toml", PLAN), directory.path().join("tracks.svg"));
    let picture = svg.display().to_string();
    let options = ["--takeoff", "4", "--repeat", "1", "--json", "-", "--svg", &picture];
    let fly = || end(start(&[&["compare", &plan][..], &options].concat()));
    let is_disturbed = |compared: &Value| compared.to_string().contains("s of real time were lost");
    // A machine that is too busy for a flight in real time crashes the craft. The report must then say why.
    let (mut code, mut compared) = fly();
    for _ in 0..2 {
        if code != 0 && is_disturbed(&compared) {
            (code, compared) = fly();
        }
    }
    if code != 0 && is_disturbed(&compared) {
        return;
    }
    assert_eq!(code, 0, "{compared}");
    let measure = |name: &str, side: &str| {
        let all = compared["measures"].as_array().unwrap();
        let found =
            all.iter().find(|line| line["measure"] == name).unwrap_or_else(|| panic!("{name} in {compared}"));
        found[side]["median"].as_f64().unwrap()
    };
    for side in ["a", "b"] {
        assert!((2.0..60.0).contains(&measure("flown_s", side)), "{compared}");
        assert!(measure("touchdown_distance_m", side) < 5.0, "{compared}");
    }
    let apart = compared["tracks_apart_rms_m"]["between"]["median"].as_f64().unwrap();
    assert!(apart < 5.0, "{compared}");
    let svg = std::fs::read_to_string(svg).unwrap();
    assert!(svg.contains("A: embedded</text>") && svg.contains("B: betadeck</text>"), "{svg}");
}

#[test]
fn what_cannot_fly_is_reported_before_anything_starts() {
    let directory = tempfile::tempdir().unwrap();
    let none = directory.path().join("none.elf").display().to_string();
    for (arguments, code, part) in [
        (&["fly", "square", "--firmware", &none][..], 3, "there is no such file"),
        (&["fly", "square", "--firmware", "attach", "--speed", "4"], 2, "--fdm-stamps sim"),
        (&["serve", "--firmware", "attach", "--physics", "external"], 2, "leave out one of the two"),
        (&["compare", "square"], 2, "--firmware"),
        (&["check", "guide-1", "--betaloop", &none], 3, "cannot open"),
        (&["check", "guide-1", "--firmware", "attach"], 2, "--firmware attach flies one flight"),
        (&["check", "--list", "--firmware", "attach"], 2, "cannot be used with"),
        (&["check", "--new", "square", "--yes"], 2, "cannot be used with"),
    ] {
        let mut program = Program::start(arguments);
        assert_eq!(program.end(), code, "{arguments:?}");
        let said = program.seen().join("\n");
        assert!(said.contains(part), "{arguments:?}: {said}");
    }
}

#[test]
fn an_executable_that_cannot_run_in_simulated_time_flies_on_the_wall_clock_and_it_is_said_why() {
    let [udp, tcp] = port_options(free_ports());
    let sleeper = ["fly", "square", "--firmware", "/bin/sleep", "--firmware-arg", "100", &udp, &tcp];
    let directory = tempfile::tempdir().unwrap();
    let script = write(directory.path(), "script", "#!/bin/sh\nexec sleep 100\n");
    std::fs::set_permissions(&script, std::os::unix::fs::PermissionsExt::from_mode(0o755)).unwrap();
    let [other_udp, other_tcp] = port_options(free_ports());
    let script = ["fly", "square", "--firmware", &script, &other_udp, &other_tcp];
    for (arguments, why) in [
        (&sleeper[..], "it has opened no serial port of the number of --tcp-port"),
        (&script, "it is a script or another kind of file"),
    ] {
        let mut program = Program::start(arguments);
        assert_eq!(program.end(), 3, "{arguments:?}");
        let said = program.seen().join("\n");
        assert!(said.contains("runs on the wall clock, in real time:") && said.contains(why), "{said}");
        assert!(said.contains("has not answered"), "{said}");
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

#[test]
fn a_firmware_that_does_not_run_is_not_waited_for_for_ever_and_old_files_stay() {
    let directory = tempfile::tempdir().unwrap();
    let [json, gpx] = ["old.json", "old.gpx"].map(|name| write(directory.path(), name, "old"));
    let ports = free_ports();
    let [udp, tcp] = port_options(ports);
    let options = [
        "--force",
        "--json",
        &json,
        "--gpx",
        &gpx,
        "--attitude",
        "truth",
        "--firmware",
        "attach",
        &udp,
        &tcp,
    ];
    let (code, said) = end_said(Program::start(&[&["fly", "square"][..], &options].concat()));
    assert_eq!(code, 3, "{said}");
    let sentence =
        format!("nothing has answered at TCP port {} for 15 s: start the firmware first", ports.tcp);
    for part in [&sentence, "--tcp-port", "--attitude has no effect: the remote firmware decides that"] {
        assert!(said.contains(part), "{part}: {said}");
    }
    assert!([json, gpx].iter().all(|file| std::fs::read_to_string(file).unwrap() == "old"));
}

#[test]
fn an_interrupt_before_the_flight_leaves_no_broken_file() {
    let directory = tempfile::tempdir().unwrap();
    let gpx = write(directory.path(), "old.gpx", "old");
    let [udp, tcp] = port_options(free_ports());
    let mut program =
        Program::start(&["fly", "square", "--force", "--gpx", &gpx, "--firmware", "attach", &udp, &tcp]);
    program.wait("notice", |line| line.contains("No connection to ").then_some(()));
    let id = rustix::process::Pid::from_raw(program.id() as i32).unwrap();
    rustix::process::kill_process(id, rustix::process::Signal::INT).unwrap();
    assert_eq!(program.end(), 130);
    assert_eq!(std::fs::read_to_string(gpx).unwrap(), "old");
}

#[test]
fn a_firmware_at_another_tcp_port_is_reported_with_the_option() {
    let ports = free_ports();
    let named = Ports { tcp: free_ports().tcp, ..ports };
    let (code, said) = end_said(start_stand_in(&["fly", "square"], ports, named, Trouble::None));
    assert_eq!(code, 3, "{said}");
    let sentence = format!("sends motors, but nothing has answered at tcp:127.0.0.1:{} for 10 s", named.tcp);
    assert!(said.contains(&sentence) && said.contains("--tcp-port"), "{said}");
}

/// A stand-in that the program has not started and cannot start again.
struct Started(std::process::Child);

impl Drop for Started {
    fn drop(&mut self) {
        // It may have ended by itself.
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

#[test]
fn a_firmware_that_its_save_has_ended_is_to_be_started_again() {
    let directory = tempfile::tempdir().unwrap();
    let settings = write(directory.path(), "lines.txt", "set ap_max_angle = 33\n");
    let ports = free_ports();
    let (program, arguments) = process::command();
    let mut command = std::process::Command::new(program);
    command.args(arguments).env(VARIABLE, process::variable(ports, Trouble::None));
    command.current_dir(directory.path()).stdout(std::process::Stdio::null());
    let _started = Started(command.spawn().unwrap());
    let [udp, tcp] = port_options(ports);
    let options = ["--firmware", "attach", "--yes", "--settings", &settings, &udp, &tcp];
    let (code, said) = end_said(Program::start(&[&["fly", "square"][..], &options].concat()));
    assert_eq!(code, 3, "{said}");
    assert!(said.contains("start it again and repeat the command"), "{said}");
}

#[test]
fn a_firmware_without_waypoints_is_reported_how_to_be_built() {
    let ports = free_ports();
    let (code, said) = end_said(start_stand_in(&["fly", "square"], ports, ports, Trouble::HasNoPlans));
    assert_eq!(code, 3, "{said}");
    assert!(
        said.contains(
            "has no waypoints: build today's master, or the branch of the test guide with EXTRA_FLAGS=\"-D"
        ),
        "{said}"
    );
}

#[test]
fn flights_that_cannot_be_prepared_have_failed_and_the_reports_are_written() {
    let directory = tempfile::tempdir().unwrap();
    let scenario = write(directory.path(), "standing.toml", &format!("seeds = \"1..3\"\n{STANDING}"));
    let [junit, markdown] = ["report.xml", "summary.md"].map(|name| directory.path().join(name));
    let [xml, md] = [&junit, &markdown].map(|path| path.display().to_string());
    let ports = free_ports();
    let _taken = std::net::UdpSocket::bind(("127.0.0.1", ports.fdm)).unwrap();
    let command = ["check", &scenario, "--json", "-", "--junit", &xml, "--markdown", &md];
    let (code, summary) = end(start_stand_in(&command, ports, ports, Trouble::None));
    assert_eq!((code, &summary["event"]), (3, &"summary".into()), "{summary}");
    assert_eq!((&summary["flights"], &summary["flights_wanted"]), (&2.into(), &3.into()), "{summary}");
    let why = format!("the firmware cannot use UDP port {}", ports.fdm);
    let (xml, md) = (std::fs::read_to_string(junit).unwrap(), std::fs::read_to_string(markdown).unwrap());
    assert!(xml.contains("tests=\"2\" failures=\"2\"") && xml.contains(&why), "{xml}");
    assert!(md.contains("Some flights failed") && md.contains(&why), "{md}");
}

#[test]
fn a_case_whose_settings_were_refused_says_so() {
    let directory = tempfile::tempdir().unwrap();
    let wants = STANDING.replace("[craft]\n", "[craft]\nsettings = [\"ap_max_angle = 33\"]\n");
    let scenario = write(directory.path(), "standing.toml", &wants);
    let ports = free_ports();
    let (code, said) =
        end_said(start_stand_in(&["check", &scenario], ports, ports, Trouble::RefusesSettings));
    assert_eq!(code, 1, "{said}");
    for part in [
        "The firmware refused `set ap_max_angle = 33`: ERROR IN set: INVALID VALUE.",
        "the firmware is not configured as the case requires: `set ap_max_angle = 33`: the firmware refused it",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
}

#[test]
fn a_check_tells_a_crash_with_its_signal() {
    let directory = tempfile::tempdir().unwrap();
    // The stand-in crashes some seconds after the restart that applies its settings.
    let longer = STANDING.replace("4 s after boot", "20 s after boot");
    let scenario = write(directory.path(), "standing.toml", &longer);
    let ports = free_ports();
    let mut program = start_stand_in(&["check", &scenario], ports, ports, Trouble::Crashes);
    program.wait("crash", |line| line.contains("ended by signal 6").then_some(()));
}
