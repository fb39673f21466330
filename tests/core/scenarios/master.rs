//! The profile `master` flies as today's firmware does: it breaks the same properties, and the scenarios with bounds for it
//! pass.

use std::path::{Path, PathBuf};

use betadeck_core::scenario::{Air, BuiltinFiles, Case, CaseFlight, Flown, Outcome, Scenario, judge, read};
use betadeck_core::telemetry::FirmwareProfile;

use super::rig::{builtin, case_of, with_settings};

/// Returns the scenario of a finding in upstream's master.
#[track_caller]
fn finding(name: &str) -> Scenario {
    let root: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../plans/findings");
    let text = std::fs::read_to_string(root.join(format!("{name}.toml"))).unwrap();
    read(name, &text, Some(&[1]), &mut BuiltinFiles).unwrap()
}

fn flown(case: &Case, profile: FirmwareProfile) -> Flown {
    let mut case = case.clone();
    case.use_profile(profile);
    let air: &Air = &case.airs[0];
    CaseFlight::new(&case, air).unwrap().fly()
}

/// Returns the expectations that a flight of the case does not meet.
fn broken(case: &Case, profile: FirmwareProfile) -> Vec<String> {
    let (judgements, _) = judge(case, &flown(case, profile));
    let failed = judgements.into_iter().filter_map(|judgement| match judgement.outcome {
        Outcome::Failed { sentence, .. } => Some(format!("{}: {sentence}", judgement.label)),
        _ => None,
    });
    failed.collect()
}

#[test]
fn where_master_breaks_a_property_its_profile_does_and_the_guides_keeps_it() {
    for name in ["land-falls", "auto-land", "last-leg", "lean", "hold-in-wind", "gps-restart"] {
        for case in &finding(name).cases {
            assert_ne!(broken(case, FirmwareProfile::Master), [""; 0], "{name} {}", case.name);
            assert_eq!(broken(case, FirmwareProfile::Guide), [""; 0], "{name} {}", case.name);
        }
    }
}

#[test]
fn the_scenarios_of_the_guide_and_of_built_in_plans_pass_with_their_bounds_for_master() {
    let guide = (1..=8).map(|number| format!("guide-{number}"));
    let plans = ["alt-change", "delay", "figure8", "hold-wind", "takeoff", "yaw-rate"].map(str::to_owned);
    for name in guide.chain(plans) {
        for case in &builtin(&name).cases {
            assert_eq!(broken(case, FirmwareProfile::Master), [""; 0], "{name} {}", case.name);
        }
    }
}

#[test]
fn an_orbit_of_master_turns_anticlockwise_within_its_hold_radius() {
    let text = r#"
format = 1
name = "orbit"
description = "ORBIT turns anticlockwise at 14.3 degrees a second at most"
[plan]
builtin = "hold-orbit"
[craft]
settings = ["ap_altitude_p = 2", "ap_altitude_d = 200", "ap_hover_throttle = 1500"]
[air]
noise = "none"
[[measure]]
name = "turn_rate"
from = "10 s after ORBITING 0"
until = "40 s after ORBITING 0"
mean = "rate(bearing(wp 0))"
[[expect]]
name = "it stays near its circle of 2 m"
from = "10 s after ORBITING 0"
until = "40 s after ORBITING 0"
always = "distance(wp 0) in 0.5..4 m"
[[expect]]
name = "it turns anticlockwise"
that = "turn_rate in -15..-8 deg/s"
"#;
    let orbit = read("orbit", text, Some(&[1]), &mut BuiltinFiles).unwrap();
    assert_eq!(broken(&orbit.cases[0], FirmwareProfile::Master), [""; 0]);
}

#[test]
fn a_setting_of_the_profile_alone_flies_like_the_profile() {
    let case = with_settings(case_of("guide-1", "noise none"), &["ap_profile = MASTER"]);
    let one = CaseFlight::new(&case, &case.airs[0]).unwrap().fly();
    assert_eq!(one.firmware, Some(FirmwareProfile::Master));
}
