//! Reads, flies and judges cases.

use betadeck_core::flight::setup::BootLines;
use betadeck_core::plan::format::report;
use betadeck_core::scenario::{
    BuiltinFiles, BuiltinScenario, Case, CaseFlight, Flown, Judgement, Outcome, Scenario, judge, read,
};

/// Reads a built-in scenario with one seed.
#[track_caller]
pub(crate) fn builtin(name: &str) -> Scenario {
    with_more(name, "")
}

/// Reads a built-in scenario with one seed, and with these lines after its own.
#[track_caller]
fn with_more(name: &str, lines: &str) -> Scenario {
    let found = BuiltinScenario::find(name).unwrap_or_else(|| panic!("there is no {name}"));
    let text = format!("{}\n{lines}", found.text);
    read(name, &text, Some(&[1]), &mut BuiltinFiles).unwrap_or_else(|errors| panic!("{}", report(&errors)))
}

/// Returns a case of a built-in scenario by its whole name.
#[track_caller]
pub(crate) fn case_of(scenario: &str, case: &str) -> Case {
    case_with(scenario, case, "")
}

/// Returns a case of a built-in scenario that has these lines after its own.
#[track_caller]
pub(crate) fn case_with(scenario: &str, case: &str, lines: &str) -> Case {
    let all = with_more(scenario, lines).cases;
    let names: Vec<String> = all.iter().map(|known| known.name.clone()).collect();
    all.into_iter()
        .find(|known| known.name == case)
        .unwrap_or_else(|| panic!("{scenario} has no case {case}: {names:?}"))
}

/// Flies a case in its first air.
#[track_caller]
pub(crate) fn fly(case: &Case) -> Flown {
    CaseFlight::new(case, &case.airs[0]).unwrap().fly()
}

/// Flies a case and judges its expectations.
#[track_caller]
pub(crate) fn judged(case: &Case) -> Vec<Judgement> {
    judge(case, &fly(case)).0
}

/// Adds settings to the setup of a case, so that its craft differs from the scenario.
pub(crate) fn with_settings(mut case: Case, settings: &[&str]) -> Case {
    let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
    case.setup.boot_lines.push(BootLines::settings("fault", &settings));
    case
}

/// Panics unless the expectation of this name has failed with this text in its sentence.
#[track_caller]
pub(crate) fn assert_fails(judgements: &[Judgement], name: &str, reported: &str) {
    let judgement = judgements
        .iter()
        .find(|judgement| judgement.label == name)
        .unwrap_or_else(|| panic!("there is no expectation {name}"));
    match &judgement.outcome {
        Outcome::Failed { sentence, .. } => {
            assert!(sentence.contains(reported), "{name}: {sentence}");
        }
        other => panic!("{name}: {other:?}"),
    }
}

/// Panics unless all expectations were met.
#[track_caller]
pub(crate) fn assert_met(judgements: &[Judgement]) {
    let broken: Vec<&Judgement> = judgements.iter().filter(|judgement| !judgement.outcome.is_met()).collect();
    assert!(broken.is_empty(), "{broken:#?}");
}
