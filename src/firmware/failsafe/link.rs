//! The debounced receiver link.

use crate::signals::SimTime;

/// The shortest delay of either edge, s.
const MIN_DELAY_S: f64 = 0.1;

/// The delays of the link.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinkConfig {
    /// The age of the last valid frame above which the link is down, s.
    pub delay_s: f64,
    /// The time with a signal after which the link is up, s.
    pub recovery_delay_s: f64,
}

impl Default for LinkConfig {
    fn default() -> Self {
        Self { delay_s: 1.5, recovery_delay_s: 0.5 }
    }
}

/// Judges the link at every receiver pass.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LinkMonitor {
    up: bool,
    good: bool,
    last_valid: Option<SimTime>,
    signal_since: Option<SimTime>,
}

/// An edge of the signal that is reported to the pilot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinkChange {
    Lost,
    /// The signal has been back for the recovery delay.
    Recovered,
}

impl LinkMonitor {
    /// Returns `true` while the link is up. It comes up after the recovery delay with a signal, and goes down if the
    /// last valid frame is older than the failsafe delay.
    pub fn up(&self) -> bool {
        self.up
    }

    /// Returns `true` if the signal has been present for the recovery delay.
    pub fn good(&self) -> bool {
        self.good
    }

    /// Runs one receiver pass. `signal` is the receiver's verdict, `last_frame` the time of its newest frame. With
    /// `at_once` the link comes up without the recovery delay (after a failsafe started by the switch).
    pub fn update(
        &mut self,
        config: &LinkConfig,
        now: SimTime,
        signal: bool,
        last_frame: Option<SimTime>,
        at_once: bool,
    ) -> Option<LinkChange> {
        let was_good = self.good;
        let had_signal = self.signal_since.is_some();
        if signal {
            self.last_valid = last_frame;
            let since = *self.signal_since.get_or_insert(now);
            if at_once || now.seconds_since(since) >= config.recovery_delay_s.max(MIN_DELAY_S) {
                self.good = true;
                self.up = true;
            }
        } else {
            self.signal_since = None;
            self.good = false;
            let delay_s = config.delay_s.max(MIN_DELAY_S);
            self.up &= self.last_valid.is_some_and(|last| now.seconds_since(last) <= delay_s);
        }
        match (had_signal, signal) {
            (true, false) => Some(LinkChange::Lost),
            _ if self.good && !was_good => Some(LinkChange::Recovered),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: u64) -> SimTime {
        SimTime(ms * 1000)
    }

    #[test]
    fn comes_up_after_the_recovery_delay_and_goes_down_after_the_failsafe_delay() {
        let mut link = LinkMonitor::default();
        let config = LinkConfig::default();
        let mut history = Vec::new();
        for ms in (0..4000).step_by(10) {
            let signal = (200..1000).contains(&ms);
            let last = (ms >= 200).then(|| at(ms.min(990)));
            if let Some(change) = link.update(&config, at(ms), signal, last, false) {
                history.push((ms, change));
            }
            assert_eq!(link.up(), (700..=2490).contains(&ms), "{ms}");
            assert_eq!(link.good(), (700..1000).contains(&ms), "{ms}");
        }
        assert_eq!(history, [(700, LinkChange::Recovered), (1000, LinkChange::Lost)]);
    }

    #[test]
    fn short_gap_keeps_the_link_up_but_restarts_the_recovery_delay() {
        let mut link = LinkMonitor::default();
        let config = LinkConfig::default();
        for ms in (0..2000).step_by(10) {
            let signal = !(1000..1200).contains(&ms);
            link.update(&config, at(ms), signal, Some(at(ms)), false);
            assert_eq!(link.up(), ms >= 500, "{ms}");
            assert_eq!(link.good(), (500..1000).contains(&ms) || ms >= 1700, "{ms}");
        }
    }

    #[test]
    fn after_the_switch_it_comes_up_at_once() {
        let mut link = LinkMonitor::default();
        assert_eq!(
            link.update(&LinkConfig::default(), at(0), true, Some(at(0)), true),
            Some(LinkChange::Recovered)
        );
        assert!(link.up());
    }

    #[test]
    fn delays_are_at_least_100_ms() {
        let config = LinkConfig { delay_s: 0.0, recovery_delay_s: 0.0 };
        let mut link = LinkMonitor::default();
        link.update(&config, at(0), true, Some(at(0)), false);
        assert!(!link.up());
        link.update(&config, at(100), true, Some(at(100)), false);
        assert!(link.up());
        link.update(&config, at(200), false, Some(at(100)), false);
        assert!(link.up());
        link.update(&config, at(201), false, Some(at(100)), false);
        assert!(!link.up());
    }
}
