//! A firmware executable as a child: its output and its end are reported, and it is started again.
#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test may stop")]
#![allow(clippy::disallowed_methods, reason = "a process is waited for")]

use std::path::PathBuf;
use std::time::Duration;

use betadeck::link::{ChildConfig, ChildEnd, ChildEvent, SitlChild};
use tempfile::TempDir;

fn start(program: &str, arguments: &[&str]) -> (SitlChild, TempDir) {
    let directory = tempfile::tempdir().unwrap();
    let config = ChildConfig {
        program: PathBuf::from(program),
        arguments: arguments.iter().map(|&argument| argument.to_owned()).collect(),
        directory: directory.path().join("firmware"),
        launcher: PathBuf::from(env!("CARGO_BIN_EXE_betadeck")),
    };
    (SitlChild::start(config).unwrap(), directory)
}

fn next(child: &mut SitlChild) -> ChildEvent {
    loop {
        if let Some(event) = child.take_event() {
            return event;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn a_firmware_that_reboots_is_started_again_in_its_directory() {
    let (mut child, directory) = start("/bin/sh", &["-c", "pwd; echo wrong >&2; exit 0"]);
    for _ in 0..2 {
        assert_eq!(next(&mut child), ChildEvent::Started);
        let mut lines = [next(&mut child), next(&mut child)];
        lines.sort_by_key(|line| format!("{line:?}"));
        let here = directory.path().join("firmware").canonicalize().unwrap();
        assert_eq!(
            lines,
            [ChildEvent::Line(here.display().to_string()), ChildEvent::Line("wrong".to_owned())]
        );
        assert_eq!(next(&mut child), ChildEvent::Ended(ChildEnd::Code(0)));
    }
}

#[test]
fn a_firmware_that_crashes_is_reported_with_its_signal_and_started_again() {
    let (mut child, _directory) = start("/bin/sh", &["-c", "kill -SEGV $$"]);
    assert_eq!(next(&mut child), ChildEvent::Started);
    assert_eq!(next(&mut child), ChildEvent::Ended(ChildEnd::Signal(11)));
    assert_eq!(next(&mut child), ChildEvent::Started);
}

#[test]
fn a_file_that_is_not_there_or_no_program_is_reported_in_words() {
    let (mut child, _directory) = start("/nowhere/betaflight_SITL.elf", &[]);
    assert_eq!(next(&mut child), ChildEvent::Started);
    assert!(matches!(next(&mut child), ChildEvent::Line(_)));
    let sentence = "there is no executable /nowhere/betaflight_SITL.elf".to_owned();
    assert_eq!(next(&mut child), ChildEvent::Failed(sentence));
    let (mut child, _directory) = start(env!("CARGO_MANIFEST_PATH"), &[]);
    assert_eq!(next(&mut child), ChildEvent::Started);
    assert!(matches!(next(&mut child), ChildEvent::Line(_)));
    let ChildEvent::Failed(reason) = next(&mut child) else { panic!("it is a text") };
    assert!(reason.contains("is not an executable for this machine"), "{reason}");
}

#[test]
fn a_firmware_that_does_not_want_to_end_is_ended() {
    let (mut child, directory) =
        start("/bin/sh", &["-c", "trap '' TERM; echo $$ > pid; echo up; while :; do sleep 0.1; done"]);
    while next(&mut child) != ChildEvent::Line("up".to_owned()) {}
    let pid: i32 =
        std::fs::read_to_string(directory.path().join("firmware/pid")).unwrap().trim().parse().unwrap();
    drop(child);
    let pid = rustix::process::Pid::from_raw(pid).unwrap();
    assert!(rustix::process::test_kill_process(pid).is_err());
}

/// Waits for a file in the firmware's directory, and reads it.
fn written(directory: &TempDir, name: &str) -> String {
    loop {
        match std::fs::read_to_string(directory.path().join("firmware").join(name)) {
            Ok(text) if text.ends_with('\n') => return text,
            _ => std::thread::sleep(Duration::from_millis(5)),
        }
    }
}

#[test]
fn a_firmware_that_prints_without_end_is_shown_in_part_and_its_end_is_reported() {
    let script = "yes | head -n 300000; echo through > done; exit 3";
    let (mut child, directory) = start("/bin/sh", &["-c", script]);
    // The events are not taken meanwhile.
    written(&directory, "done");
    let (mut lines, mut not_shown) = (0, 0);
    loop {
        match next(&mut child) {
            ChildEvent::Started => {}
            ChildEvent::Line(line) => {
                assert_eq!(line, "y");
                lines += 1;
            }
            ChildEvent::NotShown(count) => not_shown += count,
            ended => break assert_eq!(ended, ChildEvent::Ended(ChildEnd::Code(3))),
        }
    }
    assert!((1..1000).contains(&lines), "{lines} were kept");
    assert_eq!(lines + not_shown, 300_000);
}

#[test]
fn a_script_that_started_the_firmware_ends_together_with_it() {
    let (child, directory) = start("/bin/sh", &["-c", "sleep 1000 & echo $! > pid; wait"]);
    let pid: i32 = written(&directory, "pid").trim().parse().unwrap();
    drop(child);
    let pid = rustix::process::Pid::from_raw(pid).unwrap();
    // Its new parent reaps it at some time.
    while rustix::process::test_kill_process(pid).is_ok() {
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[cfg(target_os = "linux")]
#[test]
fn one_that_went_its_own_way_with_the_output_does_not_hold_up_the_end() {
    let (mut child, directory) = start("/bin/sh", &["-c", "setsid sleep 1000 & echo $! > pid; exit 5"]);
    let pid: i32 = written(&directory, "pid").trim().parse().unwrap();
    assert_eq!(next(&mut child), ChildEvent::Started);
    assert_eq!(next(&mut child), ChildEvent::Ended(ChildEnd::Code(5)));
    drop(child);
    // The process has left the group that is ended here, which is allowed.
    let pid = rustix::process::Pid::from_raw(pid).unwrap();
    rustix::process::kill_process(pid, rustix::process::Signal::KILL).unwrap();
}
