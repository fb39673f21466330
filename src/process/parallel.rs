//! The number of threads of a command, and lists of jobs that they share.

use std::ops::Range;

use crate::process::error::AppError;
use crate::runner::parallel;

/// The notice about `--jobs` for a firmware on the wall clock.
pub(crate) const JOBS_HAVE_NO_EFFECT: &str =
    "--jobs has no effect: a firmware on the wall clock flies one flight at a time.";

/// Returns the number of flights at once: the one of `--jobs`, or one per processor.
pub(crate) fn threads(jobs: Option<u32>) -> usize {
    jobs.map_or_else(parallel::processors, |jobs| jobs as usize)
}

/// Flies all jobs with `fly`, which gets the number of its thread, on `threads` threads. `reported` gets each result in the
/// order of the jobs, with the number of finished flights; a flight that was interrupted has none.
pub(crate) fn all<J: Copy + Sync, T: Send>(
    jobs: &[J],
    threads: usize,
    is_stopped: &(impl Fn() -> bool + Sync),
    fly: impl Fn(usize, J) -> Option<T> + Sync,
    mut reported: impl FnMut(T, usize),
) -> Result<(), AppError> {
    let fly = |thread, index: u64| jobs.get(index as usize).and_then(|job| fly(thread, *job));
    in_order(0..jobs.len() as u64, threads, is_stopped, fly, |flown, done| reported(flown, done as usize))
}

/// Does the same for the jobs with these numbers.
pub(crate) fn in_order<T: Send>(
    jobs: Range<u64>,
    threads: usize,
    is_stopped: &(impl Fn() -> bool + Sync),
    fly: impl Fn(usize, u64) -> Option<T> + Sync,
    reported: impl FnMut(T, u64),
) -> Result<(), AppError> {
    parallel::in_order(jobs, threads, is_stopped, fly, reported).map_err(AppError::internal)
}
