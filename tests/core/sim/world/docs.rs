//! `docs/physics.md` against the code.

use betadeck_core::sim::{Airframe, FAULTS, SWITCHES};

const PHYSICS: &str = include_str!("../../../../docs/physics.md");

#[test]
fn the_example_airframe_flies() {
    let example =
        PHYSICS.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).expect("an example");
    let airframe = Airframe::from_toml(example).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((airframe.name.as_str(), airframe.battery.cells), ("long-range", 6));
}

#[test]
fn every_fault_switch_and_key_is_described() {
    let missing_key = Airframe::from_toml("").expect_err("nothing there");
    let keys = missing_key.problems.iter().filter_map(|problem| problem.text.split(' ').next());
    let names =
        FAULTS.iter().map(|fault| <&str>::from(fault.kind)).chain(SWITCHES.iter().map(|switch| switch.name));
    for name in names.chain(keys) {
        assert!(PHYSICS.contains(&format!("`{name}`")), "{name} is not described");
    }
    for fault in FAULTS.iter().filter(|fault| !fault.default.is_empty()) {
        let default = fault.default.replace('-', "−");
        assert!(
            PHYSICS.contains(&format!("({default})")),
            "the default {default} of {} is not stated",
            fault.name()
        );
    }
}
