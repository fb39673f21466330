//! The lines of the pages for the command line of the firmware.

use betadeck::firmware::settings::SETTINGS;

use super::extract::{Shown, spans};
use super::filled_in;
use crate::binary::support::Sandbox;

/// The commands whose lines are tried. Words such as `save` and `name` are also words of sentences and files.
const COMMANDS: [&str; 8] = ["set", "get", "waypoint", "diff", "dump", "status", "version", "help"];

/// Returns the line that a span of a page gives to the firmware, if it does.
fn line(shown: &Shown) -> Option<Result<String, String>> {
    let text = shown.text.as_str();
    let first = text.split(' ').next().unwrap_or_default();
    if text.contains('…') || text.ends_with('_') {
        return None;
    }
    if COMMANDS.contains(&first) {
        // `set` and `waypoint insert` alone name a command; they do nothing without what follows.
        return (!["set", "waypoint insert", "waypoint"].contains(&text)).then(|| filled_in(shown));
    }
    let is_setting = |name: &str| SETTINGS.iter().any(|setting| setting.name == name);
    let (name, value) = text.split_once(" = ")?;
    is_setting(name).then(|| Ok(format!("set {name} = {value}")))
}

#[test]
fn every_line_of_the_pages_for_the_firmware_is_taken() {
    let sandbox = Sandbox::new();
    let mut lines: Vec<(String, String)> = Vec::new();
    for shown in spans() {
        match line(&shown) {
            Some(Ok(line)) if lines.iter().all(|(_, known)| *known != line) => {
                lines.push((shown.place, line));
            }
            Some(Err(problem)) => panic!("{problem}"),
            _ => {}
        }
    }
    assert!(lines.len() >= 12, "only {lines:?}");
    for (place, line) in lines {
        let input = format!(":{line}\nquit\ny\n");
        let arguments = ["--plain", "--fresh", "--no-ports", "--speed=max"];
        let ran = sandbox.run_with(&arguments, &input).exits(0);
        assert!(
            !ran.out.contains("###ERROR") && !ran.err.contains("###ERROR"),
            "{place}\n{}\n{}",
            ran.out,
            ran.err
        );
        let is_event = |line: &&str| line.contains(" s  ");
        assert!(ran.out.lines().any(|line| !is_event(&line)), "{place}: no answer\n{}", ran.out);
    }
}
