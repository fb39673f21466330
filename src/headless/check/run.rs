//! The flights of a run of `check`, and their results.
#![allow(clippy::disallowed_methods, reason = "measures the wall time of flights")]

use std::path::Path;
use std::time::Instant;

use super::{Comparisons, Loaded};
use crate::args::{CheckArgs, MAX_ALLOWED_FLIGHTS};
use crate::files::log_output::{LogOnly, LogOutput};
use crate::headless::check::record::Record;
use crate::process::error::AppError;
use crate::report::check::{CheckedFlight, Compared};
use crate::report::flight::FlightReport;
use crate::runner::{Runner, Stopped};
use crate::scenario::{self, Air, Case, CaseFlight, Flown, Scenario};

/// A flight to be flown: the indices of its scenario, case and air, and the number of the repetition.
#[derive(Debug, Clone, Copy)]
pub(super) struct Job {
    scenario: usize,
    case: usize,
    air: usize,
    repetition: u32,
    /// The number of the flight in the run, from 0.
    pub(super) number: usize,
}

/// A measurement of wall time.
#[derive(Debug)]
pub(crate) struct Stopwatch(Instant);

impl Stopwatch {
    pub(crate) fn start() -> Self {
        Self(Instant::now())
    }

    pub(crate) fn seconds(&self) -> f64 {
        self.0.elapsed().as_secs_f64()
    }
}

/// The most judged expectations for each allowed flight. Their outcomes are kept to the end of the run.
const JUDGED_PER_FLIGHT: usize = 100;

/// Refuses a run with more flights than the user allows, or with too many results for the memory.
///
/// # Errors
/// Returns the number of flights and a suggestion.
pub(super) fn refuse_too_many(loaded: &Loaded, args: &CheckArgs) -> Result<(), AppError> {
    let most = args.most_flights();
    let repetitions = args.repeat.unwrap_or(1) as usize;
    let (mut flights, mut judged) = (0_usize, 0_usize);
    for scenario in &loaded.scenarios {
        for case in scenario.cases.iter().filter(|case| is_wanted(scenario, case, args)) {
            let of_case = case.airs.len().saturating_mul(repetitions);
            flights = flights.saturating_add(of_case);
            judged = judged.saturating_add(of_case.saturating_mul(case.expectations.len()));
        }
    }
    let most_judged = most.saturating_mul(JUDGED_PER_FLIGHT);
    let (problem, needed) = if flights > most {
        (format!("the run has {flights} flights, and {most} are allowed"), flights)
    } else if judged > most_judged {
        let needed = judged.div_ceil(JUDGED_PER_FLIGHT);
        (format!("the run judges {judged} expectations, and {most_judged} are allowed"), needed)
    } else {
        return Ok(());
    };
    let fewer = "choose fewer with --filter TEXT, --seeds A..B or a smaller --repeat";
    Err(AppError::input(if i64::try_from(needed).is_ok_and(|needed| needed <= MAX_ALLOWED_FLIGHTS) {
        format!("{problem}: {fewer}, or add --max-flights {needed}")
    } else {
        format!("{problem}: {fewer}; --max-flights allows up to {MAX_ALLOWED_FLIGHTS}")
    }))
}

/// Returns all requested flights, in the order of their reports.
pub(super) fn jobs(loaded: &Loaded, args: &CheckArgs) -> Vec<Job> {
    let mut jobs = Vec::new();
    for (scenario, read) in loaded.scenarios.iter().enumerate() {
        for (case, one) in read.cases.iter().enumerate() {
            if !is_wanted(read, one, args) {
                continue;
            }
            for air in 0..one.airs.len() {
                let repetitions = 0..args.repeat.unwrap_or(1);
                let first = jobs.len();
                jobs.extend((first..).zip(repetitions).map(|(number, repetition)| Job {
                    scenario,
                    case,
                    air,
                    repetition,
                    number,
                }));
            }
        }
    }
    jobs
}

/// Returns `true` if the case passes the filter.
pub(super) fn is_wanted(scenario: &Scenario, case: &Case, args: &CheckArgs) -> bool {
    args.filter.as_ref().is_none_or(|text| format!("{} {}", scenario.name, case.name).contains(text.as_str()))
}

/// A judged flight, and its report if there is one.
pub(super) type Judged = (CheckedFlight, Option<Box<FlightReport>>);

/// Flies and judges one flight, with its blackbox log in `log`, if that is a file. `None` if the flight was interrupted.
pub(super) fn one(
    loaded: &Loaded,
    job: Job,
    is_reported: bool,
    log: Option<&Path>,
    is_stopped: &impl Fn() -> bool,
) -> Option<Judged> {
    let (case, air) = job.of(loaded)?;
    let started = Stopwatch::start();
    let mut checked = job.not_flown_yet(loaded)?;
    let mut flight = match CaseFlight::new(case, air) {
        Ok(flight) => flight,
        Err(problem) => {
            checked.problem = Some(problem);
            return Some((checked, None));
        }
    };
    let mut record = Record::new(is_reported, flight.vehicle(), case);
    let mut runner = Runner::new(flight.vehicle().step_us(), f64::INFINITY, None);
    let mut log = match log.map(|path| LogOutput::begin(path, flight.vehicle_mut())).transpose() {
        Ok(log) => log.map(LogOnly::new),
        Err(error) => {
            checked.problem = Some(error.message);
            return Some((checked, None));
        }
    };
    let ended = runner.fly(&mut flight, &mut (&mut record, &mut log), is_stopped);
    let logged = log.map_or(Ok(()), LogOnly::finish);
    if ended == Err(Stopped::Interrupted) {
        return None;
    }
    checked.problem = logged.err().map(|error| error.message);
    let flown = flight.finish();
    let report = record.finish(case, &flown);
    Some((judged(checked, case, flown, &started), report))
}

