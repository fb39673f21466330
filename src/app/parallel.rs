//! Flies on several threads and passes on the results in the order of the flights.
#![allow(clippy::disallowed_methods, reason = "threads for independent flights")]

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;

use super::AppError;

/// The notice about `--jobs` for a firmware on the wall clock.
pub(super) const JOBS_HAVE_NO_EFFECT: &str =
    "--jobs has no effect: a firmware on the wall clock flies one flight at a time.";

/// Returns the number of flights at once: the one of `--jobs`, or one a processor.
pub(super) fn threads(jobs: Option<u32>) -> usize {
    jobs.map_or_else(
        || std::thread::available_parallelism().map_or(1, std::num::NonZero::get),
        |jobs| jobs as usize,
    )
}

/// Flies all jobs with `fly`, which gets the number of its thread, on `threads` threads. `reported` gets each result in the
/// order of the jobs, with the number of finished flights; a flight that was interrupted has none.
pub(super) fn all<J: Copy + Sync, T: Send>(
    jobs: &[J],
    threads: usize,
    is_stopped: &(impl Fn() -> bool + Sync),
    fly: impl Fn(usize, J) -> Option<T> + Sync,
    mut reported: impl FnMut(T, usize),
) -> Result<(), AppError> {
    let next = AtomicUsize::new(0);
    let (results, arrived) = mpsc::channel();
    std::thread::scope(|scope| {
        for thread in 0..threads.min(jobs.len()) {
            let (results, next, fly) = (results.clone(), &next, &fly);
            scope.spawn(move || {
                while !is_stopped() {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(job) = jobs.get(index) else { return };
                    let flown = catch_unwind(AssertUnwindSafe(|| fly(thread, *job)));
                    if results.send((index, flown)).is_err() {
                        return;
                    }
                }
            });
        }
        drop(results);
        let mut early = BTreeMap::new();
        let (mut reported_up_to, mut arrived_count) = (0, 0);
        for (index, flown) in arrived {
            arrived_count += 1;
            early.insert(index, flown);
            while let Some(flown) = early.remove(&reported_up_to) {
                reported_up_to += 1;
                match flown {
                    Err(_) => return Err(AppError::internal("a flight panicked")),
                    Ok(None) => {}
                    Ok(Some(flown)) => reported(flown, arrived_count),
                }
            }
        }
        Ok(())
    })
}
