//! Scenarios: TOML, with the expressions in it.

use betadeck::plan::builtin::BuiltinPlan;
use betadeck::plan::format::{PlanFile, report};
use betadeck::scenario::{Case, CaseFlight, Files, MAX_FLIGHTS, Scenario, judge, read, skip};

/// The most cases that a scenario may have.
const MAX_CASES: usize = 1000;
/// The number of ticks that an accepted scenario flies.
const TICKS: u32 = 40;

/// A set of files that has every file: the square, and a setting.
struct AnyFiles;

impl Files for AnyFiles {
    fn plan(&mut self, name: &str) -> Result<PlanFile, String> {
        let square = BuiltinPlan::find("square").ok_or_else(|| format!("cannot open {name}"))?;
        square.read().map_err(|errors| report(&errors))
    }

    fn text(&mut self, _: &str) -> Result<String, String> {
        Ok("set ap_max_velocity = 800\n".to_owned())
    }
}

/// Reads the text. A scenario that is accepted can be flown and judged.
pub fn run(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let lines = text.lines().count().max(1);
    match read("s.toml", text, None, &mut AnyFiles) {
        Ok(scenario) => assert_sound(&scenario, lines),
        Err(problems) => {
            assert!(!problems.is_empty() && problems.is_sorted_by_key(|problem| problem.line));
            for problem in &problems {
                assert!((1..=lines + 1).contains(&problem.line) && problem.column >= 1, "{problem}");
                assert!(problem.width >= 1 && !problem.message.is_empty(), "{problem}");
            }
        }
    }
}

fn assert_sound(scenario: &Scenario, lines: usize) {
    assert!((1..=MAX_CASES).contains(&scenario.cases.len()));
    let flights: usize = scenario.cases.iter().map(|case| case.airs.len()).sum();
    assert!((scenario.cases.len()..=MAX_FLIGHTS).contains(&flights), "{flights} flights");
    for case in &scenario.cases {
        assert!(case.expectations.iter().all(|expected| (1..=lines).contains(&expected.line)));
        assert!(case.inputs.iter().all(|input| (1..=lines).contains(&input.line)));
    }
    // A scenario of many cases repeats the first one.
    assert_judged(&scenario.cases[0]);
}

/// Asserts that the beginning of the first flight has a judgement for each expectation.
fn assert_judged(case: &Case) {
    if let Some(skipped) = skip(case) {
        assert_eq!(skipped.len(), case.expectations.len());
    }
    let mut flight = match CaseFlight::new(case, &case.airs[0]) {
        Ok(flight) => flight,
        Err(problem) => {
            assert!(!problem.is_empty());
            return;
        }
    };
    for _ in 0..TICKS {
        if flight.is_over() {
            break;
        }
        flight.prepare();
        flight.tick(|_| {});
    }
    let (judgements, measures) = judge(case, &flight.finish());
    assert!(judgements.len() >= case.expectations.len());
    assert!(measures.len() <= case.parameters.len() + case.measures.len());
}
