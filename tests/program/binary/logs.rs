//! Blackbox logs as files: of flights, of scenarios, of comparisons, and of a craft that is served.

use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::Stdio;

use betadeck::blackbox::FrameKind;
use betadeck::blackbox::decode::{Item, LogReader};

use crate::binary::streams::until;
use crate::binary::support::{PROGRAM, Sandbox, plan};

/// A scenario whose craft stays on the ground for two seconds, and logs from boot on.
const LOGGED: &str = "format = 1
description = \"Stands and logs\"
ends = \"2 s after boot\"
[plan]
builtin = \"square\"
[craft]
pilot = \"none\"
settings = [\"blackbox_mode = ALWAYS\"]
[[case]]
name = \"calm\"
[case.air]
noise = \"none\"
[[case]]
name = \"rough air\"
seeds = [1, 2]
[case.air]
gust_mps = 2
[[expect]]
from = \"boot\"
always = \"altitude in -1..1 m\"
";

/// The contents of a file with logs.
#[derive(Debug, Default)]
struct Logs {
    /// The number of main frames.
    frames: usize,
    /// The number of logs, and of those with an end.
    logs: usize,
    ended: usize,
}

/// Reads a file with logs. Only its last bytes may be no whole frame.
fn read(path: &Path) -> Logs {
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut reader = LogReader::new(bytes.as_slice());
    let mut logs = Logs::default();
    loop {
        let offset = reader.offset();
        let Some(item) = reader.next_item().expect("bytes") else { break };
        match item {
            Item::Log { .. } => logs.logs += 1,
            Item::Frame(frame) if matches!(frame.kind, FrameKind::Intra | FrameKind::Inter) => {
                logs.frames += 1;
            }
            Item::Event { event: Some(betadeck::blackbox::LogEvent::End), .. } => logs.ended += 1,
            Item::Skipped { .. } => assert!(offset + 500 > bytes.len() as u64, "damage at {offset}"),
            Item::Refused { error, .. } => panic!("{error}"),
            _ => {}
        }
    }
    logs
}

#[test]
fn the_log_of_a_flight_is_in_the_file_or_in_the_folder_under_the_name_of_the_plan() {
    let sandbox = Sandbox::new();
    let land = plan("land.toml");
    std::fs::create_dir(sandbox.path("logs")).expect("a folder");
    let flight = ["fly", land.as_str(), "--takeoff", "3", "--set", "blackbox_sample_rate=1/8"];
    sandbox.run(&[&flight[..], &["--blackbox", "one.bbl"]].concat()).exits(0);
    let logs = read(&sandbox.path("one.bbl"));
    assert_eq!((logs.logs, logs.ended), (1, 1));
    assert!(logs.frames > 1000, "{logs:?}");
    sandbox.run(&[&flight[..], &["--blackbox", "logs"]].concat()).exits(0);
    assert_eq!(
        std::fs::read(sandbox.path("logs/land.bbl")).expect("a log"),
        std::fs::read(sandbox.path("one.bbl")).expect("a log")
    );
}

#[test]
fn a_log_does_not_change_the_flight() {
    let sandbox = Sandbox::new();
    let land = plan("land.toml");
    let flight = ["fly", land.as_str(), "--timeout", "30", "--gust", "2", "--json", "-"];
    let without_times = |text: &str| {
        let line = text.lines().last().expect("an end").to_owned();
        let (before, _) = line.split_once("\"wall_s\"").expect("a wall time");
        (text.lines().count(), before.to_owned())
    };
    let plain = sandbox.run(&flight);
    let logged = sandbox.run(&[&flight[..], &["--blackbox", "one.bbl"]].concat());
    assert_eq!(without_times(&plain.out), without_times(&logged.out));
}

#[test]
fn a_flight_that_never_arms_leaves_no_log_and_removes_only_an_earlier_one() {
    let sandbox = Sandbox::new();
    let land = plan("land.toml");
    let short =
        |file: &str| sandbox.run(&["fly", land.as_str(), "--timeout", "1", "--blackbox", file]).exits(1);
    let ran = short("one.bbl");
    assert!(
        ran.err.contains("--blackbox one.bbl: there is no log, because the craft was not armed."),
        "{}",
        ran.err
    );
    assert!(!sandbox.path("one.bbl").exists());
    sandbox.write(
        "other.bbl",
        "H Product:Blackbox flight data recorder by Nicholas Sherlock\nH Data version:2\n",
    );
    let refused = sandbox.run(&["fly", "no-such-plan", "--blackbox", "other.bbl"]).exits(2);
    assert!(sandbox.path("other.bbl").exists(), "{}", refused.err);
    let clash = sandbox.run(&["fly", "square", "--blackbox", "one", "--record", "one"]).exits(2);
    assert!(clash.err.contains("would overwrite"), "{}", clash.err);
}

#[test]
fn a_killed_flight_leaves_a_log_up_to_its_last_second() {
    let sandbox = Sandbox::new();
    let mut command = sandbox.command(&["fly", "square", "--speed", "20", "--blackbox", "one.bbl"]);
    let mut child = command.stdin(Stdio::null()).stdout(Stdio::null()).spawn().expect("a flight");
    let bytes = || sandbox.path("one.bbl").metadata().map_or(0, |file| file.len());
    until("some of the flight", || bytes() > 40_000);
    child.kill().expect("killed");
    child.wait().expect("an end");
    let logs = read(&sandbox.path("one.bbl"));
    assert!(logs.frames > 200 && logs.ended == 0, "{logs:?}");
}

#[test]
fn each_flight_of_a_check_has_its_log_in_the_folder() {
    let sandbox = Sandbox::new();
    sandbox.write("hop.toml", LOGGED);
    let ran = sandbox.run(&["check", "hop.toml", "--blackbox", "logs"]);
    let names = |folder: &str| {
        let entries = std::fs::read_dir(sandbox.path(folder)).expect("a folder");
        let mut names: Vec<_> = entries
            .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    };
    let expected = ["hop-calm.bbl", "hop-rough-air-seed-1.bbl", "hop-rough-air-seed-2.bbl"];
    assert_eq!(names("logs"), expected, "{}\n{}", ran.out, ran.err);
    for name in expected {
        assert!(read(&sandbox.path("logs").join(name)).frames > 100, "{name}");
    }
    let one = ["check", "hop.toml", "--filter", "calm", "--blackbox", "calm.bbl"];
    sandbox.run(&one).exits(0);
    assert_eq!(
        std::fs::read(sandbox.path("calm.bbl")).expect("a log"),
        std::fs::read(sandbox.path("logs/hop-calm.bbl")).expect("a log")
    );
    let ran = sandbox.run(&["check", "hop.toml", "--blackbox", "hop.toml"]).exits(2);
    assert!(ran.err.contains("each of the 3 flights has a log: name a folder"), "{}", ran.err);
}

#[test]
fn a_craft_that_is_served_writes_the_next_free_log_and_a_kill_leaves_it() {
    let sandbox = Sandbox::new();
    sandbox.write("log.txt", "set blackbox_device = VIRTUAL\nset blackbox_mode = ALWAYS\n");
    let logged = |number: u32| sandbox.path("state").join(format!("LOG{number:05}.BFL"));
    for number in 1..=2 {
        let serve = ["serve", "--no-ports", "--state-dir", "state", "--settings", "log.txt", "--speed", "10"];
        let mut command = sandbox.command(&serve);
        let mut child = command.stdin(Stdio::null()).stdout(Stdio::null()).spawn().expect("a craft");
        until("some of the log", || logged(number).metadata().map_or(0, |file| file.len()) > 40_000);
        child.kill().expect("killed");
        child.wait().expect("an end");
        let logs = read(&logged(number));
        assert!(logs.frames > 200 && logs.ended == 0, "{logs:?}");
    }
    assert!(!logged(3).exists());
    // No output replaces them.
    let arguments = ["fly", "square", "--state-dir", "state", "--json", "state/LOG00001.BFL"];
    let ran = sandbox.run(&arguments).exits(2);
    assert!(ran.err.contains("would overwrite a blackbox log"), "{}", ran.err);
}

#[test]
fn a_comparison_logs_the_flights_of_the_embedded_firmware() {
    let sandbox = Sandbox::new();
    let land = plan("land.toml");
    let both = ["--firmware", "embedded", "--firmware", "embedded", "--timeout", "20", "--gust", "1"];
    let compare =
        [&["compare", land.as_str()][..], &both, &["--seeds", "3..4", "--blackbox", "logs"]].concat();
    let ran = sandbox.run(&compare).exits(1);
    for name in ["embedded-seed-3", "embedded-seed-4", "embedded-seed-3-2", "embedded-seed-4-2"] {
        let path = sandbox.path("logs").join(format!("{name}.bbl"));
        assert!(path.exists(), "{name}: {}", ran.err);
        assert!(read(&path).frames > 500, "{name}");
    }
}

#[test]
fn a_full_disk_leaves_no_empty_log() {
    let sandbox = Sandbox::new();
    sandbox.write("log.txt", "set blackbox_device = VIRTUAL\nset blackbox_mode = ALWAYS\n");
    // No file of the program may have a byte, as on a full disk.
    let full = |line: &str| {
        let script = format!("trap '' XFSZ; ulimit -f 0; exec {PROGRAM} {line}");
        let mut shell = std::process::Command::new("/bin/sh");
        shell.env_clear().envs(sandbox.environment()).current_dir(sandbox.path("."));
        shell.args(["-c", &script]);
        shell
    };
    let flown = full("fly land --takeoff 3 --timeout 12 --blackbox new.bbl").output().expect("a shell");
    let said = String::from_utf8_lossy(&flown.stderr);
    assert_eq!(flown.status.code(), Some(3), "{said}");
    assert!(said.contains("cannot write new.bbl: "), "{said}");
    let mut serve = full("serve --no-ports --state-dir state --settings log.txt --speed 10");
    let mut child = serve.stdin(Stdio::null()).stdout(Stdio::piped()).spawn().expect("a shell");
    let mut lines = BufReader::new(child.stdout.take().expect("an output")).lines().map_while(Result::ok);
    assert!(lines.any(|line| line.contains("The blackbox log cannot be written")));
    child.kill().expect("killed");
    child.wait().expect("an end");
    let logs: Vec<_> = betadeck::storage::logs_in(&sandbox.path("state")).collect();
    assert_eq!(logs, Vec::<std::path::PathBuf>::new());
    assert!(!sandbox.path("new.bbl").exists());
}
