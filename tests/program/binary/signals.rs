//! Signals to a headless flight.
#![allow(clippy::disallowed_methods, reason = "a deadline for a program that hangs needs the clock")]

use std::io::{BufRead as _, BufReader, Read as _};
use std::process::{Child, Stdio};

use crate::binary::lines::Line;
use crate::binary::support::Sandbox;

/// A process that is killed when its test ends.
struct Guard(Child);

impl Drop for Guard {
    fn drop(&mut self) {
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

/// Flies in real time and sends a signal after the first line. Returns the exit code, the lines and standard
/// error.
fn interrupted(signal: &str) -> (Option<i32>, Vec<Line>, String) {
    let sandbox = Sandbox::new();
    let mut command =
        sandbox.command(&["fly", "square", "--speed", "1", "--json", "-", "--gpx", "track.gpx"]);
    let child =
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("a flight");
    let mut child = Guard(child);
    let mut reader = BufReader::new(child.0.stdout.take().expect("standard output"));
    let mut text = String::new();
    reader.read_line(&mut text).expect("a line, long before the flight is over");
    let id = child.0.id().to_string();
    assert!(std::process::Command::new("kill").args(["-s", signal, &id]).status().expect("kill").success());
    reader.read_to_string(&mut text).expect("the rest");
    let mut err = String::new();
    child.0.stderr.take().expect("standard error").read_to_string(&mut err).expect("the summary");
    let code = child.0.wait().expect("an end").code();
    assert!(sandbox.read("track.gpx").trim_end().ends_with("</gpx>"), "the track is whole");
    (code, Line::read_all(&text), err)
}

#[test]
fn an_interrupted_flight_says_so_and_leaves_whole_files() {
    for signal in ["INT", "TERM"] {
        let (code, lines, err) = interrupted(signal);
        assert_eq!(code, Some(130), "{signal}: {err}");
        let end = lines.last().expect("lines");
        assert_eq!(end.text("result"), "interrupted");
        assert!(end.time() < 60.0, "{end:?}");
        assert!(err.starts_with("interrupted: "), "{err}");
    }
}

#[test]
fn interrupted_examples_leave_no_file_and_can_be_made_again() {
    let sandbox = Sandbox::new();
    let mut command = sandbox.command(&["examples", "try"]);
    let child = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn();
    let mut child = Guard(child.expect("a process"));
    while !sandbox.path("try/my-plan.toml").exists() && child.0.try_wait().expect("a state").is_none() {
        std::thread::yield_now();
    }
    let id = child.0.id().to_string();
    assert!(std::process::Command::new("kill").args(["-s", "INT", &id]).status().expect("kill").success());
    assert_eq!(child.0.wait().expect("an end").code(), Some(130));
    sandbox.run(&["examples", "try"]).exits(0);
}

#[test]
fn a_second_signal_ends_a_flight_that_nobody_reads() {
    let sandbox = Sandbox::new();
    let mut command = sandbox.command(&["fly", "square", "--json", "-", "--samples", "1000"]);
    let child =
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("a flight");
    let mut child = Guard(child);
    let mut reader = BufReader::with_capacity(64, child.0.stdout.take().expect("standard output"));
    reader.read_line(&mut String::new()).expect("a line: from here on signals are heard");
    // The pipe is full long before the flight is over. Two signals in quick succession may arrive as one.
    let id = child.0.id().to_string();
    let code = loop {
        if let Some(status) = child.0.try_wait().expect("a child") {
            break status.code();
        }
        assert!(
            std::process::Command::new("kill").args(["-s", "INT", &id]).status().expect("kill").success()
        );
    };
    assert_eq!(code, Some(130));
}
