//! Counts the lost real time and decides when to report it.

use std::fmt;
use std::time::Duration;

use crate::telemetry::LostTime;

/// The time between two notices.
const NOTICE_INTERVAL: Duration = Duration::from_secs(60);
/// The least loss since the last notice that is reported.
const NOTABLE: Duration = Duration::from_millis(500);

/// A notice that real time was lost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LostTimeNotice {
    /// The loss so far.
    lost: LostTime,
    /// The requested multiple of real time.
    wanted: f64,
}

impl fmt::Display for LostTimeNotice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let LostTime { sum, achieved } = self.lost;
        write!(
            f,
            "Real time was lost: {:.1} s so far; the flight recently ran at {achieved:.2} times real time, \
             {} was requested.",
            sum.as_secs_f64(),
            self.wanted
        )
    }
}

/// The real time that a session has lost.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct RealTime {
    /// The time that was never flown.
    dropped: Duration,
    /// The current lag of a simulator's time after the wall clock …
    behind: Duration,
    /// … and its maximum. Time that the simulator makes up for later was lost all the same.
    most_behind: Duration,
    /// The time of the last notice, since the session began, and the loss that it reported.
    reported: Option<(Duration, Duration)>,
}

impl RealTime {
    /// Adds time that was dropped because the machine is too slow.
    pub(super) fn lose(&mut self, dropped: Duration) {
        self.dropped += dropped;
    }

    /// Records that a simulator advanced the flight by `simulated` in this much wall time.
    pub(super) fn advance(&mut self, wall: Duration, simulated: Duration) {
        self.behind = (self.behind + wall).saturating_sub(simulated);
        self.most_behind = self.most_behind.max(self.behind);
    }

    /// Returns the loss at this achieved speed.
    pub(super) fn lost(&self, achieved: f64) -> LostTime {
        LostTime { sum: self.dropped + self.most_behind, achieved }
    }

    /// Returns the notice that is due at `now`, counted since the session began.
    pub(super) fn notice(&mut self, now: Duration, wanted: f64, achieved: f64) -> Option<LostTimeNotice> {
        let (reported_at, reported) = self.reported.unzip();
        let is_due = reported_at.is_none_or(|at| now.saturating_sub(at) >= NOTICE_INTERVAL);
        let lost = self.lost(achieved);
        if !is_due || lost.sum.saturating_sub(reported.unwrap_or_default()) < NOTABLE {
            return None;
        }
        self.reported = Some((now, lost.sum));
        Some(LostTimeNotice { lost, wanted })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ms(n: u64) -> Duration {
        Duration::from_millis(n)
    }

    #[test]
    fn a_slow_machine_is_reported_once_a_minute_with_the_speed_and_the_sum() {
        let mut time = RealTime::default();
        let mut reported = Vec::new();
        for second in 1..=150 {
            time.lose(ms(400));
            reported
                .extend(time.notice(ms(second * 1000), 1.0, 0.6).map(|notice| (second, notice.to_string())));
        }
        assert_eq!(reported.iter().map(|(second, _)| *second).collect::<Vec<_>>(), [2, 62, 122]);
        assert_eq!(
            reported[1].1,
            "Real time was lost: 24.8 s so far; the flight recently ran at 0.60 times real time, 1 was requested."
        );
        assert_eq!(time.lost(0.6).to_string(), "60.0 s, at 0.60 times real time");
    }

    #[test]
    fn a_short_stall_is_counted_but_not_reported() {
        let mut time = RealTime::default();
        time.lose(ms(120));
        assert_eq!(time.notice(ms(5000), 1.0, 0.9), None);
        assert!(!time.lost(0.9).is_notable());
        time.lose(ms(400));
        assert!(time.notice(ms(6000), 1.0, 0.9).is_some());
        assert_eq!(time.notice(ms(600_000), 1.0, 1.0), None, "nothing was lost since");
    }

    #[test]
    fn a_simulator_that_is_slow_loses_time_and_one_that_is_fast_or_uneven_none() {
        let lost_after = |simulated_ms: [u64; 2]| {
            let mut time = RealTime::default();
            (0..1000).for_each(|step| time.advance(ms(10), ms(simulated_ms[step % 2])));
            time.lost(1.0).sum
        };
        assert_eq!(lost_after([5, 5]), ms(5000));
        assert_eq!(lost_after([12, 12]), ms(0));
        assert_eq!(lost_after([10, 10]), ms(0));
        assert!(lost_after([1, 19]) <= ms(9), "{:?}", lost_after([1, 19]));
    }
}