/// Returns the judged flight.
pub(crate) fn judged(flight: CheckedFlight, case: &Case, flown: Flown, started: &Stopwatch) -> CheckedFlight {
    let (judgements, measures) = scenario::judge(case, &flown);
    CheckedFlight {
        reported: flown.reported,
        firmware: flown.firmware,
        judgements,
        measures,
        hash: flown.trace.hash(),
        engaged_at: flown.trace.engaged_at,
        flown_s: flown.trace.end().as_secs_f64(),
        ended_at: flown.ended_at,
        result: flown.result,
        reason: flown.reason,
        wall_s: started.seconds(),
        ..flight
    }
}

impl Job {
    /// Returns the case and the air of the job.
    pub(super) fn of<'l>(&self, loaded: &'l Loaded) -> Option<(&'l Case, &'l Air)> {
        let case = loaded.scenarios.get(self.scenario)?.cases.get(self.case)?;
        Some((case, case.airs.get(self.air)?))
    }

    /// Returns the name of the flight for its file: scenario, case, and seed if the case is flown with several.
    pub(super) fn name(&self, loaded: &Loaded) -> Option<String> {
        let scenario = loaded.scenarios.get(self.scenario)?;
        let (case, air) = self.of(loaded)?;
        let seed = if case.airs.len() > 1 { format!("seed {}", air.seed) } else { String::new() };
        Some(format!("{} {} {seed}", scenario.name, case.name))
    }

    /// Returns the facts that are known before the flight.
    pub(super) fn not_flown_yet(&self, loaded: &Loaded) -> Option<CheckedFlight> {
        let scenario = loaded.scenarios.get(self.scenario)?;
        let (case, air) = self.of(loaded)?;
        Some(CheckedFlight {
            scenario: scenario.name.clone(),
            file: scenario.file.clone(),
            case: case.name.clone(),
            base: case.base.clone(),
            variant: case.variant.clone(),
            seed: air.seed,
            seeds: case.airs.len(),
            seed_is_given: loaded.seeds_are_given,
            repetition: self.repetition,
            firmware_options: loaded.profile.map(|profile| format!(" --profile {profile}")),
            ..CheckedFlight::default()
        })
    }
}

/// The result of the first repetition of a flight.
#[derive(Debug, Default)]
pub(super) struct Repetitions {
    first: Option<(u64, Vec<scenario::Judgement>)>,
}

impl Repetitions {
    /// Adds a problem to a repetition that differs from the first.
    pub(super) fn compare(&mut self, mut flight: CheckedFlight) -> CheckedFlight {
        if flight.repetition == 0 {
            self.first = Some((flight.hash, flight.judgements.clone()));
        } else if let Some((hash, judgements)) = &self.first
            && (*hash != flight.hash || *judgements != flight.judgements)
        {
            flight.problem = Some(format!(
                "repetition {} differs from the first flight: a repeated flight must be identical to the last bit",
                flight.repetition + 1
            ));
        }
        flight
    }
}

/// Judges the comparisons of several flights, for each combination of varied values and each seed that all its cases
/// have. If the cases have no common seed, the comparison counts as never judged, unless a filter left out some of
/// them.
pub(super) fn compared(loaded: &Loaded, flights: &[CheckedFlight], is_filtered: bool) -> Comparisons {
    let mut compared = Vec::new();
    for scenario in loaded.scenarios.iter().filter(|scenario| !scenario.compares.is_empty()) {
        let own = || flights.iter().filter(|flight| flight.file == scenario.file && flight.repetition == 0);
        let firmware = own().find_map(|flight| flight.firmware);
        let mut groups: Vec<(&str, u64)> =
            own().map(|flight| (flight.variant.as_str(), flight.seed)).collect();
        groups.sort_unstable();
        groups.dedup();
        for of_variant in groups.chunk_by(|a, b| a.0 == b.0) {
            let Some(&(variant, first)) = of_variant.first() else { continue };
            let wanted = scenario.cases.iter().filter(|case| case.variant == variant).count();
            let group = |seed| own().filter(move |flight| flight.variant == variant && flight.seed == seed);
            let whole: Vec<u64> = of_variant
                .iter()
                .map(|&(_, seed)| seed)
                .filter(|&seed| group(seed).count() >= wanted)
                .collect();
            let mut tell = |seed, judgement| {
                compared.push(Compared {
                    scenario: scenario.name.clone(),
                    file: scenario.file.clone(),
                    variant: variant.to_owned(),
                    seed,
                    judgement,
                });
            };
            for &seed in &whole {
                let names: Vec<(String, f64)> = group(seed)
                    .flat_map(|flight| {
                        let measures = flight.measures.iter();
                        measures.map(|(name, value)| (format!("{}.{name}", flight.base), *value))
                    })
                    .collect();
                let reported = group(seed).map(|flight| flight.reported).min().unwrap_or_default();
                for compare in scenario.compares.iter().filter(|compare| compare.holds_for(firmware)) {
                    tell(seed, scenario::compare(compare, &names, reported));
                }
            }
            if whole.is_empty() && !is_filtered {
                let compares = scenario.compares.iter().filter(|compare| compare.holds_for(firmware));
                compares.for_each(|compare| tell(first, compare.never_judged()));
            }
        }
    }
    compared
}
