//! How the program and the executable wait for each other. If both share a processor that nobody else uses, a side that yields
//! hands it to the other one at half the cost of a sleep. On a busy processor somebody else gets it, for milliseconds.

use std::time::Duration;

/// The yields before a sleep.
pub(super) const YIELDS: u32 = 2;
/// A step of this length was interrupted by somebody else.
const INTERRUPTED: Duration = Duration::from_micros(300);
/// The steps without yields after the first interruption. Each further one doubles them, up to [`MAX_REST`].
const MIN_REST: u32 = 64;
const MAX_REST: u32 = 1 << 17;
/// The undisturbed steps in a row that halve the next rest.
const UNDISTURBED: u32 = 1000;

/// Decides which steps begin with yields.
#[derive(Debug)]
pub(super) struct Handover {
    /// The steps until the next yield.
    left: u32,
    /// The steps without yields after the next interruption.
    rest: u32,
    /// The undisturbed steps in a row.
    undisturbed: u32,
}

impl Default for Handover {
    fn default() -> Self {
        Self { left: 0, rest: MIN_REST, undisturbed: 0 }
    }
}

impl Handover {
    /// Returns `true` if both sides yield in the next step.
    pub(super) fn begin_step(&mut self) -> bool {
        let yields = self.left == 0;
        self.left = self.left.saturating_sub(1);
        yields
    }

    /// Takes the result of a step with yields: whether the report came before a sleep, and the length of the step.
    pub(super) fn end_step(&mut self, came: bool, took: Duration) {
        if !came || took >= INTERRUPTED {
            self.left = self.rest;
            self.rest = MAX_REST.min(2 * self.rest);
            self.undisturbed = 0;
            return;
        }
        self.undisturbed += 1;
        if self.undisturbed == UNDISTURBED {
            self.undisturbed = 0;
            self.rest = MIN_REST.max(self.rest / 2);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the number of steps with yields among so many, if this share of them is interrupted.
    fn yielding(steps: u32, interrupted: impl Fn(u32) -> bool) -> u32 {
        let (mut handover, mut count) = (Handover::default(), 0);
        for step in 0..steps {
            if handover.begin_step() {
                count += 1;
                let took = if interrupted(step) { INTERRUPTED } else { Duration::from_micros(5) };
                handover.end_step(true, took);
            }
        }
        count
    }

    #[test]
    fn an_idle_processor_is_handed_over_in_every_step_and_one_interruption_costs_little() {
        assert_eq!(yielding(100_000, |_| false), 100_000);
        assert_eq!(yielding(100_000, |step| step == 5000), 100_000 - MIN_REST);
    }

    #[test]
    fn a_busy_processor_is_hardly_ever_yielded() {
        assert!(yielding(1_000_000, |_| true) < 20);
        // Also if only some of the yields go to somebody else.
        assert!(yielding(1_000_000, |step| step % 50 == 0) < 3000);
    }

    #[test]
    fn a_report_that_only_a_sleep_brings_ends_the_yields() {
        let mut handover = Handover::default();
        assert!(handover.begin_step());
        handover.end_step(false, Duration::ZERO);
        assert!(!handover.begin_step());
    }
}
