//! The flights of a comparison.

use super::Compared;
use crate::args::CompareArgs;
use crate::files::log_output::needs_embedded;
use crate::process::error::AppError;
use crate::scenario::MAX_FLIGHTS;
use crate::sim::{Noise, WorldConfig};
use crate::telemetry::Turbulence;

/// A flight to be flown.
#[derive(Debug, Clone, Copy)]
pub(super) struct Job {
    /// The index of its firmware.
    pub(super) side: usize,
    pub(super) seed: u64,
    /// The number of the flight of this firmware, from 1, and the number of all its flights.
    pub(super) number: (usize, usize),
    /// The place of the flight among those that can have a blackbox log, which are those of embedded firmwares.
    pub(super) log: Option<usize>,
}

impl Job {
    /// Returns the name of the flight, for people.
    pub(super) fn title(self, args: &CompareArgs) -> String {
        match (args.seeds.is_some(), self.number) {
            (true, _) => format!("seed {}", self.seed),
            (false, (number, all)) => format!("flight {number} of {all}"),
        }
    }
}

/// Returns all flights, in the order of their reports: those of the first firmware first.
///
/// # Errors
/// Returns an error if the option for several flights does not fit the firmwares, or if there are too many flights.
pub(super) fn jobs(
    args: &CompareArgs,
    compared: &[Compared; 2],
    seeds: &[u64],
) -> Result<Vec<Job>, AppError> {
    check_option(args, compared)?;
    let times = |one: &Compared| seeds.len().saturating_mul(one.times as usize);
    let all = compared.iter().map(times).fold(0, usize::saturating_add);
    if all > MAX_FLIGHTS {
        return Err(AppError::input(format!(
            "the comparison has {all} flights, and {MAX_FLIGHTS} are allowed: choose fewer with --seeds A..B"
        )));
    }
    let mut jobs = Vec::with_capacity(all);
    let mut logs = 0..;
    for (side, one) in compared.iter().enumerate() {
        let flights = seeds.iter().flat_map(|&seed| (0..one.times).map(move |_| seed)).enumerate();
        jobs.extend(flights.map(|(index, seed)| Job {
            side,
            seed,
            number: (index + 1, times(one)),
            log: if one.firmware.is_none() { logs.next() } else { None },
        }));
    }
    Ok(jobs)
}

/// Returns the names of the flights that can have a blackbox log: the firmware, and the seed if there are several.
///
/// # Errors
/// Returns an error if logs are wanted and no embedded firmware flies.
pub(super) fn logged(
    args: &CompareArgs,
    compared: &[Compared; 2],
    jobs: &[Job],
) -> Result<Vec<String>, AppError> {
    if args.blackbox.is_some() && jobs.iter().all(|job| job.log.is_none()) {
        return Err(needs_embedded());
    }
    let of_seed =
        |job: &Job| if args.seeds.is_some() { format!(" seed {}", job.seed) } else { String::new() };
    let logged = jobs.iter().filter(|job| job.log.is_some());
    Ok(logged.filter_map(|job| Some(format!("{}{}", compared.get(job.side)?.name, of_seed(job)))).collect())
}

/// Refuses other seeds for a firmware on the wall clock.
fn check_option(args: &CompareArgs, compared: &[Compared; 2]) -> Result<(), AppError> {
    match (&args.seeds, compared.iter().find(|one| one.is_on_wall_clock())) {
        (Some(_), Some(one)) if one.is_attached() => Err(AppError::input(
            "--seeds: a firmware that is running already (--firmware attach) is not restarted for each flight, so it \
             flies once; write --repeat 1, or name its executable",
        )),
        (Some(_), Some(one)) => Err(seeds_on_wall_clock(&one.name)),
        _ => Ok(()),
    }
}

/// Returns the error for several seeds of a firmware on the wall clock.
pub(super) fn seeds_on_wall_clock(name: &str) -> AppError {
    AppError::input(format!(
        "--seeds: {name} flies on the wall clock, where no two flights are the same; use --repeat N"
    ))
}

/// Returns the seeds to fly. Without randomness one is enough, and a notice says so.
pub(super) fn seeds(args: &CompareArgs, world: &WorldConfig, notices: &mut Vec<String>) -> Vec<u64> {
    let WorldConfig { noise, gust_mps, turbulence, .. } = world;
    let is_random = *noise != Noise::None || *gust_mps > 0.0 || *turbulence != Turbulence::None;
    match args.seeds.as_ref().map(|seeds| seeds.0.as_slice()) {
        None => vec![world.seed],
        Some([first, _, ..]) if !is_random => {
            notices.push(format!(
                "Only seed {first} is flown: without noise, gusts and turbulence every seed gives the same flight."
            ));
            vec![*first]
        }
        Some(seeds) => seeds.to_vec(),
    }
}
