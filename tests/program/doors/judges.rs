//! Ground stations of others at the door: pymavlink, MAVProxy and MAVSDK fly the craft as each identity. They run if the Python
//! of `BETADECK_PYTHON`, or else `python3`, has them; `.ci/run` installs them where it can.
#![allow(clippy::print_stderr, reason = "a test that is skipped says so, and the others print their logs")]

use std::process::Command;

use super::ground_station::serve_at;

const IDENTITIES: [&str; 3] = ["generic", "ardupilot", "px4"];

/// Runs a script of `tests/judges` for each identity, if a module of Python is there.
fn judge(script: &str, module: &str) {
    let python = std::env::var("BETADECK_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let has_module = Command::new(&python).args(["-c", &format!("import {module}")]).output();
    if !has_module.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: {python} has no {module}");
        return;
    }
    for identity in IDENTITIES {
        let (_program, address) = serve_at("5", &["--mavlink-as", identity]);
        let script = format!("{}/tests/judges/{script}", env!("CARGO_MANIFEST_DIR"));
        let ran = Command::new(&python).args([&script, &address.to_string()]).output().unwrap();
        let said = String::from_utf8_lossy(&ran.stdout);
        let complained = String::from_utf8_lossy(&ran.stderr);
        assert!(ran.status.success(), "{identity}:\n{said}\n{complained}");
        eprintln!("{identity}: {}", said.trim());
    }
}

#[test]
fn pymavlink_plans_arms_flies_and_lands_the_craft() {
    judge("pymavlink_judge.py", "pymavlink");
}

#[test]
fn mavproxy_plans_arms_flies_and_lands_the_craft() {
    judge("mavproxy_judge.py", "MAVProxy");
}

#[test]
fn mavsdk_plans_arms_flies_and_lands_the_craft() {
    judge("mavsdk_judge.py", "mavsdk.mavsdk");
}
