//! Small inputs of `tests/cases` that once had the wrong outcome: each with the right one.

use std::path::PathBuf;

use crate::support::Sandbox;

/// Returns a file of `tests/cases`.
fn case(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/cases").join(name)
}

/// Returns a folder with these files of `tests/cases`.
fn folder(names: &[&str]) -> Sandbox {
    let sandbox = Sandbox::new();
    for name in names {
        sandbox.write(name, std::fs::read(case(name)).expect("a case"));
    }
    sandbox
}

#[test]
fn a_rescue_by_switch_goes_on_when_the_autopilot_switch_goes_off() {
    let sandbox = folder(&["rescue-then-autopilot-off.toml", "guide.txt"]);
    sandbox.run(&["check", "rescue-then-autopilot-off.toml"]).exits(0);
}
