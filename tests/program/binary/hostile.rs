//! Hostile text in messages on a terminal. The terminal must not obey any of it.

use crate::binary::pty::Terminal;
use crate::binary::support::{PROGRAM, Sandbox};

/// Text that sets the window title, the colour magenta and the direction of writing, clears the screen in two
/// ways, and rings the bell.
const HOSTILE: &str = "\u{1b}]0;owned\u{7}\u{1b}[35m\u{9b}2J\u{1b}[2J\u{202e}";

/// Asserts that the terminal received no control sequence of the hostile text, and that the text was shown in
/// some form.
#[track_caller]
fn assert_harmless(raw: &str, what: &str) {
    for sequence in ["\u{1b}]", "\u{7}", "\u{1b}[35m", "\u{9b}", "\u{1b}[2J", "\u{202e}"] {
        assert!(!raw.contains(sequence), "{what}: {sequence:?} reached the terminal: {raw:?}");
    }
    assert!(raw.contains("owned"), "{what}: the text is not in the message: {raw:?}");
}

/// Returns the bytes that a run in this home writes to its terminal.
fn written(home: Sandbox, program: &str, arguments: &[&str]) -> String {
    let mut terminal = Terminal::start_in(home, 200, 40, program, arguments);
    terminal.end();
    terminal.raw()
}

#[test]
fn escape_sequences_in_arguments_do_not_reach_the_terminal() {
    let option = format!("--bogus{HOSTILE}");
    let value = format!("--wind={HOSTILE}");
    let lines: [&[&str]; 15] = [
        &[HOSTILE],
        &[&option],
        &["fly", HOSTILE],
        &["fly", "square", HOSTILE],
        &["fly", "square", &option],
        &["fly", "square", &value],
        &["fly", "square", "--set", HOSTILE],
        &["fly", "square", "--fault", HOSTILE],
        &["plan", HOSTILE],
        &["plan", "show", "square", HOSTILE],
        &["check", "--jobs", HOSTILE],
        &["check", HOSTILE],
        &["serve", "--listen", HOSTILE],
        &["sitl", &option],
        &["completions", HOSTILE],
    ];
    for line in lines {
        assert_harmless(&written(Sandbox::new(), PROGRAM, line), &format!("{line:?}"));
    }
}

#[test]
fn escape_sequences_in_the_environment_and_the_configuration_file_do_not_reach_the_terminal() {
    let variable = format!("BETADECK_WIND={HOSTILE}");
    for command in [&["fly", "square"][..], &["doctor"], &["config", "show"]] {
        let line = [&[variable.as_str(), PROGRAM], command].concat();
        assert_harmless(&written(Sandbox::new(), "/usr/bin/env", &line), &format!("{line:?}"));
    }
    let text = "\\u001b]0;owned\\u0007\\u001b[35m\\u009b2J\\u001b[2J\\u202e";
    for file in [
        format!("wind = \"{text}\""),
        format!("\"{text}\" = 1"),
        format!("[keys]\n\"{text}\" = \"a\""),
        format!("# {HOSTILE}\nwind = {HOSTILE}"),
    ] {
        for command in [&["fly", "square"][..], &["doctor"]] {
            let home = Sandbox::new();
            std::fs::create_dir_all(home.path(".config/betadeck")).expect("a directory");
            home.write(".config/betadeck/config.toml", &file);
            assert_harmless(&written(home, PROGRAM, command), &file);
        }
    }
}

#[test]
fn escape_sequences_in_file_names_do_not_reach_the_terminal() {
    let standing = "format = 1\nends = \"2 s after boot\"\n[plan]\nbuiltin = \"square\"\n[craft]\npilot = \"none\"\n\
                    [air]\nnoise = \"none\"\n[[expect]]\nfrom = \"boot\"\nalways = \"altitude in -1..1 m\"\n";
    let scripts = [
        format!("{PROGRAM} plan show ./*"),
        format!("{PROGRAM} fly ./*.txt"),
        format!("{PROGRAM} check --seeds 1..4 ./*.toml"),
        format!("{PROGRAM} convert ./*.txt out.toml"),
    ];
    for script in scripts {
        let home = Sandbox::new();
        let land = "waypoint insert 0 4O.4635901 -79.5182000 2000 500 LAND 0 NONE\n";
        home.write(&format!("{HOSTILE}.txt"), land);
        home.write(&format!("{HOSTILE}.toml"), standing);
        assert_harmless(&written(home, "/bin/sh", &["-c", &script]), &script);
    }
}

#[test]
fn escape_sequences_in_the_programs_own_name_do_not_reach_the_terminal() {
    let home = Sandbox::new();
    let name = home.path(HOSTILE);
    std::os::unix::fs::symlink(PROGRAM, &name).expect("a link");
    let raw = written(home, name.to_str().expect("text"), &["fly", "square", "--bogus"]);
    for sequence in ["\u{1b}]", "\u{7}", "\u{1b}[35m", "\u{9b}", "\u{202e}"] {
        assert!(!raw.contains(sequence), "{sequence:?}: {raw:?}");
    }
    assert!(raw.contains("--bogus"), "{raw:?}");
}

#[test]
fn a_plain_usage_error_keeps_its_colours_on_a_terminal() {
    let raw = written(Sandbox::new(), PROGRAM, &["fly", "square", "--bogus"]);
    assert!(raw.contains("\u{1b}[1m\u{1b}[31merror:") || raw.contains("\u{1b}[31m"), "{raw:?}");
}
