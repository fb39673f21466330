//! Works on several threads and passes on the results in the order of the jobs, which are flights or recordings.
#![allow(clippy::disallowed_methods, reason = "threads for independent jobs")]

use std::collections::BTreeMap;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Condvar, Mutex, PoisonError, mpsc};
use std::time::Duration;

/// The most flights that may be over while an earlier one is still in the air. Their results wait in memory.
const AHEAD: u64 = 512;
/// The longest time after which a waiting thread looks whether it should stop.
const PATIENCE: Duration = Duration::from_millis(50);

/// A job panicked, which is a fault of this program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("a flight or the reading of a recording panicked")]
pub struct Panicked;

/// Returns the number of processors.
pub fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
}

/// Returns the number of threads for work beside a flight: all processors but one, which stays for the flight.
pub fn beside_a_flight() -> usize {
    but_one(processors())
}

fn but_one(processors: usize) -> usize {
    processors.saturating_sub(1).max(1)
}

/// Does the jobs with these numbers on `threads` threads. `fly` gets the number of its thread and of the job. `reported`
/// gets each result in the order of the jobs, with the number of finished jobs; a job that was interrupted has none.
///
/// # Errors
/// Fails if a job panicked. The other threads end.
pub fn in_order<T: Send>(
    jobs: Range<u64>,
    threads: usize,
    is_stopped: &(impl Fn() -> bool + Sync),
    fly: impl Fn(usize, u64) -> Option<T> + Sync,
    mut reported: impl FnMut(T, u64),
) -> Result<(), Panicked> {
    let next = AtomicU64::new(jobs.start);
    let gate = Gate::new(jobs.start);
    let (results, arrived) = mpsc::channel();
    let count = jobs.end.saturating_sub(jobs.start);
    std::thread::scope(|scope| {
        for thread in 0..threads.min(usize::try_from(count).unwrap_or(usize::MAX)) {
            let (results, next, fly, gate) = (results.clone(), &next, &fly, &gate);
            scope.spawn(move || {
                while !is_stopped() {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    if index >= jobs.end || !gate.wait(index, is_stopped) {
                        return;
                    }
                    let flown = catch_unwind(AssertUnwindSafe(|| fly(thread, index)));
                    if results.send((index, flown)).is_err() {
                        return;
                    }
                }
            });
        }
        drop(results);
        // Whatever ends the loop lets the threads go.
        let _open = Opened(&gate);
        let mut early = BTreeMap::new();
        let (mut reported_up_to, mut arrived_count) = (jobs.start, 0);
        for (index, flown) in arrived {
            arrived_count += 1;
            early.insert(index, flown);
            while let Some(flown) = early.remove(&reported_up_to) {
                reported_up_to += 1;
                match flown {
                    Err(_) => return Err(Panicked),
                    Ok(None) => {}
                    Ok(Some(flown)) => reported(flown, arrived_count),
                }
            }
            gate.open_to(reported_up_to);
        }
        Ok(())
    })
}

/// Keeps flights from running far ahead of one that takes long.
#[derive(Debug)]
struct Gate {
    reported: Mutex<u64>,
    changed: Condvar,
}

impl Gate {
    fn new(reported: u64) -> Self {
        Self { reported: Mutex::new(reported), changed: Condvar::new() }
    }

    fn open_to(&self, reported: u64) {
        *self.reported.lock().unwrap_or_else(PoisonError::into_inner) = reported;
        self.changed.notify_all();
    }

    /// Waits until a job may start. Returns `false` if it should not start any more.
    fn wait(&self, index: u64, is_stopped: &impl Fn() -> bool) -> bool {
        let mut reported = self.reported.lock().unwrap_or_else(PoisonError::into_inner);
        while index >= reported.saturating_add(AHEAD) {
            if is_stopped() {
                return false;
            }
            let waited = self.changed.wait_timeout(reported, PATIENCE);
            reported = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
        true
    }
}

/// Opens a gate for good when it goes out of use.
struct Opened<'a>(&'a Gate);

impl Drop for Opened<'_> {
    fn drop(&mut self) {
        self.0.open_to(u64::MAX);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_the_order_of_the_jobs_however_long_each_takes() {
        let first_waits = std::sync::Barrier::new(2);
        let fly = |_, index: u64| {
            // The first job ends only when another thread has come as far as it may.
            if index == 0 || index == AHEAD - 1 {
                first_waits.wait();
            }
            Some(index)
        };
        let mut seen = Vec::new();
        in_order(0..3 * AHEAD, 2, &|| false, fly, |index, _| seen.push(index)).expect("no panic");
        assert_eq!(seen, (0..3 * AHEAD).collect::<Vec<_>>());
    }

    #[test]
    fn a_processor_stays_for_the_flight_if_there_are_two() {
        assert_eq!([0, 1, 2, 8].map(but_one), [1, 1, 1, 7]);
    }

    #[test]
    fn a_panic_ends_the_run_and_lets_the_other_threads_go() {
        let fly = |_, index: u64| {
            assert!(index != 5, "as planned");
            Some(index)
        };
        assert!(in_order(0..10_000, 2, &|| false, fly, |_, _| {}).is_err());
    }
}
