//! Foreign files in the state directory and among the temporary files, and files that are neither settings
//! nor plans.

use std::os::unix::fs::{PermissionsExt as _, symlink};
use std::process::Stdio;

use crate::binary::plain::Dialogue;
use crate::binary::pty::Terminal;
use crate::binary::streams::until;
use crate::binary::support::Sandbox;
use test_support::free_port;

const PLAIN: [&str; 4] = ["--plain", "--no-ports", "--speed=max", "--state-dir=state"];

fn make_fifo(path: &std::path::Path) {
    let made = std::process::Command::new("mkfifo").arg(path).status().expect("mkfifo");
    assert!(made.success());
}

/// Returns the names of the journals in the state directory.
fn journals(sandbox: &Sandbox) -> Vec<String> {
    let entries = std::fs::read_dir(sandbox.path("state/plans")).into_iter().flatten().flatten();
    let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
    names.filter(|name| name.ends_with(".journal")).collect()
}

/// Edits a plan without saving it, and kills the program when the edit is on disk. Returns the name of the
/// journal.
fn edit_and_be_killed(sandbox: &Sandbox) -> String {
    let mut editor = Dialogue::start(sandbox, &PLAIN);
    editor.say("plan.generate");
    editor.say("take");
    editor.hear(" waypoints.");
    until("a journal", || !journals(sandbox).is_empty());
    let name = journals(sandbox).remove(0);
    until("an edit in it", || sandbox.read(&format!("state/plans/{name}")).lines().count() > 1);
    name
}

#[test]
fn a_link_or_a_pipe_where_a_journal_had_its_temporary_file_loses_no_edit() {
    let sandbox = Sandbox::new();
    let journal = edit_and_be_killed(&sandbox);
    let temporary = sandbox.path(&format!("state/plans/{}", journal.replace(".journal", ".tmp")));
    std::fs::remove_file(sandbox.path(&format!("state/plans/{journal}"))).expect("removed");
    sandbox.write("precious", "precious\n");
    symlink(sandbox.path("precious"), &temporary).expect("a link");
    assert_eq!(edit_and_be_killed(&sandbox), journal);
    assert_eq!(sandbox.read("precious"), "precious\n");
    assert!(sandbox.path(&format!("state/plans/{journal}")).symlink_metadata().expect("there").is_file());
    std::fs::remove_file(sandbox.path(&format!("state/plans/{journal}"))).expect("removed");
    std::fs::remove_file(&temporary).ok();
    make_fifo(&temporary);
    assert_eq!(edit_and_be_killed(&sandbox), journal);
}

#[test]
fn lines_are_not_appended_through_a_linked_history_and_the_log_says_so() {
    for is_hard in [false, true] {
        let home = Sandbox::new();
        home.write("precious", "precious\n");
        std::fs::create_dir_all(home.path(".state/betadeck")).expect("a directory");
        let history = home.path(".state/betadeck/commands.history");
        if is_hard {
            std::fs::hard_link(home.path("precious"), &history).expect("a link");
        } else {
            symlink(home.path("precious"), &history).expect("a link");
        }
        let mut terminal =
            Terminal::start_in(home, 160, 40, crate::binary::support::PROGRAM, &["--no-ports"]);
        terminal.until_shown("DISARMED");
        terminal.send("8z");
        terminal.until_shown("commands.history");
        terminal.send(":speed 2\r");
        terminal.until_shown("2.0");
        terminal.send("q");
        assert_eq!(terminal.end(), 0);
        assert_eq!(terminal.home().read("precious"), "precious\n", "hard link: {is_hard}");
    }
}

#[test]
fn no_output_is_written_over_a_journal_or_a_history() {
    let sandbox = Sandbox::new();
    let journal = edit_and_be_killed(&sandbox);
    let own = format!("state/plans/{journal}");
    let edits = sandbox.read(&own);
    sandbox.write("state/commands.history", "speed 2\n");
    symlink(sandbox.path(&own), sandbox.path("link.json")).expect("a link");
    std::fs::create_dir_all(sandbox.path(".state/betadeck")).expect("a directory");
    let outputs =
        [own.as_str(), "link.json", "state/commands.history", "state/cli.history", "state/plans/new.journal"];
    for output in outputs {
        for option in ["--json", "--gpx"] {
            let ran = sandbox.run(&["fly", "land", "--state-dir", "state", option, output]).exits(2);
            assert!(
                ran.err.contains("would overwrite") && ran.err.contains("name another file"),
                "{}",
                ran.err
            );
        }
        assert_eq!(sandbox.read(&own), edits);
    }
    // The files of the default state directory are protected too, whatever directory is named.
    std::fs::create_dir_all(sandbox.path(".state/betadeck/plans")).expect("a directory");
    for output in
        [".state/betadeck/cli.history", ".state/betadeck/plans/x-0.journal", ".state/betadeck/eeprom.bin"]
    {
        for line in [
            &["fly", "land", "--json", output][..],
            &["check", "guide-1", "--junit", output],
            &["check", "guide-1", "--json", output],
            &["convert", "land", output, "--to", "txt", "--force"],
        ] {
            let ran = sandbox.run(line).exits(2);
            assert!(ran.err.contains("would overwrite"), "{line:?}: {}", ran.err);
            assert!(!sandbox.path(output).exists());
        }
    }
    assert_eq!(sandbox.read("state/commands.history"), "speed 2\n");
}

/// Returns a scenario with these keys of the craft and this plan.
fn scenario(plan: &str, craft: &str) -> String {
    format!(
        "format = 1\nends = \"2 s after boot\"\n[plan]\n{plan}\n[craft]\npilot = \"none\"\n{craft}\n[air]\nnoise = \"none\"\n\
         [[expect]]\nfrom = \"boot\"\nalways = \"altitude in -1..1 m\"\n"
    )
}

