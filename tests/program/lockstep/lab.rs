//! `betadeck lab` on copies of the flying stand-in.

use std::path::PathBuf;
use std::process::{Command, Output};

use serde_json::Value;

use super::flying::{FLYING, SLOW, WORSE};

/// A hop: up and down, at 1 m/s.
const HOP: &str = r#"
format = 1
name = "hop"
seeds = "1..2"
ends = "2 s after touchdown"
time_limit_s = 40
[plan]
waypoints = [ "40.4635 -79.5182 400 500 LAND 0 ORBIT" ]
[craft]
takeoff_m = 4
settings = ["ap_landing_descent_rate = 100"]
[air]
noise = "real"
[[measure]]
name = "greatest_sink"
better = "less"
from = "boot"
max = "-climb"
[[expect]]
that = "greatest_sink <= 2 m/s"
"#;

/// Copies of the stand-in, in a folder of their own.
pub(super) struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    pub(super) fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        for name in ["old.elf", &format!("{SLOW}.elf"), &format!("{WORSE}.elf")] {
            let (from, to) = (std::env::current_exe().unwrap(), folder.path().join(name));
            // Another file system takes no link.
            if std::fs::hard_link(&from, &to).is_err() {
                std::fs::copy(&from, &to).unwrap();
            }
        }
        std::fs::write(folder.path().join("hop.toml"), HOP).unwrap();
        Self { folder }
    }

    pub(super) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Runs the programme on these executables, with the hop only.
    fn lab(&self, executables: &[&str], more: &[&str]) -> Output {
        let programme = ["--with", "hop.toml", "--filter", "hop", "--budget", "1h"];
        self.run(&[&["lab"], executables, &programme, more].concat())
    }

    /// Runs a command on copies of the stand-in.
    pub(super) fn run(&self, arguments: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_betadeck"))
            .args(arguments)
            .args(["--firmware-arg", FLYING])
            .current_dir(self.folder.path())
            .env("HOME", self.folder.path())
            .output()
            .unwrap()
    }
}

pub(super) fn text(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

#[test]
fn two_copies_of_one_build_do_not_differ_although_one_of_them_has_a_busy_machine() {
    let bench = Bench::new();
    let output = bench.lab(&["--base", "old.elf", "--head", &format!("{SLOW}.elf")], &[]);
    assert!(output.status.success(), "{}", text(&output));
    let said = text(&output);
    assert!(said.contains("old.elf → slow.elf: 2 flights on each"), "{said}");
    assert!(said.contains("No difference: all flights are the same to the last bit."), "{said}");
}

#[test]
fn a_build_that_lands_too_fast_is_worse_in_every_output() {
    let bench = Bench::new();
    let worse = format!("{WORSE}.elf");
    let outputs =
        ["--json", "l.json", "--markdown", "l.md", "--html", "l.html", "--junit", "l.xml", "--keep", "kept"];
    let output = bench.lab(&["--base", "old.elf", "--head", &worse], &outputs);
    let said = text(&output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(
        said.contains("worse: greatest_sink <= 2 m/s: before 0 → 2 of 2 flights, 2 newly; hop · seed 1"),
        "{said}"
    );
    assert!(said.contains("betadeck open hop.toml --seed 1"), "{said}");
    let read = |name: &str| std::fs::read_to_string(bench.path(name)).unwrap();
    let json: Value = serde_json::from_str(&read("l.json")).unwrap();
    let measure = |side: &str| json["flights"][0][side]["measures"]["greatest_sink"].as_f64().unwrap();
    assert!(measure("head") > measure("base") + 0.5, "{json}");
    assert!(read("l.md").contains("greatest\\_sink"), "{}", read("l.md"));
    assert!(read("l.html").contains("Broken properties"));
    assert!(
        read("l.xml").contains("<testcase classname=\"hop\" name=\"flight seed 1\""),
        "{}",
        read("l.xml")
    );
    assert!(read("kept/hop seed 2.head.csv").starts_with("state,waypoint,"));
}

#[test]
fn one_build_alone_is_judged_by_the_properties() {
    let bench = Bench::new();
    let bad = bench.lab(&[&format!("{WORSE}.elf")], &[]);
    // Its landings are too fast for the scenario, but break no property that every firmware keeps.
    assert!(bad.status.success(), "{}", text(&bad));
    assert!(text(&bad).contains("broken: greatest_sink <= 2 m/s: 2 of 2 flights"), "{}", text(&bad));
}

#[test]
fn a_program_that_is_no_firmware_is_reported_and_nothing_is_said_about_its_flights() {
    let bench = Bench::new();
    let output = bench.lab(&["--base", "old.elf", "--head", "/usr/bin/env"], &[]);
    assert_eq!(output.status.code(), Some(3), "{}", text(&output));
    let missing = bench.lab(&["nothing.elf"], &[]);
    assert_eq!(missing.status.code(), Some(3));
    assert!(text(&missing).contains("there is no such file"), "{}", text(&missing));
    let half = bench.lab(&["--base", "old.elf"], &[]);
    assert_eq!(half.status.code(), Some(2));
}
