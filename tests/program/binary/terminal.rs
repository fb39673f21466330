//! The user interface in a pseudo-terminal: a complete flight, window sizes, keys, and restoring the
//! terminal.

use betadeck::storage::Store;

use crate::binary::pty::Terminal;
use crate::binary::support::Sandbox;

/// The states of the demo plan in the order of its transitions.
const FLIGHT: [&str; 13] = [
    "IDLE",
    "APPROACHING",
    "ARRIVED",
    "APPROACHING",
    "ARRIVED",
    "APPROACHING",
    "ARRIVED",
    "HOLDING",
    "ORBITING",
    "APPROACHING",
    "ARRIVED",
    "LANDING",
    "COMPLETE",
];

/// The row of the status line with the state of the autopilot.
const MISSION: usize = 1;

/// Returns the state in the status line.
pub(crate) fn state(terminal: &Terminal) -> String {
    let row = terminal.row(MISSION);
    row.split_whitespace().nth(1).unwrap_or("").to_owned()
}

/// Returns the transitions in the log panel, the oldest first.
fn transitions(terminal: &Terminal) -> Vec<(String, String)> {
    let screen = terminal.screen();
    let found = screen.lines().filter_map(|line| {
        let (before, after) = line.split_once(" → ")?;
        let from = before.split_whitespace().last()?;
        let to = after.split_whitespace().next()?;
        let name = |word: &str| word.chars().all(|c| c.is_ascii_uppercase() || c == '8');
        (name(from) && name(to.trim_end_matches(':'))).then(|| (from.to_owned(), to.to_owned()))
    });
    let mut found: Vec<_> = found.collect();
    found.reverse();
    found
}

pub(crate) fn started(columns: u16, rows: u16, arguments: &[&str]) -> Terminal {
    let mut terminal = Terminal::betadeck(columns, rows, &[arguments, &["--no-ports"]].concat());
    terminal.until_shown("DISARMED");
    terminal
}

#[test]
fn the_whole_flight_by_keys() {
    let before = Terminal::start(120, 50, "cat", &[]).discipline();
    let mut terminal = started(120, 50, &[]);
    assert_ne!(terminal.discipline(), before, "raw mode");
    // Shows the log alone on the screen.
    terminal.send("8z");
    terminal.until("the zoomed log", |terminal| {
        terminal.row(2).contains("Log") && !terminal.screen().contains("1 Map─")
    });
    terminal.send("F");
    terminal.until_shown("GPS fix");
    // At 32 times real time a second of orbit is some frames, and the landing takes seconds.
    terminal.send("]]]]]");
    let mut seen = vec![state(&terminal)];
    terminal.watch("DISARMED after COMPLETE", |terminal| {
        let now = state(terminal);
        // Half a frame may show half a name.
        if FLIGHT.contains(&now.as_str()) && seen.last() != Some(&now) {
            seen.push(now);
        }
        seen.iter().any(|state| state == "COMPLETE") && terminal.row(0).contains("DISARMED")
    });
    // Every state that lasts longer than a frame was in the status line, in the order of the flight.
    let mut order = FLIGHT.iter();
    assert!(seen.iter().all(|state| order.any(|next| next == state)), "{seen:?}");
    for state in ["IDLE", "APPROACHING", "ORBITING", "LANDING", "COMPLETE"] {
        assert!(seen.iter().any(|name| name == state), "no {state} in {seen:?}");
    }
    // The log has all states, with those that last one step. A frame may still be on its way.
    let expected: Vec<_> = FLIGHT.windows(2).map(|pair| (pair[0].to_owned(), pair[1].to_owned())).collect();
    terminal.until(&format!("{expected:?}"), |terminal| transitions(terminal) == expected);
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
    terminal.assert_given_back();
    assert_eq!(terminal.discipline(), before);
}

#[test]
fn flying_by_hand_takes_off_comes_down_and_disarms() {
    let mut terminal = started(120, 40, &[]);
    terminal.send("]]]");
    terminal.until_shown("has no plan.");
    terminal.send("U");
    terminal.until_shown("Ready.");
    terminal.send("a");
    terminal.until_shown("● ARMED");
    terminal.send("t");
    terminal.until_shown("Armed, on the ground");
    terminal.send("g");
    terminal.until_shown("◆ APPROACHING");
    terminal.send("q");
    terminal.until_shown("Quit?");
    terminal.send("n");
    terminal.send("g");
    terminal.until_shown("Holds its place");
    terminal.send("H");
    terminal.until_shown("stop return");
    terminal.send("H");
    terminal.until_shown("Holds its place");
    terminal.send("t");
    terminal.until_shown("Coming down");
    terminal.until_shown("Armed, on the ground");
    terminal.send("a");
    terminal.until_shown("○ DISARMED");
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
    terminal.assert_given_back();
}

