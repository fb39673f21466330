//! The programme: which flights are flown, in which order.

use crate::args::LabArgs;
use crate::headless::check::{load_one, load_or_plan};
use crate::process::error::AppError;
use crate::report::lab::{LabMeasure, common, measures_of_case};
use crate::scenario::{Air, Case, LAB_SCENARIOS, MISSION, Scenario};
use crate::sim::Noise;

/// The beginning of the names of the scenarios of the test guide, and their numbers.
const OF_GUIDE: &str = "guide-";
const GUIDE: std::ops::RangeInclusive<u32> = 1..=8;
/// The number of random missions.
const MISSIONS: u32 = 200;
/// The lines of a scenario that flies a plan of the user.
const OF_PLAN: &str = "seeds = \"1..12\"\nair = { noise = \"real\", wind = \"{seed % 7}@{53 * seed % 360}\", turbulence = \"light\" }";
/// The missions after each round, which has a seed of each case.
const MISSIONS_A_ROUND: usize = 25;

/// A flight of the programme: the indices of its scenario, case and air.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Entry {
    scenario: usize,
    case: usize,
    air: usize,
}

/// All flights, in their order.
#[derive(Debug)]
pub(super) struct Programme {
    scenarios: Vec<Scenario>,
    entries: Vec<Entry>,
    measures: Vec<LabMeasure>,
    /// The scenarios that were made of plans. No command opens their flights.
    plans: Vec<usize>,
    /// `true` if the seeds are not those of the files.
    has_own_seeds: bool,
}

impl Programme {
    /// Reads the programme.
    pub(super) fn read(args: &LabArgs) -> Result<Self, AppError> {
        let (mut scenarios, mut plans) = (Vec::<Scenario>::new(), Vec::new());
        for path in &args.with {
            let (scenario, is_plan) = reseeded(args, |seeds| load_or_plan(path, OF_PLAN, seeds))?;
            if scenarios.iter().any(|other| other.name == scenario.name) {
                let name = &scenario.name;
                return Err(AppError::input(format!(
                    "--with: two files have the name {name}: rename one of them"
                )));
            }
            if is_plan {
                plans.push(scenarios.len());
            }
            scenarios.push(scenario);
        }
        let guide = GUIDE.map(|number| format!("{OF_GUIDE}{number}"));
        let topics = LAB_SCENARIOS.iter().map(|topic| topic.name.to_owned());
        let first = (args.seed - 1) * MISSIONS;
        for name in topics.chain(guide) {
            if let Some(own) = scenarios.iter().find(|own| own.name == name) {
                let file = &own.file;
                return Err(AppError::input(format!(
                    "--with {file}: the programme has a scenario {name}: rename it"
                )));
            }
            scenarios.push(reseeded(args, |seeds| Ok((load_one(&name, seeds, false)?, false)))?.0);
        }
        let topics = scenarios.len();
        for number in first..first + MISSIONS {
            scenarios.push(load_one(&format!("{MISSION}{number}"), None, false)?);
        }
        let mut measures: Vec<LabMeasure> = common().collect();
        for scenario in &scenarios {
            for measure in scenario.cases.iter().flat_map(|case| measures_of_case(&scenario.name, case)) {
                if !measures.contains(&measure) {
                    measures.push(measure);
                }
            }
        }
        let mut entries = order(&scenarios, topics);
        let is_wanted = |entry: &Entry| {
            let title = scenarios.get(entry.scenario).and_then(|scenario| {
                Some(format!("{} {}", scenario.name, scenario.cases.get(entry.case)?.name))
            });
            args.filter.as_ref().is_none_or(|text| title.is_some_and(|title| title.contains(text.as_str())))
        };
        entries.retain(is_wanted);
        if entries.is_empty() {
            return Err(AppError::input(
                "no flight has this text in its name: betadeck lab --list shows the names",
            ));
        }
        Ok(Self {
            scenarios,
            entries,
            measures,
            plans,
            has_own_seeds: args.seed != 1 || args.seeds.is_some(),
        })
    }

    /// Returns the flights in their order.
    pub(super) fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// Returns each measure of the flights once.
    pub(super) fn measures(&self) -> &[LabMeasure] {
        &self.measures
    }

    /// Returns `true` if the seeds are not those of the files.
    pub(super) fn has_own_seeds(&self) -> bool {
        self.has_own_seeds
    }

    /// Returns `true` if a command can open the flight.
    pub(super) fn can_open(&self, entry: Entry) -> bool {
        !self.plans.contains(&entry.scenario)
    }

    /// Returns the scenario, the case and the air of a flight.
    pub(super) fn flight(&self, entry: Entry) -> Option<(&Scenario, &Case, &Air)> {
        let scenario = self.scenarios.get(entry.scenario)?;
        let case = scenario.cases.get(entry.case)?;
        Some((scenario, case, case.airs.get(entry.air)?))
    }

    /// Returns the names of all flights, a line for each case.
    pub(super) fn list(&self) -> String {
        let count = self.entries.len();
        let mut text = if count == 1 { "1 flight\n".to_owned() } else { format!("{count} flights\n") };
        for (index, scenario) in self.scenarios.iter().enumerate() {
            for (at, case) in scenario.cases.iter().enumerate() {
                let is_of = |entry: &&Entry| (entry.scenario, entry.case) == (index, at);
                let flights = self.entries.iter().filter(is_of).count();
                let name = if case.name.is_empty() { String::new() } else { format!(" {}", case.name) };
                match flights {
                    0 => {}
                    1 => text.push_str(&format!("{}{name}\n", scenario.name)),
                    _ => text.push_str(&format!("{}{name} ({flights} seeds)\n", scenario.name)),
                }
            }
        }
        text
    }
}

/// Reads a scenario, for a number above 1 with other seeds than its own.
fn reseeded(
    args: &LabArgs,
    read: impl Fn(Option<&[u64]>) -> Result<(Scenario, bool), AppError>,
) -> Result<(Scenario, bool), AppError> {
    if let Some(seeds) = &args.seeds {
        return read(Some(&seeds.0));
    }
    let (own, number) = (read(None)?, args.seed);
    if number == 1 {
        return Ok(own);
    }
    let count = own.0.cases.iter().map(|case| case.airs.len() as u64).max().unwrap_or(1);
    let first = 1000 * u64::from(number);
    read(Some(&(first..first + count).collect::<Vec<u64>>()))
}

/// Returns the flights in rounds: one seed of each case of the first scenarios, then some missions. So each part of the
/// programme gets its share of any time.
fn order(scenarios: &[Scenario], topics: usize) -> Vec<Entry> {
    let mut missions = (topics..scenarios.len()).map(|scenario| Entry { scenario, case: 0, air: 0 });
    let mut entries = Vec::new();
    for air in 0.. {
        let before = entries.len();
        for (scenario, read) in scenarios.iter().enumerate().take(topics) {
            for (case, one) in read.cases.iter().enumerate() {
                // Without noise every flight of a case is the same, and the guide's cases with noise fly the same plans.
                let is_exact =
                    one.airs.first().is_some_and(|air| air.noise == Noise::None) && read.cases.len() > 1;
                if air < one.airs.len() && !is_exact {
                    entries.push(Entry { scenario, case, air });
                }
            }
        }
        entries.extend(missions.by_ref().take(MISSIONS_A_ROUND));
        if entries.len() == before {
            break;
        }
    }
    entries
}
