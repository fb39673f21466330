//! Flies a flight of the programme on both builds.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::programme::{Entry, Programme};
use crate::files::output_file::{cannot_write, replace};
use crate::headless::check::{RemoteFlown, Stopwatch, fly_case, judged, options_to_open};
use crate::headless::setup;
use crate::launch::RemoteFirmware;
use crate::launch::run::Stopped;
use crate::process::error::AppError;
use crate::report::check::CheckedFlight;
use crate::report::compare::flown_track;
use crate::report::lab::{LabFlight, measures_of, properties, values};
use crate::report::route::Route;
use crate::scenario::{Air, Case, Flown, Judgement, Scenario};
use crate::vehicle::Vehicle;

/// The two builds and their flights.
#[derive(Clone, Copy)]
pub(super) struct Pair<'a> {
    pub(super) programme: &'a Programme,
    pub(super) firmwares: &'a (Option<RemoteFirmware>, RemoteFirmware),
    pub(super) interrupted: &'a Arc<AtomicBool>,
    /// The folder for the signals of each flight.
    pub(super) keep: Option<&'a Path>,
}

impl Pair<'_> {
    /// Flies an entry on both builds, one after the other. `None` if it was interrupted.
    pub(super) fn fly(self, entry: Entry, thread: usize) -> Option<Result<LabFlight, AppError>> {
        let (scenario, case, air) = self.programme.flight(entry)?;
        let mut one =
            |firmware| self.one(firmware, (scenario, case, air), (self.programme.can_open(entry), thread));
        let base = match self.firmwares.0.as_ref().map(&mut one) {
            Some(None) => return None,
            Some(Some(flown)) => Some(flown),
            None => None,
        };
        let head = one(&self.firmwares.1)?;
        Some(base.transpose().and_then(|base| Ok(LabFlight { base, head: head? })))
    }

    /// Flies and judges a flight of one build. A flight that cannot be prepared has its problem.
    fn one(
        self,
        firmware: &RemoteFirmware,
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
            firmware_options: options_to_open(firmware).filter(|_| can_open),
            ..CheckedFlight::default()
        };
        let flown = fly_case(firmware, case, air, self.interrupted, thread, false, &mut Vec::new());
        let with_problem = |problem| Some(Ok(CheckedFlight { problem: Some(problem), ..checked.clone() }));
        match flown {
            Err(Stopped::Interrupted | Stopped::BySubscriber) => None,
            Err(Stopped::Failed(error)) => with_problem(error.message),
            Ok(Err(problem)) => with_problem(problem),
            Ok(Ok(RemoteFlown { flown, problem, hash, .. })) => {
                Some(measured(case, air, &flown).and_then(|(measures, properties)| {
                    self.keep(firmware, &checked, &flown)?;
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
    fn keep(self, firmware: &RemoteFirmware, flight: &CheckedFlight, flown: &Flown) -> Result<(), AppError> {
        let Some(folder) = self.keep else { return Ok(()) };
        let side = if std::ptr::eq(firmware, &raw const self.firmwares.1) { "head" } else { "base" };
        let case = if flight.case.is_empty() { String::new() } else { format!(" {}", flight.case) };
        let name = format!("{}{case} seed {}.{side}.csv", flight.scenario, flight.seed);
        // A case can have any characters.
        let name = name.replace(|c: char| !c.is_ascii_alphanumeric() && !" .,-_".contains(c), "_");
        let path = folder.join(name);
        replace(&path, values(flown).as_bytes()).map_err(|error| cannot_write(&path, &error))
    }
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
