//! Files of results. Each is complete or absent, and never one of an earlier run.
#![allow(clippy::disallowed_methods, reason = "a state of another process is waited for")]

use std::io::{BufRead as _, BufReader};
use std::process::{Child, Stdio};

use crate::lines::Line;
use crate::streams::{end_of, handles_signals, until};
use crate::support::Sandbox;

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
        &["check", "stand.toml", "--bogus"],
        &["check", "stand.toml", "--jobs", "many"],
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
        &["fly", "land", "--bogus"],
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
