//! The time and the iteration of main frames: which ones follow those before them, and the time beyond the 32 bits of a log.

/// The greatest step of time between two main frames, µs.
const MAX_TIME_STEP: u32 = 10_000_000;
/// The greatest step of the iteration between two main frames: ten seconds at 32 kHz.
const MAX_ITERATION_STEP: u32 = 320_000;
/// Steps from here on are steps back.
const BACK: u32 = 1 << 31;

/// Time and iteration of a main frame as they are in the log.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Stamp {
    pub(super) iteration: u32,
    pub(super) time: u32,
}

impl Stamp {
    /// Returns the step of time from an earlier stamp, µs; `None` if this one is earlier.
    fn since(self, earlier: Self) -> Option<u32> {
        Some(self.time.wrapping_sub(earlier.time)).filter(|step| *step < BACK)
    }

    fn follows(self, earlier: Self) -> bool {
        let iterations = self.iteration.wrapping_sub(earlier.iteration);
        iterations <= MAX_ITERATION_STEP && self.since(earlier).is_some_and(|step| step <= MAX_TIME_STEP)
    }
}

/// The stamp of the last main frame and the time that has passed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Clock {
    last: Option<Stamp>,
    /// A stamp that did not follow. If the next one follows it, the log has a jump.
    doubted: Option<Stamp>,
    /// The time of the last main frame, µs.
    time_us: u64,
}

impl Clock {
    pub(super) fn time_us(&self) -> u64 {
        self.time_us
    }

    /// Returns the last stamp.
    pub(super) fn last(&self) -> Option<Stamp> {
        self.last
    }

    /// Returns `true` if a stamp follows the last one.
    pub(super) fn is_next(&self, stamp: Stamp) -> bool {
        self.last.is_some_and(|last| stamp.follows(last))
    }

    /// Takes the stamp of a frame with differences. Returns `false` and does nothing if it does not follow the last one.
    pub(super) fn step(&mut self, stamp: Stamp) -> bool {
        let follows = self.is_next(stamp);
        if follows {
            self.advance(stamp);
        }
        follows
    }

    /// Takes the stamp of a whole frame. Returns `false` if it does not follow the last one; the next one may confirm it.
    pub(super) fn whole(&mut self, stamp: Stamp) -> bool {
        let confirms = self.doubted.is_some_and(|doubted| stamp.follows(doubted));
        match self.last {
            None => self.time_us = stamp.time.into(),
            Some(last) if stamp.follows(last) => {}
            // A step back becomes a step on, so that times never go back.
            Some(last) if confirms => {
                self.last = if stamp.since(last).is_some() { Some(last) } else { self.doubted }
            }
            Some(_) => {
                self.doubted = Some(stamp);
                return false;
            }
        }
        self.advance(stamp);
        true
    }

    /// Takes the stamp of the event with which logging goes on after a pause.
    pub(super) fn resume(&mut self, stamp: Stamp) {
        if self.last.is_none() {
            self.time_us = stamp.time.into();
        }
        self.advance(stamp);
    }

    fn advance(&mut self, stamp: Stamp) {
        let step = self.last.and_then(|last| stamp.since(last)).unwrap_or_default();
        self.time_us += u64::from(step);
        self.last = Some(stamp);
        self.doubted = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stamp(iteration: u32, time: u32) -> Stamp {
        Stamp { iteration, time }
    }

    #[test]
    fn time_goes_on_when_the_32_bits_of_a_log_are_full() {
        let mut clock = Clock::default();
        assert!(clock.whole(stamp(0, u32::MAX - 100)));
        assert!(clock.step(stamp(1, 899)));
        assert_eq!(clock.time_us(), u64::from(u32::MAX) + 900);
    }

    #[test]
    fn a_jump_counts_once_it_is_confirmed() {
        let mut clock = Clock::default();
        assert!(clock.whole(stamp(0, 1000)));
        assert!(!clock.whole(stamp(32, 60_000_000)));
        assert!(clock.whole(stamp(64, 60_032_000)));
        assert_eq!(clock.time_us(), 60_032_000);
        assert!(!clock.whole(stamp(0, 5000)));
        assert!(!clock.whole(stamp(9, 500_000_000)), "another jump is no confirmation");
        assert!(!clock.whole(stamp(32, 37_000)));
        assert!(clock.whole(stamp(64, 69_000)));
        assert_eq!(clock.time_us(), 60_064_000, "a step back of the log is a step on of the time");
    }

    #[test]
    fn differences_never_jump() {
        let mut clock = Clock::default();
        assert!(!clock.step(stamp(1, 1000)));
        assert!(clock.whole(stamp(0, 0)));
        assert!(clock.step(stamp(1, 1000)));
        assert!(!clock.step(stamp(2, 999)));
        assert!(!clock.step(stamp(2, 20_000_000)));
        assert!(!clock.step(stamp(0, 2000)));
        assert!(clock.step(stamp(1, 1000)), "the same instant");
    }

    #[test]
    fn the_event_after_a_pause_moves_the_time() {
        let mut clock = Clock::default();
        assert!(clock.whole(stamp(0, 1000)));
        clock.resume(stamp(600_000, 600_000_000));
        assert!(clock.whole(stamp(600_032, 600_032_000)));
        assert_eq!(clock.time_us(), 600_032_000);
    }
}
