//! Flies a sweep on several threads.

use std::sync::{Mutex, PoisonError};

use crate::flight::sweep::{Branch, Sweep, SweepPoint};
use crate::runner::parallel::{Panicked, in_order};

/// The most branches that wait in memory at the same time.
const WAITING: usize = 64;

/// The reason why a sweep ended early.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SweepProblem {
    /// The fault cannot be flown: a sentence.
    #[error("{0}")]
    Refused(String),
    #[error(transparent)]
    Panicked(#[from] Panicked),
}

/// Flies the branches of a sweep on `threads` threads. `reported` gets the points in the order of their seconds. It gets
/// none after one that was stopped.
///
/// # Errors
/// Fails if the fault cannot be flown, or if a flight panicked.
pub fn fly_sweep(
    sweep: &mut Sweep,
    threads: usize,
    is_stopped: &(impl Fn() -> bool + Sync),
    mut reported: impl FnMut(SweepPoint),
) -> Result<(), SweepProblem> {
    let mut next = 0;
    loop {
        let mut branches = Vec::with_capacity(WAITING);
        while branches.len() < WAITING
            && let Some(branch) = sweep.next_branch(is_stopped).map_err(SweepProblem::Refused)?
        {
            branches.push(Mutex::new(Some(branch)));
        }
        let fly = |_, index: u64| take(&branches, index)?.fly(is_stopped);
        in_order(0..branches.len() as u64, threads, is_stopped, fly, |point, _| {
            // A point after one that was stopped would be in the wrong place.
            if point.second == next {
                next += 1;
                reported(point);
            }
        })?;
        if branches.len() < WAITING || is_stopped() {
            return Ok(());
        }
    }
}

fn take(branches: &[Mutex<Option<Branch>>], index: u64) -> Option<Branch> {
    branches.get(index as usize)?.lock().unwrap_or_else(PoisonError::into_inner).take()
}
