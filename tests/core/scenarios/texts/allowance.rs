//! Allowances: bounds are wider by them, and by no more.

use super::{judge, scenario};
use betadeck_core::scenario::CaseFlight;

/// Returns which of these conditions are met at every moment by a craft that rests level at the boot place for a
/// second, with real sensors and an allowance of each kind.
fn met(conditions: &[&str]) -> Vec<bool> {
    let expectations: String = conditions
        .iter()
        .map(|condition| format!("[[expect]]\nfrom = 'boot'\nalways = '{condition}'\n"))
        .collect();
    let case = &scenario(&format!(
        "format = 1\nends = '1 s after boot'\n[plan]\nbuiltin = 'land'\n[craft]\npilot = 'none'\n\
         [air]\nnoise = 'real'\n[allow]\nhorizontal_m = 2\nvertical_m = 0.5\nspeed_mps = 0.2\n\
         angle_deg = 3\n{expectations}"
    ))
    .cases[0];
    let judgements = judge(case, &CaseFlight::new(case, &case.airs[0]).unwrap().fly()).0;
    // The first one is about the result.
    judgements[1..].iter().map(|judgement| judgement.outcome.is_met()).collect()
}

#[test]
fn every_kind_of_bound_is_wider_by_the_allowance() {
    let kinds: [[&str; 2]; 8] = [
        ["altitude >= 0.4 m", "altitude >= 0.6 m"],
        ["altitude <= -0.4 m", "altitude <= -0.6 m"],
        ["altitude in 0.4..5 m", "altitude in 0.6..5 m"],
        ["altitude in -5..-0.4 m", "altitude in -5..-0.6 m"],
        ["altitude = 0.9 +- 0.5 m", "altitude = 1.1 +- 0.5 m"],
        ["north >= 1.9 m", "north >= 2.1 m"],
        ["speed >= 0.15 m/s", "speed >= 0.25 m/s"],
        ["lean >= 2.5 deg", "lean >= 3.5 deg"],
    ];
    let outcomes = met(kinds.as_flattened());
    for ([allowed, refused], met) in std::iter::zip(kinds, outcomes.as_chunks::<2>().0) {
        assert_eq!(met, &[true, false], "{allowed}, {refused}");
    }
}

#[test]
fn altitudes_have_the_vertical_allowance_however_they_are_written() {
    let conditions = ["-altitude >= 0.4 m", "abs(altitude) >= 0.4 m", "altitude + 1 m >= 1.4 m"];
    assert_eq!(met(&conditions), [true; 3]);
    let conditions = ["-altitude >= 0.6 m", "abs(altitude) >= 0.6 m", "altitude + 1 m >= 1.6 m"];
    assert_eq!(met(&conditions), [false; 3]);
}
