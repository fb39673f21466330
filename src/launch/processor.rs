//! The processor of a flight with an executable in simulated time. The executable and the thread that flies its craft
//! take turns, so that one processor serves both. Between two processors each turn would wake the other one.

use rustix::thread::{CpuSet, sched_getaffinity, sched_getcpu, sched_setaffinity};

/// Keeps this thread, and the processes that it starts, on one processor: the `index`th of those that this program may
/// use, or the present one. Where the system refuses, flights are only slower.
pub(crate) fn keep_to_one(index: Option<usize>) {
    let Ok(allowed) = sched_getaffinity(None) else { return };
    let processors: Vec<usize> = (0..CpuSet::MAX_CPU).filter(|&one| allowed.is_set(one)).collect();
    let chosen = match index {
        Some(index) => processors.get(index % processors.len().max(1)).copied(),
        None => Some(sched_getcpu()),
    };
    if let Some(chosen) = chosen.filter(|&one| one < CpuSet::MAX_CPU) {
        let mut one = CpuSet::new();
        one.set(chosen);
        let _refused = sched_setaffinity(None, &one);
    }
}
