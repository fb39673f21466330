//! Recordings of flights: written, cut short, listed and opened again.

use std::fs::File;
use std::io::BufReader;
use std::process::Stdio;

use betadeck::recording::{Recording, Repeat, Rest};
use betadeck::signals::SimTime;

use crate::binary::plain::Dialogue;
use crate::binary::streams::until;
use crate::binary::support::{Sandbox, plan};

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
fn a_recording_replaces_no_input_and_an_old_one_stays_when_the_flight_is_refused() {
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
    assert!(sandbox.path("a.flight").exists());
    sandbox.write("mine.flight", "mine");
    sandbox.run(&["fly", "plan.toml", "--record", "mine.flight"]).exits(2);
    assert_eq!(sandbox.read("mine.flight"), "mine");
    let ran = sandbox.run(&["fly", "plan.toml", "--record", "none/a.flight"]).exits(3);
    assert!(ran.err.contains("cannot write none/a.flight"), "{}", ran.err);
}

const PLAIN: [&str; 4] = ["--plain", "--no-ports", "--speed=max", "--state-dir=state"];

/// Returns the names of the recordings in the library.
fn library(sandbox: &Sandbox) -> Vec<String> {
    let entries = std::fs::read_dir(sandbox.path("state/flights")).into_iter().flatten().flatten();
    let mut names: Vec<String> =
        entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Returns the rows of the list.
fn flights(sandbox: &Sandbox) -> Vec<serde_json::Value> {
    let out = sandbox.run(&["flights", "--json", "--state-dir", "state"]).exits(0).out;
    out.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect()
}

#[test]
fn the_screen_records_its_flights_and_lists_them() {
    let sandbox = Sandbox::new();
    let land = plan("land.toml");
    let mut screen = Dialogue::start(&sandbox, &[&PLAIN[..], &[land.as_str()]].concat());
    screen.say("flight.fly");
    screen.hear("Disarmed: landed.");
    screen.say("record so-far.flight");
    screen.hear("The flight so far is recorded as ");
    screen.say("record so-far.flight");
    screen.hear("exists already: name another file, `:record FILE`.");
    screen.say("quit");
    assert_eq!(screen.end(), Some(0));
    let names = library(&sandbox);
    assert!(names.len() == 1 && names[0].ends_with("-land.flight"), "{names:?}");
    let row = &flights(&sandbox)[0];
    assert_eq!((row["plan"].as_str(), row["result"].as_str()), (Some("land"), Some("complete")), "{row}");
    assert!(row["flown_s"].as_f64().expect("a duration") > 20.0 && row["hash"].is_string(), "{row}");
    let table = sandbox.run(&["flights", "--state-dir", "state"]).exits(0).out;
    assert!(table.lines().nth(1).expect("a row").ends_with(&names[0]), "{table}");
    for name in [&format!("state/flights/{}", names[0]), "so-far.flight"] {
        let recording = read(&sandbox, name);
        assert_eq!((recording.rest, recording.left_out, recording.only_pictures()), (Rest::Whole, 0, None));
        assert_eq!(fly_again(&recording), None, "{name}");
    }
    let own = format!("state/flights/{}", names[0]);
    let ran = sandbox.run(&["fly", "land", "--state-dir", "state", "--record", &own]).exits(2);
    assert!(ran.err.contains("would overwrite a recorded flight"), "{}", ran.err);
}

#[test]
fn a_killed_screen_leaves_the_flight_so_far_in_the_library() {
    let sandbox = Sandbox::new();
    let land = plan("land.toml");
    let mut screen =
        Dialogue::start(&sandbox, &[&PLAIN[..2], &["--speed=20", PLAIN[3], land.as_str()]].concat());
    screen.say("flight.fly");
    let bytes = || {
        let file = library(&sandbox).first().map(|name| sandbox.path(&format!("state/flights/{name}")));
        file.and_then(|file| file.metadata().ok()).map_or(0, |file| file.len())
    };
    until("some of the flight", || bytes() > 30_000);
    assert_eq!(flights(&sandbox)[0]["result"].as_str(), Some("recording"));
    drop(screen);
    let row = flights(&sandbox).remove(0);
    assert_eq!(row["result"].as_str(), Some("cut short"), "{row}");
    assert!(row["flown_s"].as_f64().expect("a duration") > 1.0, "{row}");
    let recording = read(&sandbox, &format!("state/flights/{}", library(&sandbox)[0]));
    assert_eq!(fly_again(&recording), None);
}

#[test]
fn nothing_is_recorded_without_a_library_or_a_flight() {
    let sandbox = Sandbox::new();
    let land = plan("land.toml");
    let mut screen =
        Dialogue::start(&sandbox, &[&PLAIN[..], &["--recordings-max-mb=0", land.as_str()]].concat());
    screen.say("flight.fly");
    screen.hear("Disarmed: landed.");
    // The flight can be written all the same.
    screen.say("record so-far.flight");
    screen.hear("The flight so far is recorded as ");
    screen.say("quit");
    assert_eq!(screen.end(), Some(0));
    assert_eq!(library(&sandbox), [""; 0]);
    let ran = sandbox.run(&["flights", "--state-dir", "state"]).exits(0);
    assert!(ran.out.is_empty() && ran.err.starts_with("No flights yet"), "{}", ran.err);
    sandbox.run(&["flights", "--state-dir", "nowhere"]).exits(2);
}

#[cfg(unix)]
#[test]
fn a_recorded_flight_opens_on_the_screen_and_is_flown_on() {
    let sandbox = Sandbox::new();
    let land = plan("land.toml");
    sandbox.run(&["fly", &land, "--record", "a.flight", "--wind", "3@250"]).exits(0);
    let file = sandbox.path("a.flight").display().to_string();
    let mut terminal = crate::binary::pty::Terminal::betadeck(160, 40, &["open", &file, "--at", "6"]);
    terminal.until_shown("fly on");
    terminal.send(":speed 20\rb");
    terminal.until_shown("the same to the last bit");
    terminal.until_shown("Disarmed: landed");
    let written = sandbox.path("flown-on.flight").display().to_string();
    terminal.send(&format!(":record {written}\r"));
    terminal.until_shown("is recorded as");
    terminal.send("q");
    terminal.until("the question or the end", |terminal| {
        !terminal.is_alternate() || terminal.screen().contains("uit")
    });
    terminal.signal("TERM");
    terminal.end();
    assert_eq!(fly_again(&read(&sandbox, "flown-on.flight")), None);
}

#[test]
fn a_log_that_is_opened_is_refused_with_the_command_that_shows_it() {
    let sandbox = Sandbox::new();
    std::fs::write(sandbox.path("a.bbl"), test_support::MadeLog::default().bytes()).expect("a file");
    let ran = sandbox.run(&["open", "a.bbl", "--plain"]).exits(2);
    assert!(
        ran.err.contains("a.bbl is a blackbox log") && ran.err.contains("`betadeck replay a.bbl`"),
        "{}",
        ran.err
    );
}

#[cfg(unix)]
#[test]
fn a_file_that_is_no_recording_is_refused_with_the_reason() {
    let sandbox = Sandbox::new();
    std::fs::write(sandbox.path("noise.flight"), [0x1f, 0x8b, 8, 0, 1, 2, 3]).expect("a file");
    let file = sandbox.path("noise.flight").display().to_string();
    let mut terminal = crate::binary::pty::Terminal::betadeck(160, 40, &["open", &file]);
    terminal.until_shown("it is not a recording of a flight");
    terminal.end();
}
