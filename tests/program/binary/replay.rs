//! `betadeck replay`: blackbox logs as sentences, as files, and on the screen.

use crate::binary::pty::Terminal;
use crate::binary::support::Sandbox;
use test_support::MadeLog;

/// Returns a home directory with these files.
fn sandbox(files: &[(&str, Vec<u8>)]) -> Sandbox {
    let sandbox = Sandbox::new();
    for (name, bytes) in files {
        std::fs::write(sandbox.path(name), bytes).expect("a writable directory");
    }
    sandbox
}

/// Returns a home directory with a log of 20 s.
fn with_log() -> Sandbox {
    sandbox(&[("a.bbl", MadeLog::default().bytes())])
}

/// Starts a replay in a terminal, and waits until the flight is shown.
fn started(sandbox: Sandbox, (columns, rows): (u16, u16), arguments: &[&str]) -> Terminal {
    let arguments = [&["replay"], arguments].concat();
    let mut terminal =
        Terminal::start_in(sandbox, columns, rows, crate::binary::support::PROGRAM, &arguments);
    terminal.until_shown("REPLAY");
    terminal
}

/// Returns the shown instant, s.
fn shown_s(terminal: &Terminal) -> f64 {
    let clock = terminal.row(1);
    let words: Vec<&str> = clock.split_whitespace().collect();
    let at = words.iter().position(|word| *word == "REPLAY").and_then(|at| at.checked_sub(2));
    let (minutes, seconds) = at.and_then(|at| words[at].split_once(':')).unwrap_or(("0", "0"));
    minutes.parse::<f64>().unwrap_or(0.0) * 60.0 + seconds.parse::<f64>().unwrap_or(0.0)
}

#[test]
fn a_log_is_printed_as_sentences() {
    let ran = with_log().run(&["replay", "a.bbl", "--plain"]).exits(0);
    insta::assert_snapshot!(ran.out);
    assert_eq!(ran.err, "");
}

#[test]
fn damage_is_counted_at_the_start() {
    let log = MadeLog { damaged_at: Some(60_000), ..MadeLog::default() }.bytes();
    let sandbox = sandbox(&[("a.bbl", log)]);
    let ran = sandbox.run(&["replay", "a.bbl", "--plain"]).exits(0);
    let third = ran.out.lines().nth(2).unwrap_or_default();
    assert!(
        third.contains("The log is damaged: ") && third.contains("bytes belong to no frame"),
        "{}",
        ran.out
    );
    let written = sandbox.run(&["replay", "a.bbl", "--csv", "a.csv"]).exits(0);
    assert!(written.err.starts_with("The log is damaged: "), "{}", written.err);
}

#[test]
fn commands_are_answered_and_refused_without_a_screen() {
    let ran = with_log()
        .run_with(&["replay", "a.bbl", "--plain"], "flight.arm\nset ap_max_angle=20\nquit\n")
        .exits(0);
    let refusals =
        ran.out.matches("This is a recorded flight: it can be looked at, not flown or changed.").count();
    assert_eq!(refusals, 2, "{}", ran.out);
}

#[test]
fn values_and_the_track_go_to_files() {
    let sandbox = with_log();
    let arguments =
        ["replay", "a.bbl", "--csv", "a.csv", "--samples", "2", "--gpx", "a.gpx", "--kml", "a.kml"];
    let ran = sandbox.run(&arguments).exits(0);
    assert_eq!((ran.out.as_str(), ran.err.as_str()), ("", ""));
    let table = sandbox.read("a.csv");
    let header = table.lines().next().unwrap_or_default();
    assert!(header.starts_with("time (s),boot_time (s),modes,roll (°),"), "{header}");
    assert!(header.contains("gyroADC[0] (°/s)"), "{header}");
    assert_eq!(table.lines().count(), 1 + 40);
    let gpx = sandbox.read("a.gpx");
    assert_eq!(gpx.matches("<trkpt ").count(), 20);
    assert!(gpx.contains("<time>2026-05-01T10:00:00Z</time>"), "{gpx}");
    assert!(sandbox.read("a.kml").contains("<gx:Track>"));
    // Every frame, to standard output.
    let ran = sandbox.run(&["replay", "a.bbl", "--csv", "-"]).exits(0);
    assert_eq!(ran.out.lines().count(), 1 + 4000);
}

#[test]
fn a_log_without_a_gps_has_no_track_to_write() {
    let log = MadeLog { has_gps: false, ..MadeLog::default() }.bytes();
    let sandbox = sandbox(&[("a.bbl", log)]);
    let ran = sandbox.run(&["replay", "a.bbl", "--gpx", "a.gpx"]).exits(2);
    assert_eq!(ran.err, "a.bbl has no GPS, so there is no track to write\n");
    assert!(!sandbox.names().contains(&"a.gpx".to_owned()));
}

