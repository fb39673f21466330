//! Files of results. Each is complete or absent, and never one of an earlier run.
#![allow(clippy::disallowed_methods, reason = "a state of another process is waited for")]

use std::io::{BufRead as _, BufReader};
use std::process::{Child, Stdio};

use crate::binary::lines::Line;
use crate::binary::streams::{end_of, handles_signals, until};
use crate::binary::support::Sandbox;

/// A scenario whose craft stays on the ground for two seconds.
const STANDING: &str = "format = 1
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

const OPTIONS: [&str; 8] =
    ["--json", "run.json", "--junit", "run.xml", "--markdown", "run.md", "--report", "run.html"];
const FILES: [&str; 4] = ["run.json", "run.xml", "run.md", "run.html"];

/// A process that is killed when its test ends.
struct Guard(Child);

impl Drop for Guard {
    fn drop(&mut self) {
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

fn start(sandbox: &Sandbox, arguments: &[&str]) -> Guard {
    let mut command = sandbox.command(arguments);
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null());
    Guard(command.spawn().expect("it starts"))
}

fn signal(child: &Guard, name: &str) {
    let id = child.0.id().to_string();
    assert!(std::process::Command::new("kill").args(["-s", name, &id]).status().expect("kill").success());
}

/// Returns a folder with the reports of a run that passed.
fn after_a_run() -> Sandbox {
    let sandbox = Sandbox::new();
    sandbox.write("stand.toml", STANDING);
    sandbox.run(&[&["check", "stand.toml"][..], &OPTIONS].concat()).exits(0);
    for file in FILES {
        assert!(!sandbox.read(file).is_empty());
    }
    sandbox
}

#[test]
fn a_check_that_cannot_start_leaves_no_reports_of_an_earlier_run() {
    for line in [
        &["check", "broken.toml"][..],
        &["check", "missing.toml"],
        &["check", "stand.toml", "--filter", "nothing-of-that-name"],
        &["check", "stand.toml", "--firmware", "missing.elf"],
    ] {
        let sandbox = after_a_run();
        sandbox.write("broken.toml", "format = 1\nnonsense = 2\n");
        let ran = sandbox.run(&[line, &OPTIONS].concat());
        assert!(matches!(ran.code, Some(2 | 3)), "{line:?}: {ran:?}");
        for file in FILES {
            assert!(!sandbox.path(file).exists(), "{line:?}: {file} is that of the earlier run");
        }
    }
}

#[test]
fn a_mistake_in_the_options_removes_nothing_and_says_that_the_files_are_old() {
    let sandbox = after_a_run();
    let before: Vec<String> = FILES.iter().map(|file| sandbox.read(file)).collect();
    for line in [&["check", "stand.toml", "--bogus"][..], &["check", "stand.toml", "--jobs", "many"]] {
        let ran = sandbox.run(&[line, &OPTIONS].concat()).exits(2);
        for (file, text) in FILES.iter().zip(&before) {
            assert_eq!(&sandbox.read(file), text, "{line:?}");
            assert!(ran.err.contains(&format!("{file} is as it was before this command")), "{}", ran.err);
        }
    }
}

/// Returns the bytes of all files in the folder.
fn all_files(sandbox: &Sandbox) -> Vec<(String, Vec<u8>)> {
    let names = sandbox.names();
    names
        .into_iter()
        .map(|name| (name.clone(), std::fs::read(sandbox.path(&name)).unwrap_or_default()))
        .collect()
}

#[test]
fn no_mistake_deletes_a_file_that_the_right_command_would_not_write() {
    let sandbox = Sandbox::new();
    let plan = "waypoint insert 0 40.4635901 -79.5182000 2000 500 LAND 0 NONE\n";
    sandbox.write("plan.txt", plan);
    let outputs = ["--json", "run.jsonl", "--record", "a.flight", "--blackbox", "a.bbl", "--gpx", "plan.gpx"];
    sandbox.run(&[&["fly", "plan.txt", "--timeout", "1"][..], &outputs].concat());
    sandbox.run(&["campaign", "plan.txt", "--flights", "2", "--timeout", "1", "--out", "c.jsonl"]);
    std::os::unix::fs::symlink("run.jsonl", sandbox.path("link.jsonl")).expect("a link");
    sandbox.write("betadeck.toml", "nonsense = 1\n");
    let before = all_files(&sandbox);
    assert!(before.len() >= 6, "{:?}", sandbox.names());
    for line in [
        &["fly", "square", "--record", "a.flight", "--bogus"][..],
        &["fly", "square", "--record=a.flight", "--seed", "x"],
        &["fly", "square", "--blackbox", "a.bbl", "--bogus"],
        &["fly", "plan.gpx", "--gpx", "plan.gpx", "--bogus"],
        &["check", "missing.toml", "--report", "a.flight"],
        &["check", "missing.toml", "--report", "a.flight", "--bogus"],
        &["fly", "nosuch.toml", "--json", "c.jsonl"],
        &["fly", "square", "--json", "c.jsonl", "--bogus"],
        &["fly", "nosuch.toml", "--json", "link.jsonl"],
        &["fly", "square", "--report", "plan.gpx", "--backdrop", "plan.gpx", "--bogus"],
        &["campaign", "merge", "c.jsonl", "--csv", "c.jsonl", "--bogus"],
        &["campaign", "merge", "c.jsonl", "--out", "d.jsonl", "--csv", "c.jsonl"],
    ] {
        let ran = sandbox.run(line);
        assert!(matches!(ran.code, Some(2 | 3)), "{line:?}: {ran:?}");
        assert!(all_files(&sandbox) == before, "{line:?}: {:?}", sandbox.names());
    }
    let mut wrong = sandbox.command(&["fly", "square", "--record", "a.flight"]);
    let ran = wrong.env("BETADECK_SPEED", "fast").env("BETADECK_FLY_SEED", "x").output().expect("it runs");
    if ran.status.code() == Some(2) {
        assert!(all_files(&sandbox) == before, "{ran:?}");
    }
}

#[test]
fn an_output_of_fly_replaces_only_what_such_an_option_wrote_unless_forced() {
    let sandbox = Sandbox::new();
    sandbox.write("plan.txt", "waypoint insert 0 40.4635901 -79.5182000 2000 500 LAND 0 NONE\n");
    for (option, other) in
        [("--record", "--json"), ("--report", "--markdown"), ("--blackbox", "--csv"), ("--json", "--csv")]
    {
        sandbox.write("mine", "my notes\n");
        let fly = |option: &str| sandbox.run(&["fly", "plan.txt", "--timeout", "8", option, "mine"]);
        let ran = fly(option).exits(2);
        assert!(ran.err.contains("name another file, or add --force"), "{}", ran.err);
        assert_eq!(sandbox.read("mine"), "my notes\n");
        sandbox.run(&["fly", "plan.txt", "--timeout", "8", "--force", option, "mine"]).exits(1);
        let written = std::fs::read(sandbox.path("mine")).expect("the output");
        assert!(written != b"my notes\n", "{option}");
        fly(option).exits(1);
        fly(other).exits(2);
        std::fs::remove_file(sandbox.path("mine")).expect("removed");
    }
}

#[test]
fn a_check_that_cannot_start_removes_nothing_but_reports() {
    let sandbox = Sandbox::new();
    let plan = "waypoint insert 0 40.4635901 -79.5182000 2000 500 LAND 0 NONE\n";
    sandbox.write("plan.txt", plan);
    sandbox.write("notes.md", "# Notes\n");
    sandbox.write("broken.toml", "format = 1\nnonsense = 2\n[plan]\nfile = \"plan.txt\"\n");
    let broken = sandbox.read("broken.toml");
    for line in [
        ["check", "broken.toml", "--json", "plan.txt"],
        ["check", "broken.toml", "--markdown", "notes.md"],
        ["check", "broken.toml", "--junit", "broken.toml"],
    ] {
        sandbox.run(&line).exits(2);
        assert_eq!(
            (sandbox.read("plan.txt").as_str(), sandbox.read("notes.md").as_str()),
            (plan, "# Notes\n")
        );
        assert_eq!(sandbox.read("broken.toml"), broken);
    }
    // A check whose report is refused removes nothing either. The file is of another program and looks like a
    // report.
    sandbox.write("report.txt", "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"other\">\n");
    sandbox.run(&["check", "broken.toml", "--junit", "report.txt"]).exits(2);
    assert!(sandbox.path("report.txt").exists(), "it is a report of another program");
}

#[test]
fn reports_of_a_check_are_whole_or_not_there() {
    for name in ["INT", "KILL"] {
        let sandbox = after_a_run();
        // The run is long enough for the signal to end it.
        sandbox.write("stand.toml", &STANDING.replace("2 s after", "60 s after"));
        let mut child =
            start(&sandbox, &[&["check", "stand.toml", "--repeat=1000", "--jobs=1"][..], &OPTIONS].concat());
        let mut reader = BufReader::new(child.0.stdout.take().expect("standard output"));
        reader.read_line(&mut String::new()).expect("the first flight");
        std::thread::spawn(move || std::io::copy(&mut reader, &mut std::io::sink()));
        for file in FILES {
            assert!(!sandbox.path(file).exists(), "{file} while the run goes on");
        }
        signal(&child, name);
        let code = end_of(&mut child.0);
        for file in FILES {
            assert_eq!(sandbox.path(file).exists(), name == "INT", "{file} after {name}");
        }
        if name == "INT" {
            assert_eq!(code, Some(130));
            assert!(sandbox.read("run.json").lines().last().expect("lines").contains("\"summary\""));
            assert!(sandbox.read("run.xml").ends_with("</testsuites>\n"));
            assert_eq!(sandbox.names().iter().filter(|name| name.contains("run.")).count(), FILES.len());
        }
    }
}

#[test]
fn the_files_of_a_flight_are_there_when_it_is_over() {
    for name in ["INT", "KILL"] {
        let sandbox = Sandbox::new();
        let files = ["--json", "flight.json", "--gpx", "track.gpx", "--report", "flight.html"];
        // Two simulated seconds are enough to write the files.
        sandbox.run(&[&["fly", "land", "--timeout=2"][..], &files].concat()).exits(1);
        let mut child = start(&sandbox, &[&["fly", "land", "--speed=1"][..], &files].concat());
        handles_signals(child.0.id());
        until("the flight begins", || !sandbox.path("flight.json").exists() && sandbox.names().len() >= 2);
        assert!(!sandbox.path("track.gpx").exists() && !sandbox.path("flight.html").exists());
        signal(&child, name);
        let code = end_of(&mut child.0);
        assert_eq!(sandbox.path("flight.json").exists(), name == "INT", "after {name}");
        assert_eq!(sandbox.path("track.gpx").exists(), name == "INT", "after {name}");
        assert_eq!(sandbox.path("flight.html").exists(), name == "INT", "after {name}");
        if name == "INT" {
            assert_eq!(code, Some(130));
            let lines = Line::read_all(&sandbox.read("flight.json"));
            assert_eq!(lines.last().expect("lines").text("result"), "interrupted");
            assert!(sandbox.read("track.gpx").trim_end().ends_with("</gpx>"));
            assert!(sandbox.read("flight.html").contains("✗ interrupted"));
            assert_eq!(sandbox.names().len(), 3, "{:?}", sandbox.names());
        }
    }
}

#[test]
fn a_flight_that_cannot_start_leaves_no_files_of_an_earlier_one() {
    for line in [
        &["fly", "empty.txt"][..],
        &["fly", "missing.toml"],
        &["fly", "land", "--set", "nonsense=1"],
        &["fly", "land", "--state-dir", "missing"],
        &["fly", "land", "--firmware", "missing.elf"],
    ] {
        let sandbox = Sandbox::new();
        sandbox.write("empty.txt", "# nothing\n");
        let files = ["--json=flight.json", "--gpx=track.gpx", "--report=flight.html", "--markdown=flight.md"];
        // Two simulated seconds are enough to write the files.
        sandbox.run(&[&["fly", "land", "--timeout=2"][..], &files].concat()).exits(1);
        let ran = sandbox.run(&[line, &files].concat());
        assert!(matches!(ran.code, Some(2 | 3)), "{line:?}: {ran:?}");
        assert_eq!(sandbox.names(), ["empty.txt"], "{line:?}");
    }
}
