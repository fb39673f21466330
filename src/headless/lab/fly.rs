//! Flies a flight of the programme on both builds.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::programme::{Entry, Programme};
use crate::fc::{ProvisionLines, starter_lines};
use crate::files::output_file::{cannot_write, replace};
use crate::flight::setup::BootLines;
use crate::headless::check::{RemoteFlown, Stopwatch, fly_case, judged, options_to_open};
use crate::headless::setup;
use crate::launch::RemoteFirmware;
use crate::launch::run::Stopped;
use crate::process::error::AppError;
use crate::report::check::CheckedFlight;
use crate::report::compare::flown_track;
use crate::report::lab::{LabFlight, measures_of, properties, values};
use crate::report::route::Route;
use crate::runner::Runner;
use crate::scenario::{Air, Case, CaseFlight, Flown, Judgement, Scenario};
use crate::telemetry::FirmwareProfile;
use crate::vehicle::Vehicle;

/// The prefix of a setting's line.
const SET: &str = "set ";

/// A build.
#[derive(Debug)]
pub(super) enum Build {
    /// The embedded firmware in the profile `master`.
    Embedded,
    /// An executable.
    Executable(Box<RemoteFirmware>),
}

/// The two builds and their flights.
#[derive(Clone, Copy)]
pub(super) struct Pair<'a> {
    pub(super) programme: &'a Programme,
    pub(super) builds: &'a (Option<Build>, Build),
    pub(super) interrupted: &'a Arc<AtomicBool>,
    /// The folder for the signals of each flight.
    pub(super) keep: Option<&'a Path>,
}

impl Pair<'_> {
    /// Flies an entry on both builds, one after the other. `None` if it was interrupted.
    pub(super) fn fly(self, entry: Entry, thread: usize) -> Option<Result<LabFlight, AppError>> {
        let (scenario, case, air) = self.programme.flight(entry)?;
        let mut one =
            |build| self.one(build, (scenario, case, air), (self.programme.can_open(entry), thread));
        let base = match self.builds.0.as_ref().map(&mut one) {
            Some(None) => return None,
            Some(Some(flown)) => Some(flown),
            None => None,
        };
        let head = one(&self.builds.1)?;
        Some(base.transpose().and_then(|base| Ok(LabFlight { base, head: head? })))
    }

    /// Flies and judges a flight of one build. A flight that cannot be prepared has its problem.
    fn one(
        self,
        build: &Build,
        (scenario, case, air): (&Scenario, &Case, &Air),
        (can_open, thread): (bool, usize),
    ) -> Option<Result<CheckedFlight, AppError>> {
        let started = Stopwatch::start();
        let checked = CheckedFlight {
            scenario: scenario.name.clone(),
            file: scenario.file.clone(),
            case: case.name.clone(),
            base: case.base.clone(),
            variant: case.variant.clone(),
            seed: air.seed,
            seeds: case.airs.len(),
            seed_is_given: self.programme.has_own_seeds(),
            is_remote: true,
            firmware_options: build.options_to_open().filter(|_| can_open),
            ..CheckedFlight::default()
        };
        let flown = match build {
            Build::Embedded => fly_embedded(case, air, self.interrupted),
            Build::Executable(firmware) => {
                fly_case(firmware, case, air, self.interrupted, thread, false, &mut Vec::new())
            }
        };
        let with_problem = |problem| Some(Ok(CheckedFlight { problem: Some(problem), ..checked.clone() }));
        match flown {
            Err(Stopped::Interrupted | Stopped::BySubscriber) => None,
            Err(Stopped::Failed(error)) => with_problem(error.message),
            Ok(Err(problem)) => with_problem(problem),
            Ok(Ok(RemoteFlown { flown, problem, hash, .. })) => {
                Some(measured(case, air, &flown).and_then(|(measures, properties)| {
                    self.keep(build, &checked, &flown)?;
                    let mut flight = judged(checked, case, flown, &started);
                    flight.problem = problem;
                    flight.hash = hash.unwrap_or(flight.hash);
                    flight.measures.extend(measures);
                    flight.judgements.extend(properties);
                    Ok(flight)
                }))
            }
        }
    }

    /// Writes the signals of a flight, if they are wanted: `lab-landing calm seed 3.head.csv`.
    fn keep(self, build: &Build, flight: &CheckedFlight, flown: &Flown) -> Result<(), AppError> {
        let Some(folder) = self.keep else { return Ok(()) };
        let side = if std::ptr::eq(build, &raw const self.builds.1) { "head" } else { "base" };
        let case = if flight.case.is_empty() { String::new() } else { format!(" {}", flight.case) };
        let name = format!("{}{case} seed {}.{side}.csv", flight.scenario, flight.seed);
        // A case can have any characters.
        let name = name.replace(|c: char| !c.is_ascii_alphanumeric() && !" .,-_".contains(c), "_");
        let path = folder.join(name);
        replace(&path, values(flown).as_bytes()).map_err(|error| cannot_write(&path, &error))
    }
}

impl Build {
    /// Returns the options of `betadeck open` that fly with the same build, as text with a blank before each.
    fn options_to_open(&self) -> Option<String> {
        match self {
            // It has the guide's settings, too, which no option gives.
            Self::Embedded => None,
            Self::Executable(firmware) => options_to_open(firmware),
        }
    }
}

/// Flies a case with the embedded firmware in the profile `master`.
fn fly_embedded(
    case: &Case,
    air: &Air,
    interrupted: &AtomicBool,
) -> Result<Result<RemoteFlown, String>, Stopped> {
    let mut case = case.clone();
    // An executable starts with the guide's settings and the starter modes, under those of the plan and the case.
    let lines = match starter_lines(&ProvisionLines::default(), true) {
        Ok(lines) => lines.usual,
        Err(problem) => return Ok(Err(problem.to_owned())),
    };
    let (settings, others): (Vec<&str>, Vec<&str>) =
        lines.iter().map(String::as_str).partition(|line| line.starts_with(SET));
    let settings = settings.iter().map(|line| line.trim_start_matches(SET).to_owned());
    let plan = &mut case.setup.plan;
    plan.settings = settings.chain(std::mem::take(&mut plan.settings)).collect();
    let modes = BootLines { source: "starter modes".to_owned(), text: others.join("\n") };
    case.setup.boot_lines.insert(0, modes);
    case.use_profile(FirmwareProfile::Master);
    let mut flight = match CaseFlight::new(&case, air) {
        Ok(flight) => flight,
        Err(problem) => return Ok(Err(problem)),
    };
    let mut runner = Runner::new(flight.vehicle().step_us(), f64::INFINITY, None);
    runner.fly(&mut flight, &mut (), || interrupted.load(Ordering::Relaxed))?;
    let flown = flight.finish();
    Ok(Ok(RemoteFlown { flown, problem: None, hash: None, report: None }))
}

/// The measures and the judgements that all flights have in common.
type Common = (Vec<(String, f64)>, Vec<Judgement>);

/// Returns the measures and the judgements that all flights have in common.
fn measured(case: &Case, air: &Air, flown: &Flown) -> Result<Common, AppError> {
    // The embedded firmware knows the settings of the case.
    let vehicle: Vehicle = setup::build(case.setup_in(air), &mut Vec::new())?;
    let frame = *vehicle.local_frame().ok_or_else(|| AppError::internal("the craft has no position"))?;
    let settings = vehicle.controller().settings_view().unwrap_or_default();
    let route = Route::new(&case.setup.plan.plan, &frame, &settings);
    let track = flown_track(flown, air.seed);
    Ok((measures_of(&route, &track), properties(flown, &route, &settings)))
}