#[test]
fn settings_that_are_a_file_of_the_system_or_no_settings_are_not_shown_in_the_error() {
    let sandbox = Sandbox::new();
    sandbox.write("keys.env", "API_KEY=hunter2\nhunter2 hunter2\n");
    symlink("/proc/self/environ", sandbox.path("environ.txt")).expect("a link");
    for name in ["/proc/self/environ", "environ.txt", "/proc/version", "keys.env"] {
        sandbox.write("test.toml", &scenario("builtin = \"square\"", &format!("settings_file = \"{name}\"")));
        let lines: [&[&str]; 2] =
            [&["check", "test.toml", "--any-folder"], &["fly", "land", "--settings", name]];
        for line in lines {
            let mut command = sandbox.command(line);
            command.env("SECRET", "hunter2");
            let output = assert_cmd::Command::from_std(command).output().expect("it runs");
            let said = String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned();
            assert_eq!(output.status.code(), Some(2), "{line:?} {name}: {said}");
            assert!(!said.contains("hunter2") && !said.contains("Linux version"), "{line:?} {name}: {said}");
            if name != "keys.env" {
                assert!(said.contains("system file"), "{line:?} {name}: {said}");
            }
        }
    }
}

#[test]
fn a_plan_file_without_a_waypoint_is_a_usage_error_of_a_scenario() {
    let sandbox = Sandbox::new();
    sandbox.write("notes.txt", "Buy propellers.\n");
    sandbox.write("empty.toml", "name = \"nothing\"\n");
    for name in ["notes.txt", "empty.toml"] {
        sandbox.write("test.toml", &scenario(&format!("file = \"{name}\""), ""));
        let ran = sandbox.run(&["check", "test.toml", "--junit", "report.xml"]).exits(2);
        assert!(ran.err.contains(&format!("{name} is not recognised as a plan")), "{}", ran.err);
        assert!(ran.err.contains("test.toml:4:"), "{}", ran.err);
        assert!(!sandbox.path("report.xml").exists());
        let ran = sandbox.run(&["fly", name]).exits(2);
        assert!(ran.err.contains("no waypoints"), "{}", ran.err);
    }
}

/// Returns the names of the temporary files.
fn temporary(sandbox: &Sandbox) -> Vec<String> {
    let entries = std::fs::read_dir(sandbox.path("tmp")).expect("a directory").flatten();
    let mut names: Vec<String> =
        entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

fn with_temporary_files(sandbox: &Sandbox, arguments: &[&str]) -> std::process::Command {
    let mut command = sandbox.command(arguments);
    command
        .env("TMPDIR", sandbox.path("tmp"))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command
}

/// Returns options with ports that the system has just chosen.
fn free_ports() -> [String; 2] {
    let udp = [(); 4].map(|()| free_port().to_string());
    [format!("--tcp-port={}", free_port()), format!("--udp-ports={}", udp.join(","))]
}

#[test]
fn the_folder_of_a_firmware_whose_program_was_killed_is_removed_at_the_next_start() {
    let sandbox = Sandbox::new();
    std::fs::create_dir(sandbox.path("tmp")).expect("a directory");
    let ports = free_ports();
    let line = ["fly", "land", "--clock=real", "--firmware", "/bin/sleep", "--firmware-arg", "100"];
    let line = [&line[..], &[ports[0].as_str(), ports[1].as_str()]].concat();
    let mut killed = with_temporary_files(&sandbox, &line).spawn().expect("it runs");
    until("the folder of the firmware", || !temporary(&sandbox).is_empty());
    killed.kill().expect("killed");
    killed.wait().expect("its end");
    let left = temporary(&sandbox);
    let mode = sandbox.path(&format!("tmp/{}", left[0])).metadata().expect("there").permissions().mode();
    assert_eq!(mode & 0o777, 0o700, "it is for its owner only");
    assert!(left.len() == 1 && left[0].starts_with("betadeck-firmware-"), "{left:?}");
    let flown = with_temporary_files(&sandbox, &["fly", "land", "--timeout=2"]).status().expect("it runs");
    assert_eq!(flown.code(), Some(1));
    assert_eq!(temporary(&sandbox), Vec::<String>::new());
}

#[test]
fn only_folders_that_nobody_uses_are_removed_and_no_link_is_followed() {
    let sandbox = Sandbox::new();
    for folder in ["tmp/betadeck-firmware-dead/inner", "tmp/betadeck-firmware-alive", "tmp/other", "precious"]
    {
        std::fs::create_dir_all(sandbox.path(folder)).expect("a directory");
        sandbox.write(&format!("{folder}/file"), "text");
    }
    symlink(sandbox.path("precious"), sandbox.path("tmp/betadeck-firmware-dead/link")).expect("a link");
    symlink(sandbox.path("precious"), sandbox.path("tmp/betadeck-firmware-link")).expect("a link");
    sandbox.write("tmp/betadeck-firmware-file", "text");
    let alive = std::fs::File::open(sandbox.path("tmp/betadeck-firmware-alive")).expect("a directory");
    alive.try_lock().expect("locked");
    with_temporary_files(&sandbox, &["fly", "land", "--timeout=2"]).status().expect("it runs");
    let kept = ["betadeck-firmware-alive", "betadeck-firmware-file", "betadeck-firmware-link", "other"];
    assert_eq!(temporary(&sandbox), kept);
    assert_eq!(sandbox.read("precious/file"), "text");
    drop(alive);
    with_temporary_files(&sandbox, &["fly", "land", "--timeout=2"]).status().expect("it runs");
    assert_eq!(temporary(&sandbox), kept[1..]);
}