#[test]
fn a_plan_file_can_be_named() {
    let mut terminal = started(120, 40, &[&crate::binary::support::plan("hold-figure8.toml")]);
    terminal.send("F]]]]]]]]]]");
    terminal.until_shown("FIGURE8");
    terminal
        .until("a landing", |terminal| state(terminal) == "COMPLETE" && terminal.row(0).contains("DISARMED"));
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
    terminal.assert_given_back();
}

#[test]
fn a_broken_plan_file_is_reported_without_taking_the_terminal() {
    let mut terminal = Terminal::start(
        80,
        24,
        "/bin/sh",
        &["-c", &format!("echo nonsense = > bad.toml; {} bad.toml", crate::binary::support::PROGRAM)],
    );
    assert_eq!(terminal.end(), 2);
    assert!(terminal.screen().contains("bad.toml:1:"), "{}", terminal.screen());
    assert!(!terminal.raw().contains("\x1b[?1049h"));
}

#[test]
fn quitting_in_flight_asks_first() {
    let mut terminal = started(80, 24, &[]);
    terminal.send("F]]]]");
    terminal.until("an armed craft", |terminal| terminal.row(0).contains("● ARMED"));
    terminal.send("q");
    terminal.until("the question", |terminal| terminal.screen().to_lowercase().contains("quit?"));
    terminal.send("n");
    terminal.until("no question", |terminal| !terminal.screen().to_lowercase().contains("quit?"));
    terminal.send("q");
    terminal.until("the question", |terminal| terminal.screen().to_lowercase().contains("quit?"));
    terminal.send("y");
    assert_eq!(terminal.end(), 0);
    terminal.assert_given_back();
}

#[test]
fn ctrl_c_twice_quits_from_anywhere() {
    // At the map, in the command line with text, in the help, and in flight.
    for (keys, shown) in [("", "help"), ("5set ap", "set ap"), ("?", "Keys"), ("F]]]", "● ARMED")] {
        let mut terminal = started(80, 24, &[]);
        terminal.send(keys);
        terminal.until_shown(shown);
        terminal.send("\x03");
        terminal.until("the hint", |terminal| terminal.screen().contains("Ctrl-C"));
        terminal.send("\x03");
        assert_eq!(terminal.end(), 0, "after {keys:?}");
        terminal.assert_given_back();
    }
}

#[test]
fn every_size_is_survived_in_flight() {
    let mut terminal = started(80, 24, &[]);
    terminal.send("F]]]]");
    terminal.until("an armed craft", |terminal| terminal.row(0).contains("ARMED"));
    for (columns, rows) in
        [(200, 60), (20, 5), (1, 1), (300, 2), (2, 100), (59, 20), (60, 19), (60, 20), (120, 40)]
    {
        terminal.resize(columns, rows);
        if columns >= 60 && rows >= 20 {
            terminal.until("the status line", |terminal| terminal.row(0).contains("ARMED"));
        } else if columns >= 20 && rows >= 5 {
            terminal.until("the needed size", |terminal| terminal.screen().contains("60"));
        }
    }
    terminal.until("the map in full", |terminal| terminal.row(39).contains("help"));
    // Quitting also works in a window that is too small.
    terminal.resize(10, 3);
    terminal.send("\x03\x03");
    assert_eq!(terminal.end(), 0);
    terminal.assert_given_back();
}

#[test]
fn a_storm_of_sizes_is_survived_in_flight_and_the_terminal_is_given_back_on_a_signal() {
    let mut terminal = started(120, 40, &["--fresh"]);
    terminal.send("F]]]");
    terminal.until("the mission", |terminal| state(terminal) == "APPROACHING");
    let mut at: u32 = 3;
    let mut next = |most: u32| {
        at = at.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        1 + (at >> 8) % most
    };
    // The sizes change faster than frames are drawn. Each storm hits another panel, popup, prompt or text
    // field.
    let keys = [
        "1", "2", "3", "6z", "7", "8", "?", "\x1b\x1b", "2z", "\x10", "\x10wi", ":w", "5set", "2S", "2Sname",
        "2o", "2P", "2E", "8/wind", "G", "w", "9", "9/vel", "9\r", "9X", "9w9", "q",
    ];
    for keys in keys {
        terminal.send(keys);
        for round in 0..60 {
            // Every other window is smaller than any panel.
            let (columns, rows) = if round % 2 == 0 { (250, 80) } else { (90, 4) };
            terminal.resize(next(columns) as u16, next(rows) as u16);
        }
        // Frames for sizes other than the emulator's pass by here.
        terminal.resize(80, 24);
        terminal.send("\x1b\x1b\x1b\x1b\x1b[19~");
        terminal.until("a whole screen", |terminal| {
            terminal.row(0).contains("ARMED")
                && terminal.screen().contains("▸8 Log")
                && terminal.row(23).contains("q quit")
        });
    }
    terminal.signal("TERM");
    assert_eq!(terminal.end(), 130);
    terminal.assert_given_back();
}

