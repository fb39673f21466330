//! The commands that the documentation shows do what it says.

use std::ffi::OsString;
use std::path::Path;

use betadeck::args::{self, Layers};

use crate::support::{Sandbox, plan};

/// Pages with commands for users.
const PAGES: [&str; 8] = [
    "README.md",
    "plans/README.md",
    "docs/headless.md",
    "docs/links.md",
    "docs/modes.md",
    "docs/autopilot.md",
    "docs/physics.md",
    "docs/real-parts.md",
];

/// The lines of a page's shell blocks that call the program.
fn commands(page: &str) -> Vec<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(page);
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{page}: {error}"));
    let blocks = text.split("```sh\n").skip(1).filter_map(|rest| rest.split("```").next());
    let lines = blocks.flat_map(str::lines).filter(|line| line.contains("betadeck "));
    lines.map(str::to_owned).collect()
}

/// The arguments of a command without redirections and variables.
fn arguments(line: &str) -> Vec<OsString> {
    let words = line.split_whitespace().take_while(|word| !["<", ">", "|", "#"].contains(word));
    words.skip_while(|word| *word != "betadeck").map(OsString::from).collect()
}

#[test]
fn every_command_of_the_documentation_is_understood_and_those_that_end_do_as_told() {
    let sandbox = Sandbox::new();
    let guide = std::fs::read_to_string(plan("guide-square.txt")).expect("the guide's block");
    let mut ran = 0;
    for page in PAGES {
        for line in commands(page) {
            let words = arguments(&line);
            args::parse(words.clone(), &Layers::default())
                .unwrap_or_else(|error| panic!("{page}: {line}\n{error}"));
            let name = words.get(1).and_then(|word| word.to_str()).unwrap_or_default();
            // A firmware outside is not at hand.
            let needs_parts = line.contains("--firmware");
            if needs_parts || !["fly", "plan", "convert", "completions", "man"].contains(&name) {
                continue;
            }
            for (file, text) in [("my-plan.txt", guide.as_str()), ("diff.txt", &guide)] {
                sandbox.write(file, text);
            }
            std::fs::remove_file(sandbox.path("my-plan.toml")).ok();
            let path = Path::new(crate::support::PROGRAM).parent().expect("a folder").to_owned();
            let output = std::process::Command::new("/bin/sh")
                .args(["-c", &line])
                .env_clear()
                .envs(sandbox.environment())
                .env("PATH", path)
                .current_dir(sandbox.path("."))
                .output()
                .expect("a shell");
            let told = line.split_once("exit code ").and_then(|(_, rest)| rest.get(..1)?.parse().ok());
            let said = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(told.unwrap_or(0)), "{page}: {line}\n{said}");
            ran += 1;
        }
    }
    assert!(ran >= 15, "only {ran} commands");
}
