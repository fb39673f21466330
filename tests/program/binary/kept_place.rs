//! The screen that comes back over a craft, of a flight that `open` has flown, and of a recorded flight, with its place.

use crate::binary::connect::Craft;
use crate::binary::pty::Terminal;
use crate::binary::support::{PROGRAM, Sandbox};
use test_support::MadeLog;

const PLAN: &str = "waypoint insert 0 40.4635 -79.5182 500 0 LAND 0 NONE\n";

fn start(home: Sandbox, arguments: &[&str]) -> Terminal {
    Terminal::start_in(home, 120, 40, PROGRAM, arguments)
}

/// Quits, also if there is a question, or kills the program. Returns its home directory.
fn ended(mut terminal: Terminal, kill: bool) -> Sandbox {
    if kill {
        terminal.signal("KILL");
    } else {
        terminal.send("q");
    }
    terminal.end();
    terminal.into_home()
}

/// Waits until a file of the kept screen has a text. `of` is the beginning of its name.
fn until_kept(terminal: &mut Terminal, of: &str, text: &str) {
    let folder = terminal.home().path(".state/betadeck/screens");
    terminal.until("the screen is kept", |_| {
        let entries = std::fs::read_dir(&folder).into_iter().flatten().flatten();
        let mut of_kind = entries
            .filter(|entry| entry.file_name().to_string_lossy().starts_with(of))
            .map(|entry| entry.path());
        of_kind.any(|path| std::fs::read_to_string(path).is_ok_and(|kept| kept.contains(text)))
    });
}

fn is_zoomed_on_graphs(terminal: &Terminal) -> bool {
    let screen = terminal.screen();
    screen.contains("▸6 Graphs") && !screen.contains("┌1 Map")
}

/// Returns the shown instant on the clock of the craft.
fn clock(terminal: &Terminal) -> String {
    let row = terminal.row(1);
    row.split_whitespace().find(|word| word.contains(':')).unwrap_or_default().to_owned()
}

/// Returns the kept form of an instant in the first minute.
fn at(clock: &str) -> String {
    let digits: String = clock.chars().skip_while(|c| *c != ':').filter(char::is_ascii_digit).collect();
    format!("\"at_us\": {}", digits.trim_start_matches('0'))
}

fn is_paused(terminal: &Terminal) -> bool {
    terminal.row(1).contains('‖')
}

#[test]
fn a_log_comes_back_at_the_instant_that_was_left_and_another_log_at_its_beginning() {
    let mut home = Sandbox::new();
    let logs = ["One", "Two"].map(|craft| MadeLog { craft, ..MadeLog::default() }.bytes());
    std::fs::write(home.path("all.bbl"), logs.concat()).expect("a file");
    std::fs::write(home.path("other.bbl"), MadeLog::default().bytes()).expect("a file");
    for kill in [true, false] {
        let mut terminal = start(home, &["replay", "all.bbl", "--fresh-screen"]);
        terminal.until_shown("REPLAY 1/2");
        terminal.send("\u{1b}[1;3C");
        terminal.until_shown("REPLAY 2/2");
        terminal.send(";");
        terminal
            .until("the first event", |terminal| is_paused(terminal) && clock(terminal).contains("00:24"));
        terminal.send("6z");
        terminal.until("zoomed graphs", is_zoomed_on_graphs);
        if kill {
            until_kept(&mut terminal, "replay-", "\"at_us\": 24");
            until_kept(&mut terminal, "replay.json", "\"zoomed\": true");
        }
        home = ended(terminal, kill);

        let mut terminal = start(home, &["replay", "all.bbl"]);
        terminal.until_shown("As you left it: at 24.0 s since boot.");
        terminal.until("the second flight, paused at its instant", |terminal| {
            terminal.row(1).contains("REPLAY 2/2") && is_paused(terminal) && clock(terminal).contains("00:24")
        });
        assert!(is_zoomed_on_graphs(&terminal), "{}", terminal.screen());
        home = ended(terminal, false);
    }

    // The panels are those of the last replay, the place is not.
    let mut terminal = start(home, &["replay", "other.bbl"]);
    terminal.until("it plays", |terminal| terminal.row(1).contains("REPLAY") && !is_paused(terminal));
    assert!(is_zoomed_on_graphs(&terminal), "{}", terminal.screen());
    assert!(!terminal.screen().contains("As you left it"), "{}", terminal.screen());
    home = ended(terminal, false);

    // The command line comes first.
    let mut terminal = start(home, &["replay", "all.bbl", "--log", "1"]);
    terminal
        .until("the first flight", |terminal| terminal.row(1).contains("REPLAY 1/2") && !is_paused(terminal));
    home = ended(terminal, false);

    // A flight has its own screen.
    let mut terminal = start(home, &["--no-ports"]);
    terminal.until_shown("DISARMED");
    assert!(terminal.screen().contains("▸1 Map"), "{}", terminal.screen());
    ended(terminal, false);
}