#[test]
fn look_ahead_and_what_if_are_flown_by_keys_in_flight() {
    for (columns, rows) in [(80, 24), (120, 40)] {
        let mut terminal = started(columns, rows, &["--fresh", "land"]);
        terminal.send("F]]");
        terminal.until("the mission", |terminal| state(terminal) == "APPROACHING");
        terminal.send(" ");
        terminal.until("a pause", |terminal| terminal.row(MISSION).contains('‖'));
        terminal.send("L");
        terminal.until_shown("look-ahead: COMPLETE in ");
        terminal.send("L");
        terminal.until("no look-ahead", |terminal| !terminal.screen().contains("look-ahead"));
        terminal.send("w");
        terminal.until_shown("What if, from this instant on:");
        terminal.send("\r");
        terminal.until_shown("GPS lost here: ");
        terminal.until("its end", |terminal| terminal.screen().contains("% left"));
        terminal.send("\x1b");
        terminal.until("none on the map", |terminal| !terminal.row(3).contains("GPS lost here"));
        // The flight itself continues unchanged.
        assert!(terminal.row(0).contains("3D"), "{}", terminal.screen());
        terminal.send("qy");
        assert_eq!(terminal.end(), 0);
        terminal.assert_given_back();
    }
}

#[test]
fn signals_give_the_terminal_back() {
    let before = Terminal::start(80, 24, "cat", &[]).discipline();
    for signal in ["TERM", "INT", "HUP"] {
        let mut terminal = started(80, 24, &[]);
        terminal.signal(signal);
        assert_eq!(terminal.end(), 130, "{signal}");
        terminal.assert_given_back();
        assert_eq!(terminal.discipline(), before);
    }
}

#[test]
fn the_shell_finds_its_line_discipline_unchanged() {
    let script =
        format!("stty -g; {} --no-ports; echo \"exit $?\"; stty -g", crate::binary::support::PROGRAM);
    let mut terminal = Terminal::start(80, 24, "/bin/sh", &["-c", &script]);
    terminal.until_shown("DISARMED");
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
    terminal.assert_given_back();
    assert!(terminal.screen().contains("exit 0"), "{}", terminal.screen());
    let screen = terminal.screen();
    let lines: Vec<&str> = screen.lines().filter(|line| line.matches(':').count() > 20).collect();
    // The emulator joins a long line that was wrapped.
    assert_eq!(lines.len(), 2, "{screen}");
    assert_eq!(lines[0], lines[1]);
}

#[test]
fn a_panic_gives_the_terminal_back_before_it_is_reported() {
    let itself = std::env::current_exe().expect("this test");
    let arguments =
        ["--ignored", "--exact", "binary::terminal::panics_with_the_terminal_taken", "--nocapture"];
    let mut terminal = Terminal::start(80, 24, itself.to_str().expect("a plain path"), &arguments);
    let before = Terminal::start(80, 24, "cat", &[]).discipline();
    assert_eq!(terminal.end(), 0, "{}", terminal.raw());
    terminal.assert_given_back();
    assert_eq!(terminal.discipline(), before);
    let raw = terminal.raw();
    let taken = raw.find("\x1b[?1049h").expect("the alternate screen");
    let left = raw.find("\x1b[?1049l").expect("the ordinary screen");
    let reported = raw.find("everything is wrong").expect("the message");
    assert!(taken < left && left < reported, "{raw:?}");
}

/// Runs in its own terminal, started by the test above.
#[test]
#[ignore = "takes the terminal it is run in; run by another test"]
#[should_panic(expected = "everything is wrong")]
fn panics_with_the_terminal_taken() {
    let _tui = betadeck::ui::Tui::enter(true).expect("a terminal");
    panic!("everything is wrong");
}

#[test]
fn colours_and_glyphs_can_be_left_out() {
    let script = format!("NO_COLOR=1 {} --no-ports", crate::binary::support::PROGRAM);
    let mut terminal = Terminal::start(80, 24, "/bin/sh", &["-c", &script]);
    terminal.until_shown("DISARMED");
    terminal.until_shown("help");
    let raw = terminal.raw();
    for colour in ["\x1b[31m", "\x1b[32m", "\x1b[33m", "\x1b[38;", "\x1b[48;"] {
        assert!(!raw.contains(colour), "{colour:?}");
    }
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
}

