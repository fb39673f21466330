//! The guarantees of the scenario language, with a craft that stays on the ground for some seconds.

use crate::scenarios::rig::{assert_met, fly, judged};
use betadeck_core::plan::format::report;
use betadeck_core::scenario::{BuiltinFiles, Case, Outcome, judge, read};

const GROUND: &str = r#"
format = 1
ends = "5.1 s after boot"
[plan]
builtin = "land"
[craft]
pilot = "none"
[air]
noise = "none"
[[expect]]
result = "stopped"
"#;

#[track_caller]
fn on_the_ground(more: &str) -> Case {
    let text = format!("{GROUND}{more}");
    let mut scenario = read("test.toml", &text, None, &mut BuiltinFiles)
        .unwrap_or_else(|errors| panic!("{}", report(&errors)));
    scenario.cases.remove(0)
}

/// Returns the report of the errors in a scenario.
#[track_caller]
fn problems(more: &str) -> String {
    let text = format!("{GROUND}{more}");
    let errors = read("test.toml", &text, None, &mut BuiltinFiles).expect_err("it is wrong");
    report(&errors)
}

/// Returns the share of the margin that is left in the last expectation.
#[track_caller]
fn share_left(case: &Case) -> f64 {
    let judgements = judged(case);
    assert_met(&judgements);
    judgements.last().unwrap().outcome.margin().unwrap().verdict.share()
}

#[test]
fn an_input_is_done_once_or_each_time() {
    let input = |each: &str| {
        format!(
            "[[input]]\nname = \"ask\"\nat = \"when boot_time % 1 s > 0.5 s\"\n{each}do = \"cli version\"\n\
             [[expect]]\nevent = \"reply\"\ncount = {}\n",
            if each.is_empty() { 1 } else { 5 }
        )
    };
    assert_met(&judged(&on_the_ground(&input(""))));
    assert_met(&judged(&on_the_ground(&input("each = true\n"))));
}

#[test]
fn an_input_whose_instant_comes_once_cannot_be_done_each_time() {
    let reported = problems("[[input]]\nat = \"3 s after boot\"\neach = true\ndo = \"rc cut\"\n");
    assert!(reported.contains("this instant comes only once"), "{reported}");
}

#[test]
fn a_name_that_would_never_be_meant_is_refused() {
    let reported = problems("[parameters]\ncross_track = \"1 m\"\n");
    assert!(reported.contains("cross_track is a signal"), "{reported}");
    let reported = problems("[[measure]]\nname = \"speed\"\nmax = \"altitude\"\n");
    assert!(reported.contains("speed is a signal"), "{reported}");
}

#[test]
fn a_reason_that_does_not_exist_is_refused() {
    let reported = problems("[[expect]]\nevent = \"APPROACHING 0 by resumed\"\n");
    assert!(reported.contains("did you mean resume?"), "{reported}");
    let reported = problems("[[expect]]\nevent = \"ARRIVED 0 by 'turn radios'\"\n");
    assert!(reported.contains("turn radius"), "{reported}");
}

#[test]
fn margins_say_how_much_is_left() {
    let mostly = |share: &str| {
        on_the_ground(&format!(
            "[[expect]]\nfrom = \"boot\"\nmostly = \"boot_time <= 4 s\"\nshare = {share}\n"
        ))
    };
    // A fifth of 5.1 s is outside.
    assert!((share_left(&mostly("60")) - 0.46).abs() < 0.02);
    let failed = &judged(&mostly("90"))[1].outcome;
    assert!(
        matches!(failed, Outcome::Failed { sentence, .. } if sentence.contains("instead of 90.0 %")),
        "{failed:?}"
    );
    let exact = "[[input]]\nname = \"ask\"\nat = \"2 s after boot\"\ndo = \"cli version\"\n";
    let at_once = "[[expect]]\nevent = \"reply\"\nwithin = \"0..1 s after input ask\"\n";
    assert!((share_left(&on_the_ground(&format!("{exact}{at_once}"))) - 1.0).abs() < 1e-9);
    let count = "[[expect]]\nat = \"reply\"\nthat = \"satellites = 4 or satellites = 0\"\n";
    assert!((share_left(&on_the_ground(&format!("{exact}{count}"))) - 1.0).abs() < 1e-9);
}

#[test]
fn a_refusal_by_the_fence_tells_both_distances() {
    let mut case = crate::scenarios::rig::case_of("guide-5", "rejected, noise none");
    case.watch_s = 0.1;
    let flown = fly(&case);
    let judged = judge(&case, &flown).0;
    let reported =
        judged.iter().find(|one| one.label == "rejected at the start, with both distances").unwrap();
    assert!(reported.outcome.is_met(), "{reported:?}");
    let margin = reported.outcome.margin().unwrap();
    assert!((margin.verdict.value - 150.4).abs() < 0.3, "{}", margin.shown());
}
