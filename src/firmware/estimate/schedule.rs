//! The slower loops, by division of time.

use crate::signals::SimTime;

/// The period of estimation, navigator and holds, µs: 100 Hz.
const NAVIGATION_US: u64 = 10_000;

/// The slower loops that run in this step. All parts follow these flags, so they stay in phase.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[doc(hidden)]
pub struct DueTasks {
    /// Roll and pitch are fresh, so the angle loop runs (500 Hz by default; each step if that does not divide the
    /// rate).
    pub attitude: bool,
    /// Position and altitude are fresh, so navigator, holds and modes run (100 Hz).
    pub navigation: bool,
}

/// Decides which loops are due.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Schedule {
    attitude: SimTime,
    navigation: SimTime,
}

impl Schedule {
    /// Returns the loops due at `now`. The attitude is due every `attitude_us`. Both are due in the first step.
    pub(super) fn due(&mut self, now: SimTime, attitude_us: u64) -> DueTasks {
        let navigation = pass(&mut self.navigation, now, NAVIGATION_US);
        let attitude = pass(&mut self.attitude, now, attitude_us);
        DueTasks { attitude: attitude || navigation, navigation }
    }
}

/// Returns `true` if `next` has come. It then advances `next`, skipping missed periods.
fn pass(next: &mut SimTime, now: SimTime, period_us: u64) -> bool {
    if now < *next {
        return false;
    }
    let missed = (now.0 - next.0) / period_us;
    next.0 += (missed + 1) * period_us;
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rate_gives_exact_hundredths() {
        for rate in [400_u64, 500, 1000, 2000, 4000, 8000] {
            let mut schedule = Schedule::default();
            let step = 1_000_000 / rate;
            let (mut attitude, mut navigation) = (0, Vec::new());
            for tick in 0..rate {
                let due = schedule.due(SimTime(tick * step), 2000);
                attitude += u64::from(due.attitude);
                if due.navigation {
                    navigation.push(tick * step);
                }
            }
            assert_eq!(navigation, (0..100).map(|n| n * 10_000).collect::<Vec<_>>(), "{rate}");
            assert_eq!(attitude, rate.min(500), "{rate}");
        }
    }

    #[test]
    fn the_attitude_period_follows_its_setting() {
        for (period_us, per_second) in [(1000, 1000), (2000, 500), (4000, 300)] {
            let mut schedule = Schedule::default();
            let due = (0..1000).filter(|tick| schedule.due(SimTime(tick * 1000), period_us).attitude);
            // Every navigation step also has a fresh attitude. Half of those are between two steps of 4 ms.
            assert_eq!(due.count(), per_second, "{period_us}");
        }
    }

    #[test]
    fn a_stall_is_not_made_up_for() {
        let mut schedule = Schedule::default();
        schedule.due(SimTime(0), 2000);
        assert!(schedule.due(SimTime(5_003_000), 2000).navigation);
        assert!(!schedule.due(SimTime(5_004_000), 2000).navigation);
        assert!(schedule.due(SimTime(5_010_000), 2000).navigation);
    }
}