#[test]
fn no_output_replaces_the_log() {
    let sandbox = with_log();
    let before = std::fs::read(sandbox.path("a.bbl")).expect("the log");
    for option in ["--csv", "--gpx", "--kml"] {
        let ran = sandbox.run(&["replay", "a.bbl", option, "a.bbl"]).exits(2);
        assert!(ran.err.contains("the recorded flight"), "{}", ran.err);
    }
    assert_eq!(std::fs::read(sandbox.path("a.bbl")).expect("the log"), before);
}

#[test]
fn one_log_of_several_is_chosen_by_its_number() {
    let logs = ["One", "Two"].map(|craft| MadeLog { craft, seconds: 3, ..MadeLog::default() }.bytes());
    let sandbox = sandbox(&[("all.txt", logs.concat())]);
    let printed = |arguments: &[&str]| sandbox.run(&[&["replay", "all.txt", "--plain"], arguments].concat());
    let first = printed(&[]).exits(0).out;
    assert!(first.contains("flight 1 of 2"), "{first}");
    assert!(first.contains("all.txt has 2 logs: 1 of 3.0 s, 2 of 3.0 s."), "{first}");
    let second = printed(&["--log", "2"]).exits(0).out;
    assert!(second.contains("flight 2 of 2") && second.contains("craft Two"), "{second}");
    let refused = printed(&["--log", "3"]).exits(2);
    assert_eq!(refused.err, "all.txt has 2 logs: choose one from 1 to 2.\n");
    assert_eq!(sandbox.run(&["replay", "all.txt", "--log", "3", "--csv", "-"]).exits(2).err, refused.err);
    let written = sandbox.run(&["replay", "all.txt", "--csv", "-"]).exits(0);
    assert_eq!(written.err, "all.txt has 2 logs: log 1 is written; --log N chooses another one\n");
}

#[test]
fn what_is_no_log_is_refused_in_a_sentence() {
    let plan = b"waypoint insert 0\n".to_vec();
    let cut = MadeLog::default().bytes()[..200].to_vec();
    let sandbox = sandbox(&[("plan.txt", plan), ("empty.bbl", Vec::new()), ("cut.bbl", cut)]);
    std::fs::create_dir(sandbox.path("folder")).expect("a folder");
    for (file, code, said) in [
        ("plan.txt", 2, "plan.txt is no recorded flight: a blackbox log begins with the line `H Product:"),
        ("empty.bbl", 2, "empty.bbl is no recorded flight"),
        ("cut.bbl", 2, "Log 1 of cut.bbl cannot be shown: the file ends inside its header"),
        ("folder", 2, "folder is a directory, not a file"),
        ("missing.bbl", 3, "cannot open missing.bbl"),
        ("/dev/stdin", 2, "/dev/stdin is no file"),
    ] {
        let ran = sandbox.run(&["replay", file, "--plain"]).exits(code);
        assert!(ran.err.starts_with(said), "{file}: {}", ran.err);
        assert_eq!((ran.out.as_str(), ran.err.lines().count()), ("", 1), "{file}");
    }
}

#[test]
fn options_that_do_not_fit_are_refused() {
    let sandbox = with_log();
    for (arguments, said) in [
        (&["a.bbl"][..], "the user interface needs a terminal"),
        (&["a.bbl", "--samples", "5"], "--samples is the number of rows of a table"),
        (&["a.bbl", "--plain", "--csv", "-"], "both write to standard output"),
        (&["a.bbl", "a.bbl", "--csv", "-"], "name one file"),
        (&["a.bbl", "--at", "3", "--csv", "-"], "--at is an instant of the screen"),
        (&["a.bbl", "--log", "0"], "invalid value '0' for '--log"),
        (&["a.bbl", "--at", "-3", "--plain"], "is out of range"),
        (&["a.bbl", "a.bbl", "a.bbl"], "unexpected"),
        (&[], "required"),
    ] {
        let ran = sandbox.run(&[&["replay"], arguments].concat());
        assert!(
            ran.code.is_some_and(|code| code > 0) && ran.err.contains(said),
            "{arguments:?}: {}",
            ran.err
        );
    }
}

#[test]
fn a_log_plays_on_the_screen_with_rewind_speed_and_search() {
    for size in [(80, 24), (120, 40), (200, 60)] {
        let mut terminal = started(with_log(), size, &["a.bbl", "--at", "5"]);
        terminal.until("the fifth second", |terminal| (shown_s(terminal) - 25.0).abs() < 1e-9);
        terminal.until_shown("⌂");
        // Modes, then the end.
        terminal.send(";");
        terminal.until("the next event", |terminal| (shown_s(terminal) - 28.0).abs() < 1e-9);
        terminal.until("its modes", |terminal| terminal.row(0).contains("AUTOPILOT"));
        terminal.send(",");
        terminal.until("the event before", |terminal| (shown_s(terminal) - 24.0).abs() < 1e-9);
        terminal.send("F");
        terminal.until_shown("This is a recorded flight");
        terminal.send(" ");
        terminal.until("playing", |terminal| shown_s(terminal) > 24.3);
        terminal.send("]]]]]");
        terminal.until("the end", |terminal| shown_s(terminal) > 39.9 && terminal.row(1).contains('‖'));
        terminal.send("8/armed\r");
        terminal.until_shown("/armed");
        terminal.send("q");
        assert_eq!(terminal.end(), 0);
        terminal.assert_given_back();
    }
}