#[test]
fn a_paste_of_garbage_into_the_command_line_breaks_nothing() {
    let mut terminal = started(120, 40, &[]);
    terminal.send("5");
    terminal.until_shown("Enter run");
    let garbage = "waypoint insert\nset\n\u{fffd}\u{7f}äöü 漢字 \u{1f6e9}\nset ap_max_angle = 9999999999999999999\n\
                   waypoint insert 0 nan inf 1e400 -1 ORBIT LAND 65536\nversion\n";
    terminal.send(&format!("\x1b[200~{garbage}\x1b[201~"));
    terminal.until_shown("ERROR");
    terminal.until("the last line's answer", |terminal| terminal.screen().contains("Betaflight"));
    // A long line without an end.
    terminal.send(&format!("\x1b[200~{}\x1b[201~", "x".repeat(20_000)));
    terminal.send("\x03\x03");
    assert_eq!(terminal.end(), 0);
    terminal.assert_given_back();
}

#[test]
fn a_paste_of_a_thousand_lines_runs_them_all_in_their_order() {
    for (columns, rows) in [(80, 24), (120, 40)] {
        let mut terminal = started(columns, rows, &["--fresh"]);
        terminal.send("5");
        terminal.until_shown("Enter run");
        let mut lines: String =
            (0..999).map(|line| format!("set ap_max_angle = {}\n", 20 + line % 30)).collect();
        lines.push_str("set ap_max_angle = 55\n");
        terminal.send(&format!("\x1b[200~{lines}\x1b[201~"));
        terminal.until_shown("ap_max_angle set to 55");
        let screen = terminal.screen();
        let answers = screen.lines().filter_map(|line| line.split_once("set to ")?.1.get(..2));
        let sets: Vec<&str> = answers.collect();
        let last = ["26", "27", "28", "55"];
        assert!(sets.ends_with(&last), "{sets:?}\n{screen}");
        terminal.send("\x1b\x1bq");
        assert_eq!(terminal.end(), 0);
        terminal.assert_given_back();
    }
}

#[test]
fn any_keys_and_clicks_leave_a_program_that_can_be_left() {
    // Every key of the help, arrows, function keys, clicks, drags and wheels, always in the same order.
    let named = [
        "\x1b[A",
        "\x1b[B",
        "\x1b[C",
        "\x1b[D",
        "\x1b[5~",
        "\x1b[6~",
        "\x1b[H",
        "\x1b[F",
        "\x1b[Z",
        "\x1bOP",
        "\x1b[1;2C",
        "\x1b[1;2D",
        "\r",
        "\t",
        // A single Escape begins any of the other sequences. Two are the key itself.
        "\x1b\x1b",
        " ",
        "\x7f",
    ];
    let mut keys: Vec<String> = named.map(str::to_owned).to_vec();
    keys.extend(('!'..='~').filter(|key| *key != 'q').map(String::from));
    for (column, row) in [(1, 1), (10, 10), (70, 8), (40, 20), (120, 50), (500, 500)] {
        for button in [0, 2, 32, 64, 65] {
            keys.push(format!("\x1b[<{button};{column};{row}M"));
            keys.push(format!("\x1b[<{button};{column};{row}m"));
        }
    }
    for (columns, rows) in [(60, 20), (80, 24), (200, 60)] {
        let mut terminal = started(columns, rows, &[]);
        let mut at: usize = 7;
        for round in 0..6 {
            for _ in 0..100 {
                at = at.wrapping_mul(1_664_525).wrapping_add(1_013_904_223) % (1 << 31);
                terminal.send(&keys[(at >> 8) % keys.len()]);
            }
            // Leaves any open popup and focuses a panel. When the panel has the focus, all earlier keys have
            // been handled.
            let (key, title) = if round % 2 == 0 { ("\x1b[19~", "▸8 Log") } else { ("\x1bOS", "▸4 RC") };
            terminal.send(&format!("\x1b\x1b\x1b\x1b{key}"));
            terminal.until_shown(title);
        }
        terminal.send("\x03\x03");
        assert_eq!(terminal.end(), 0);
        terminal.assert_given_back();
    }
}

#[test]
fn a_second_one_in_the_same_directory_says_that_it_cannot_save() {
    let folder = Sandbox::new();
    let directory = folder.path("state");
    let first = Store::open(&directory, false).expect("a store");
    let mut terminal = started(120, 40, &["--state-dir", directory.to_str().expect("a name")]);
    terminal.send("8z");
    terminal.until_shown("`save` cannot work: another betadeck uses");
    drop(first);
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
}
