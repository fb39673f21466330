//! Decides from which time on an error counts.

use crate::signals::SimTime;

/// The time that a craft gets to reach its place in addition to the time of the way, s.
const GRACE_S: f64 = 20.0;

/// The state of an error: it counts from its first small value on, at the latest after the time that the way takes
/// plus 20 s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Settle {
    Counts,
    /// The error counts from this time on at the latest.
    Until(SimTime),
}

impl Settle {
    /// Returns the state for a craft that has `way_m` to go at `speed_mps` from `now` on.
    pub(super) fn after(now: SimTime, way_m: f64, speed_mps: f64) -> Self {
        let way_s = way_m / speed_mps.max(0.1);
        Self::Until(SimTime::from_secs_f64(now.as_secs_f64() + way_s + GRACE_S))
    }

    /// Takes the error of an instant. Returns `true` if it counts.
    pub(super) fn counts(&mut self, now: SimTime, error_m: f64, small_m: f64) -> bool {
        if let Self::Until(latest) = *self
            && (error_m <= small_m || now >= latest)
        {
            *self = Self::Counts;
        }
        *self == Self::Counts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_counts_once_it_was_small() {
        let at = SimTime::from_secs_f64;
        let mut settle = Settle::after(at(10.0), 10.0, 5.0);
        assert!(!settle.counts(at(11.0), 9.0, 2.0));
        assert!(settle.counts(at(12.0), 1.9, 2.0));
        assert!(settle.counts(at(13.0), 9.0, 2.0), "it stays so");
    }

    #[test]
    fn an_error_that_stays_counts_after_the_way_and_twenty_seconds() {
        let at = SimTime::from_secs_f64;
        let mut settle = Settle::after(at(10.0), 10.0, 5.0);
        assert!(!settle.counts(at(31.9), 9.0, 2.0));
        assert!(settle.counts(at(32.0), 9.0, 2.0));
    }
}