#[test]
fn series_of_a_log_are_graphs() {
    let mut terminal = started(with_log(), (120, 40), &["a.bbl", "--at", "boot+31"]);
    terminal.send("6z/");
    terminal.until_shown("loopIteration");
    terminal.send("debug");
    terminal.until_shown("debug[0]");
    terminal.send("\r\u{1b}");
    // The sawtooth from −250 to 249, once it is read.
    terminal.until("its axis", |terminal| terminal.screen().contains("269 ┤"));
    terminal.send("++++++");
    terminal.until_shown("100 ms");
    terminal.until("the axis of twenty frames", |terminal| !terminal.screen().contains("269 ┤"));
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
}

#[test]
fn the_logs_of_a_file_are_switched_by_keys() {
    let logs = ["One", "Two"].map(|craft| MadeLog { craft, seconds: 3, ..MadeLog::default() }.bytes());
    let mut terminal = started(sandbox(&[("all.bbl", logs.concat())]), (120, 40), &["all.bbl", "--at", "1"]);
    terminal.until_shown("REPLAY 1/2");
    terminal.send("\u{1b}[1;3C");
    terminal.until_shown("REPLAY 2/2");
    terminal.until_shown("craft Two");
    assert!(!terminal.screen().contains("craft One"), "{}", terminal.screen());
    terminal.send("\u{1b}[1;3C");
    terminal.until_shown("This is the last flight of the file, 2 of 2.");
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
}

#[test]
fn two_logs_are_beside_each_other() {
    let files = [
        ("a.bbl", MadeLog::default().bytes()),
        ("b.bbl", MadeLog { radius_m: 25.0, ..MadeLog::default() }.bytes()),
    ];
    let mut terminal = started(sandbox(&files), (120, 40), &["a.bbl", "b.bbl", "--at", "10"]);
    terminal.until_shown("b.bbl is aligned at the engagement of the autopilot.");
    terminal.until_shown("── a.bbl");
    terminal.send("6z");
    terminal.until_shown("Δ altitude m");
    terminal.send("\u{1b}[1;5C");
    terminal.until_shown("and 0.1 s later");
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
}

#[test]
fn windows_of_any_size_show_a_log() {
    let mut terminal = started(with_log(), (120, 40), &["a.bbl"]);
    for (columns, rows) in [(1, 1), (200, 60), (2, 50), (60, 20), (1, 1), (80, 24), (10, 3), (120, 40)] {
        terminal.resize(columns, rows);
        terminal.send("6");
        terminal.send("1");
    }
    terminal.until("the screen again", |terminal| {
        terminal.row(1).contains("REPLAY") && terminal.row(2).contains("Map")
    });
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
    terminal.assert_given_back();
}

#[test]
fn a_log_that_is_cut_while_it_plays_ends_nothing() {
    let log = MadeLog { seconds: 60, ..MadeLog::default() }.bytes();
    let mut terminal = started(sandbox(&[("a.bbl", log)]), (120, 40), &["a.bbl"]);
    let path = terminal.home().path("a.bbl");
    let file = std::fs::OpenOptions::new().write(true).open(&path).expect("the log");
    file.set_len(3000).expect("a shorter log");
    std::fs::remove_file(path).expect("no log");
    terminal.send("]]>>");
    terminal.until("it goes on", |terminal| shown_s(terminal) > 40.0);
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
    terminal.assert_given_back();
}

#[test]
fn hostile_names_and_headers_are_shown_without_their_control_characters() {
    let name = "x\u{1b}[31m\u{7}\u{202e}.bbl";
    let log = MadeLog { craft: "\u{1b}]0;owned\u{7}", ..MadeLog::default() }.bytes();
    let sandbox = sandbox(&[(name, log)]);
    let ran = sandbox.run(&["replay", name, "--plain"]).exits(0);
    assert!(!ran.out.contains(['\u{1b}', '\u{7}', '\u{202e}']), "{:?}", ran.out);
    assert!(ran.out.contains("owned"), "{}", ran.out);
    let mut terminal = started(sandbox, (80, 24), &[name]);
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
    assert!(!terminal.raw().contains("\u{1b}]0;owned"), "the title of the terminal is unchanged");
}

#[test]
fn a_full_disk_is_named_with_the_file() {
    if !std::path::Path::new("/dev/full").exists() {
        return;
    }
    for option in ["--csv", "--gpx", "--report"] {
        let ran = with_log().run(&["replay", "a.bbl", option, "/dev/full"]).exits(3);
        assert!(ran.err.contains("/dev/full: No space left"), "{option}: {}", ran.err);
    }
}
