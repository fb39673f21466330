//! `betadeck replay` of recordings: on the screen, beside a log, and as files.

use crate::binary::pty::Terminal;
use crate::binary::support::{PROGRAM, Sandbox};
use test_support::MadeLog;

/// Returns a home directory with a recording of the first 25 s of a flight, and its samples.
fn with_recording() -> Sandbox {
    let sandbox = Sandbox::new();
    let files = ["--record", "a.flight", "--csv", "flown.csv", "--timeout", "25"];
    sandbox.run(&[&["fly", "square"], &files[..]].concat()).exits(1);
    sandbox
}

fn started(sandbox: Sandbox, arguments: &[&str]) -> Terminal {
    let mut terminal = Terminal::start_in(sandbox, 120, 40, PROGRAM, &[&["replay"], arguments].concat());
    terminal.until_shown("REPLAY");
    terminal
}

#[test]
fn a_recording_is_shown_with_the_states_of_its_autopilot() {
    let mut terminal = started(with_recording(), &["a.flight", "--at", "boot+24"]);
    terminal.until_shown("▐APPROACHING▌");
    terminal.until("its track, its plan and its modes", |terminal| {
        let screen = terminal.screen();
        screen.contains("⌂home") && screen.contains("◆0 FLYOVER") && terminal.row(0).contains("AUTOPILOT")
    });
    terminal.send("6z/");
    terminal.until_shown("est_north");
    terminal.send("\u{1b}");
    terminal.until("the list is closed", |terminal| !terminal.screen().contains("Signals —"));
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
    terminal.assert_given_back();
}

#[test]
fn the_last_instant_of_a_recorded_flight_is_complete_and_disarmed() {
    let sandbox = Sandbox::new();
    sandbox.run(&["fly", "land", "--record", "a.flight"]).exits(0);
    let at_the_end = ["replay", "a.flight", "--at", "boot+999", "--plain"];
    let seen = sandbox.run_with(&at_the_end, "view.state\nquit\n").exits(0).out;
    for line in ["The end of the recorded flight a.flight.", "State: COMPLETE.", "Disarmed, ANGLE;"] {
        assert!(seen.contains(line), "{line} in {seen}");
    }
}

#[test]
fn the_plan_panel_of_a_replay_shows_the_plan_that_was_flown() {
    let sandbox = Sandbox::new();
    sandbox.run(&["fly", "land", "--record", "a.flight"]).exits(0);
    let seen = sandbox.run_with(&["replay", "a.flight", "--plain"], "view.plan\nquit\n").exits(0).out;
    let flown =
        sandbox.run_with(&["land", "--fresh", "--no-ports", "--plain"], "view.plan\nquit\ny\n").exits(0).out;
    let waypoints = |text: &str| -> Vec<String> {
        let columns = |line: &str| {
            line.split_whitespace().take(5).collect::<Vec<_>>().join(" ").replace(['[', ']'], "")
        };
        text.lines()
            .skip_while(|line| !line.starts_with("Plan"))
            .filter(|line| line.contains("LAND"))
            .map(columns)
            .collect()
    };
    assert_eq!(waypoints(&seen), ["0 LAND 40.4636797 -79.5182000 12.0"], "{seen}");
    assert_eq!(waypoints(&seen), waypoints(&flown), "{seen} {flown}");
}

#[test]
fn a_replay_leaves_the_unsaved_edits_of_another_run_alone() {
    let mut terminal = Terminal::start_in(with_recording(), 120, 40, PROGRAM, &["--no-ports", "square"]);
    terminal.until_shown("DISARMED");
    terminal.send("2i");
    terminal.until_shown("unsaved");
    terminal.send("qy");
    assert_eq!(terminal.end(), 0);
    let mut terminal = started(terminal.into_home(), &["a.flight", "--at", "boot+24"]);
    terminal.until_shown("▐APPROACHING▌");
    assert!(!terminal.screen().contains("unsaved"), "{}", terminal.screen());
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
    let mut terminal = Terminal::start_in(terminal.into_home(), 120, 40, PROGRAM, &["--no-ports", "square"]);
    terminal.until_shown("✎ unsaved");
}

#[test]
fn a_recording_and_a_log_are_beside_each_other() {
    let sandbox = with_recording();
    std::fs::write(sandbox.path("b.bbl"), MadeLog::default().bytes()).expect("a writable directory");
    let mut terminal = started(sandbox, &["a.flight", "b.bbl", "--at", "boot+24"]);
    terminal.until_shown("b.bbl is aligned at the engagement of the autopilot.");
    terminal.send("6z");
    terminal.until_shown("Δ altitude m");
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
}

#[test]
fn a_recording_is_printed_and_written_for_other_programs() {
    let sandbox = with_recording();
    let printed = sandbox.run(&["replay", "a.flight", "--plain"]).exits(0).out;
    assert!(printed.contains("Recorded by betadeck ") && printed.contains("IDLE → APPROACHING"), "{printed}");
    let arguments = ["replay", "a.flight", "--csv", "a.csv", "--gpx", "a.gpx", "--kml", "a.kml"];
    let ran = sandbox.run(&arguments).exits(0);
    assert_eq!((ran.out.as_str(), ran.err.as_str()), ("", ""));
    // The same rows as those of the flight, within the four decimals of a recording.
    let (flown, written) = (sandbox.read("flown.csv"), sandbox.read("a.csv"));
    let columns = |text: &str| text.lines().next().unwrap_or_default().to_owned();
    assert_eq!(columns(&written), columns(&flown));
    let times = |text: &str| -> Vec<String> {
        text.lines().skip(1).filter_map(|row| row.split(',').nth(1)).map(str::to_owned).collect()
    };
    assert!(times(&written).len() > 150, "{}", times(&written).len());
    assert!(times(&written).iter().all(|time| times(&flown).contains(time)));
    assert!(sandbox.read("a.gpx").contains("<name>square</name>"));
    assert!(sandbox.read("a.kml").contains("<gx:Track>"));
    let slow = sandbox.run(&["replay", "a.flight", "--csv", "-", "--samples", "1"]).exits(0).out;
    assert_eq!(slow.lines().count(), 1 + 26);
}

#[test]
fn a_damaged_recording_is_shown_up_to_the_damage_or_refused() {
    let sandbox = with_recording();
    let bytes = std::fs::read(sandbox.path("a.flight")).expect("a recording");
    std::fs::write(sandbox.path("cut.flight"), &bytes[..bytes.len() / 2]).expect("a writable directory");
    let cut = sandbox.run(&["replay", "cut.flight", "--plain"]).exits(0).out;
    assert!(cut.contains("The recording ends early: it was cut short."), "{cut}");
    std::fs::write(sandbox.path("head.flight"), &bytes[..40]).expect("a writable directory");
    let refused = sandbox.run(&["replay", "head.flight", "--plain"]).exits(2);
    assert!(refused.err.starts_with("head.flight cannot be shown: "), "{}", refused.err);
    assert_eq!((refused.out.as_str(), refused.err.lines().count()), ("", 1));
    let other = sandbox.run(&["replay", "a.flight", "--log", "2", "--plain"]).exits(2);
    assert_eq!(other.err, "a.flight has only one flight.\n");
}
