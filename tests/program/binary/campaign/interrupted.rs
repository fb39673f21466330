//! The file of a run after kills, full disks and `Ctrl-C`.
#![allow(clippy::disallowed_methods, reason = "a program is watched until it has written a line")]

use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use super::{STANDING, lines, sandbox};
use crate::binary::support::Sandbox;

/// The time after which a program counts as hung.
const NEVER: Duration = Duration::from_secs(600);

/// A process that is killed when its test ends.
struct Guard(Child);

impl Drop for Guard {
    fn drop(&mut self) {
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

fn spawn(mut command: Command) -> Guard {
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    Guard(command.spawn().expect("it starts"))
}

/// Waits until a file has more than so many lines, or the program is over.
fn wait_for_lines(child: &mut Guard, sandbox: &Sandbox, name: &str, count: usize) {
    let started = Instant::now();
    while lines(sandbox, name) <= count && child.0.try_wait().expect("a state").is_none() {
        assert!(started.elapsed() < NEVER, "{name} does not grow");
        std::thread::sleep(Duration::from_millis(2));
    }
}

#[test]
fn a_run_that_is_killed_twenty_times_ends_with_the_same_bytes() {
    let sandbox = sandbox();
    let arguments = |out| ["campaign", "standing.toml", "--flights", "25", "--jobs", "2", "--out", out];
    sandbox.run(&arguments("whole.jsonl")).exits(1);
    let mut kills = 0;
    for killed in 1..=20 {
        let mut child = spawn(sandbox.command(&arguments("killed.jsonl")));
        wait_for_lines(&mut child, &sandbox, "killed.jsonl", killed);
        kills += u32::from(child.0.try_wait().expect("a state").is_none());
        drop(child);
    }
    assert!(kills > 0, "the last runs may be over before they are killed, but not all");
    let before = lines(&sandbox, "killed.jsonl") - 1;
    let ran = sandbox.run(&arguments("killed.jsonl")).exits(1);
    assert!(ran.err.contains(&format!("{before} were flown before")), "{}", ran.err);
    assert_eq!(sandbox.read("killed.jsonl"), sandbox.read("whole.jsonl"));
}

#[test]
fn a_file_that_ends_anywhere_is_finished_to_the_same_bytes_and_answer() {
    let sandbox = sandbox();
    let arguments = ["campaign", "standing.toml", "--flights", "6", "--out", "run.jsonl", "--csv", "run.csv"];
    let whole = sandbox.run(&arguments).exits(1);
    let (bytes, table) = (std::fs::read(sandbox.path("run.jsonl")).expect("a file"), sandbox.read("run.csv"));
    let head = bytes.iter().position(|byte| *byte == b'\n').expect("a header");
    let line = bytes[head + 1..].iter().position(|byte| *byte == b'\n').expect("a line");
    for cut in [0, 1, head, head + 1, head + 2, head + 1 + line, head + 2 + line, bytes.len() - 1] {
        std::fs::write(sandbox.path("run.jsonl"), &bytes[..cut]).expect("written");
        let ran = sandbox.run(&arguments).exits(1);
        assert_eq!(std::fs::read(sandbox.path("run.jsonl")).expect("a file"), bytes, "cut at {cut}");
        assert_eq!(
            (ran.out.as_str(), sandbox.read("run.csv")),
            (whole.out.as_str(), table.clone()),
            "cut at {cut}"
        );
    }
    // The file says everything itself.
    std::fs::write(sandbox.path("run.jsonl"), &bytes[..head + 5 + line]).expect("written");
    std::fs::remove_file(sandbox.path("standing.toml")).expect("removed");
    let ran = sandbox.run(&["campaign", "run.jsonl"]).exits(1);
    assert_eq!(ran.out, whole.out);
    assert_eq!(std::fs::read(sandbox.path("run.jsonl")).expect("a file"), bytes);
}

#[test]
fn files_of_something_else_stay_as_they_are() {
    let sandbox = sandbox();
    sandbox.write("notes.txt", "mine\n");
    sandbox.run(&["campaign", "standing.toml", "--flights", "2", "--out", "run.jsonl"]).exits(0);
    let kept = sandbox.read("run.jsonl");
    for (arguments, problem) in [
        (
            ["--flights", "2", "--out", "notes.txt"],
            "notes.txt is not the file of a campaign: name another file",
        ),
        (["--flights", "3", "--out", "run.jsonl"], "run.jsonl has another campaign: its options were others"),
        (
            ["--flights", "2", "--out", "standing.toml"],
            "--out standing.toml would overwrite a file of the campaign",
        ),
        (["--flights", "2", "--out", "/dev/null"], "--out /dev/null is not a file"),
    ] {
        let ran = sandbox.run(&[&["campaign", "standing.toml"][..], &arguments].concat()).exits(2);
        assert!(ran.err.contains(problem), "{problem}\n{}", ran.err);
    }
    assert_eq!((sandbox.read("run.jsonl"), sandbox.read("notes.txt")), (kept.clone(), "mine\n".to_owned()));
    sandbox.write("standing.toml", &STANDING.replace("9 m/s", "8 m/s"));
    let ran = sandbox.run(&["campaign", "standing.toml", "--flights", "2", "--out", "run.jsonl"]).exits(2);
    assert!(ran.err.contains("its scenario, plan or options were others"), "{}", ran.err);
    let damaged = kept.replacen("\"flight\":2", "\"flight\":3", 1);
    sandbox.write("run.jsonl", &damaged);
    let ran = sandbox.run(&["campaign", "run.jsonl"]).exits(2);
    assert!(ran.err.contains("run.jsonl:3: flight 3 is here in place of flight 2"), "{}", ran.err);
}

#[test]
fn a_full_disk_is_a_sentence_and_leaves_whole_lines() {
    let sandbox = sandbox();
    let arguments = "campaign standing.toml --flights 20 --jobs 1 --out run.jsonl";
    // The limit is in blocks of 512 bytes. Without the signal a write beyond it fails as on a full disk.
    let script = format!("trap '' XFSZ; ulimit -f 12; exec {} {arguments}", crate::binary::support::PROGRAM);
    let mut command = Command::new("sh");
    command.args(["-c", &script]).env_clear().envs(sandbox.environment()).current_dir(sandbox.path("."));
    let output = command.output().expect("it runs");
    let err = String::from_utf8(output.stderr).expect("text");
    assert_eq!(output.status.code(), Some(3), "{err}");
    assert!(
        err.contains("cannot write run.jsonl: ") && err.contains("lines before are whole: make room"),
        "{err}"
    );
    let out = String::from_utf8(output.stdout).expect("text");
    assert!(out.contains("were not flown"), "the answer so far: {out}");
    assert!(sandbox.read("run.jsonl").ends_with("}\n"), "whole lines");
    let before = lines(&sandbox, "run.jsonl");
    assert!((2..20).contains(&before), "{before}");
    let words: Vec<&str> = arguments.split(' ').collect();
    sandbox.run(&words).exits(1);
    sandbox.run(&["campaign", "standing.toml", "--flights", "20", "--out", "other.jsonl"]).exits(1);
    assert_eq!(sandbox.read("run.jsonl"), sandbox.read("other.jsonl"));
}

#[test]
fn ctrl_c_prints_the_answer_so_far() {
    let sandbox = sandbox();
    let mut child =
        spawn(sandbox.command(&["campaign", "standing.toml", "--flights", "100000", "--out", "run.jsonl"]));
    wait_for_lines(&mut child, &sandbox, "run.jsonl", 3);
    let id = child.0.id().to_string();
    assert!(Command::new("kill").args(["-s", "INT", &id]).status().expect("kill").success());
    let output = {
        use std::io::Read as _;
        let mut out = String::new();
        child.0.stdout.take().expect("a pipe").read_to_string(&mut out).expect("text");
        out
    };
    assert_eq!(child.0.wait().expect("an end").code(), Some(130));
    assert!(output.contains("of 100000 were not flown."), "{output}");
    assert!(sandbox.read("run.jsonl").ends_with("}\n"));
}
