//! Recordings of flights: written, cut short, listed and opened again.

use std::fs::File;
use std::io::BufReader;
use std::process::Stdio;

use betadeck::recording::{Recording, Repeat, Rest};
use betadeck::signals::SimTime;

use crate::streams::until;
use crate::support::{Sandbox, plan};

fn read(sandbox: &Sandbox, name: &str) -> Recording {
    let file = File::open(sandbox.path(name)).expect("a recording");
    Recording::read(BufReader::new(file)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Flies a recording again. Returns the time of the first picture that shows another flight.
fn fly_again(recording: &Recording) -> Option<SimTime> {
    let mut repeat = Repeat::new(recording, recording.flight().expect("a start")).expect("a flight");
    while !repeat.is_over() {
        repeat.prepare();
        repeat.tick(drop);
    }
    repeat.differs()
}

#[test]
fn a_recorded_flight_flies_again_and_does_not_change_the_flight() {
    let sandbox = Sandbox::new();
    let options = [
        "--wind",
        "3@250",
        "--gust",
        "1",
        "--fault",
        "gps-loss@20,6",
        "--stick",
        "aux2=1000@boot+40,3",
        "--timeout",
        "50",
    ];
    let land = plan("land.toml");
    let arguments = [&["fly", land.as_str(), "--json", "-"][..], &options].concat();
    let plain = sandbox.run(&arguments);
    let recorded = sandbox.run(&[&arguments[..], &["--record", "a.flight"]].concat());
    let without_times = |text: &str| {
        let line = text.lines().last().expect("an end").to_owned();
        let (before, _) = line.split_once("\"wall_s\"").expect("a wall time");
        (text.lines().count(), before.to_owned())
    };
    assert_eq!(without_times(&recorded.out), without_times(&plain.out));
    assert_eq!(recorded.code, plain.code);
    let recording = read(&sandbox, "a.flight");
    assert_eq!((recording.rest, recording.left_out, recording.only_pictures()), (Rest::Whole, 0, None));
    let end = recording.end.as_ref().expect("an end");
    assert!(recorded.err.contains(&format!("{}: {}", end.result, end.reason)), "{}", recorded.err);
    assert_eq!(fly_again(&recording), None);
    // The same flight has the same hash.
    sandbox.run(&[&arguments[..], &["--record", "b.flight"]].concat());
    assert_eq!(read(&sandbox, "b.flight").end.expect("an end").hash, end.hash);
    sandbox.run(&[&arguments[..], &["--record", "b.flight", "--seed", "2"]].concat());
    assert_ne!(read(&sandbox, "b.flight").end.expect("an end").hash, end.hash);
}

#[test]
fn a_killed_flight_leaves_a_recording_of_what_was_flown() {
    let sandbox = Sandbox::new();
    let mut command = sandbox.command(&["fly", "square", "--speed", "20", "--record", "a.flight"]);
    let mut child = command.stdin(Stdio::null()).stdout(Stdio::null()).spawn().expect("a flight");
    let bytes = || sandbox.path("a.flight").metadata().map_or(0, |file| file.len());
    until("some of the flight", || bytes() > 40_000);
    child.kill().expect("killed");
    child.wait().expect("an end");
    let recording = read(&sandbox, "a.flight");
    assert!(
        recording.end.is_none() && recording.pictures.all().len() > 50,
        "{}",
        recording.pictures.all().len()
    );
    assert_eq!(fly_again(&recording), None);
    assert_eq!(sandbox.names().iter().filter(|name| name.starts_with(".betadeck")).count(), 0);
}

#[test]
fn a_recording_replaces_no_input_and_an_old_one_is_removed_when_the_flight_is_refused() {
    let sandbox = Sandbox::new();
    let file = plan("land.toml");
    std::fs::copy(&file, sandbox.path("plan.toml")).expect("a copy");
    let ran = sandbox.run(&["fly", "plan.toml", "--record", "plan.toml"]).exits(2);
    assert!(
        ran.err.contains("--record plan.toml would overwrite the plan: name another file"),
        "{}",
        ran.err
    );
    sandbox.run(&["fly", "plan.toml", "--record", "a.flight", "--timeout", "1"]).exits(1);
    assert!(sandbox.path("a.flight").exists());
    sandbox.run(&["fly", "plan.toml", "--record", "a.flight", "--set", "no_such_setting=1"]).exits(2);
    assert!(!sandbox.path("a.flight").exists());
    sandbox.write("mine.flight", "mine");
    sandbox.run(&["fly", "plan.toml", "--record", "mine.flight", "--set", "no_such_setting=1"]).exits(2);
    assert_eq!(sandbox.read("mine.flight"), "mine");
    let ran = sandbox.run(&["fly", "plan.toml", "--record", "none/a.flight"]).exits(3);
    assert!(ran.err.contains("cannot write none/a.flight"), "{}", ran.err);
}
