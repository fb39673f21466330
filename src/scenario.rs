//! Scenarios: flight plans as tests. A scenario file gives the plan, the air, the inputs and the expectations.
//!
//! ```text
//! text ── file ──▶ Scenario { cases: plan, air, inputs, expectations }
//!                     │ run: one case and seed, a headless flight
//!                     ▼
//!                  Trace: samples, happenings, guards ── judge ──▶ a Judgement for each expectation
//! ```
//!
//! This module does no I/O: the caller passes a reader for the files that a scenario names.
//!
//! ```
//! use betadeck_core::scenario::{BuiltinFiles, BuiltinScenario, CaseFlight, Outcome, judge, read};
//!
//! let found = BuiltinScenario::find("takeoff").unwrap();
//! let scenario = read(found.name, found.text, Some(&[1]), &mut BuiltinFiles).unwrap();
//! let case = &scenario.cases[0];
//! let flown = CaseFlight::new(case, &case.airs[0]).unwrap().fly();
//! let (judgements, _measures) = judge(case, &flown);
//! assert!(judgements.iter().all(|judgement| matches!(judgement.outcome, Outcome::Met(_))));
//! ```

mod air;
mod allowance;
mod campaign_spec;
mod case;
mod change;
mod draft;
pub mod expression;
mod file;
pub mod flag;
mod goal;
pub mod happening;
mod input;
mod insight;
mod judge;
mod library;
mod metric;
mod metric_values;
mod mission;
mod run;
mod sampling;
mod trace;
mod varied;

pub use air::{Air, AirTemplate, WindProblem, WindText};
pub use campaign_spec::{CampaignSpec, FlightSeeds, MAX_CAMPAIGN, USUAL_FLIGHTS, USUAL_LEVELS};
pub use case::{
    Allowance, Better, Case, Compare, Expectation, Expected, Measure, Measured, Scenario, StateStep,
    Statistic, Window,
};
pub use draft::Draft;
pub use file::{FORMAT, Files, Flights, MAX_FLIGHTS, MAX_SEEDS, Request, read, read_request, seed_range};
pub use goal::{Goal, GoalLimit, GoalStatistic, Quantity, Subject, percent};
pub use input::{Action, FORMS, TimedInput};
pub use insight::Insight;
pub use judge::{Judgement, Margin, Outcome, compare, judge, skip};
pub use library::{BuiltinFiles, BuiltinScenario, LAB_SCENARIOS, SCENARIOS};
pub use metric::Metric;
pub use metric_values::metrics;
pub use mission::{MISSION, mission, mission_number};
pub use run::{CaseFlight, FlightHash, Flown};
pub use trace::{KnownPlan, NearestGuard, Sample, Stay, Trace};
pub use varied::{Change, Choice, NumberInput, Spread, Tolerance, VariedInput};