#[test]
fn a_flight_that_is_opened_again_shows_the_instant_that_was_left_until_it_flies_differently() {
    let mut home = Sandbox::new();
    home.write("near.txt", PLAN);
    let scenario = "format = 1\n[plan]\nfile = \"near.txt\"\n[craft]\ntakeoff_m = 5\n";
    home.write("near.toml", scenario);
    home.run(&["fly", "near.txt", "--record", "near.flight"]).exits(0);
    for (file, otherwise) in [("near.toml", &["--at", "boot+4"][..]), ("near.flight", &["--fresh-screen"])] {
        let mut terminal = start(home, &["open", file, "--fresh-screen"]);
        terminal.until("the end", |terminal| !clock(terminal).is_empty());
        let end = clock(&terminal);
        terminal.send(",");
        terminal.until("an earlier event", |terminal| clock(terminal) != end);
        terminal.send("6z");
        terminal.until("zoomed graphs", is_zoomed_on_graphs);
        let left = clock(&terminal);
        until_kept(&mut terminal, "open-", &at(&left));
        until_kept(&mut terminal, "open.json", "\"zoomed\": true");
        home = ended(terminal, true);

        let mut terminal = start(home, &["open", file]);
        terminal.until_shown("As you left it: at ");
        terminal.until("the instant", |terminal| clock(terminal) == left);
        assert!(is_zoomed_on_graphs(&terminal), "{}", terminal.screen());
        terminal.signal("TERM");
        terminal.end();
        home = terminal.into_home();

        let mut terminal = start(home, &[&["open", file], otherwise].concat());
        terminal.until("another instant", |terminal| !clock(terminal).is_empty() && clock(terminal) != left);
        assert!(!terminal.screen().contains("As you left it"), "{}", terminal.screen());
        home = ended(terminal, true);
    }
    home.write("near.toml", &scenario.replace("= 5", "= 6"));
    let mut terminal = start(home, &["open", "near.toml"]);
    terminal.until("the end", |terminal| !clock(terminal).is_empty());
    assert!(!terminal.screen().contains("As you left it"), "{}", terminal.screen());
    ended(terminal, true);
}

#[test]
fn a_craft_comes_back_with_the_plan_that_was_open_over_it_and_another_craft_with_the_panels() {
    let crafts = [Craft::start(), Craft::start()];
    let places = crafts.each_ref().map(|craft| format!("tcp:{}", craft.address));
    let mut home = Sandbox::new();
    home.write("mine.txt", PLAN);
    for kill in [true, false] {
        let mut terminal = start(home, &["mine.txt", "--connect", &places[0], "--fresh-screen"]);
        terminal.until_shown("answers: Betaflight");
        terminal.send("6z");
        terminal.until("zoomed graphs", is_zoomed_on_graphs);
        if kill {
            until_kept(&mut terminal, "connect-", "mine.txt");
            until_kept(&mut terminal, "connect.json", "\"zoomed\": true");
        }
        home = ended(terminal, kill);
        for (place, plan) in [(&places[1], "Plan — new"), (&places[0], "Plan — mine.txt")] {
            let mut terminal = start(home, &["--connect", place]);
            terminal.until_shown("DISARMED");
            assert!(is_zoomed_on_graphs(&terminal), "{}", terminal.screen());
            terminal.send("2");
            terminal.until_shown(plan);
            terminal.send("6");
            terminal.until("zoomed graphs again", is_zoomed_on_graphs);
            home = ended(terminal, false);
        }
    }
    let mut terminal = start(home, &["--connect", &places[0], "--fresh-screen"]);
    terminal.until_shown("answers: Betaflight");
    assert!(terminal.screen().contains("▸1 Map"), "{}", terminal.screen());
    ended(terminal, false);
}
