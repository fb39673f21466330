//! Whole scenarios: text in, judgements out.

use super::*;
use crate::plan::format::{PlanFile, report};

/// No file is at hand.
struct NoFiles;

impl Files for NoFiles {
    fn plan(&mut self, name: &str) -> Result<PlanFile, String> {
        Err(format!("there is no {name}"))
    }

    fn text(&mut self, name: &str) -> Result<String, String> {
        Err(format!("there is no {name}"))
    }
}

fn scenario(text: &str) -> Scenario {
    read("test.toml", text, None, &mut BuiltinFiles).unwrap_or_else(|errors| panic!("{}", report(&errors)))
}

#[test]
fn guide_1() {
    let scenario = scenario(include_str!("../../plans/scenarios/guide-1.toml"));
    for case in &scenario.cases {
        for air in &case.airs {
            let flown = CaseFlight::new(case, air).unwrap().fly();
            println!("{} {} {} {}", case.name, air.seed, flown.result, flown.reason);
            for judgement in judge(case, &flown).0 {
                println!("  {judgement:?}");
            }
        }
    }
    panic!();
}
