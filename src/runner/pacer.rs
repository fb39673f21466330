//! Computes the number of due ticks. This is the only place at which wall time meets simulated time.
//!
//! The pacer reads no clock itself; it gets the wall time since the start of the session. It never stretches
//! or skips a step, so its decisions do not change the trajectory.

use std::time::Duration;

/// The greatest backlog of wall time that is made up for. Any excess is dropped.
const MAX_BACKLOG: Duration = Duration::from_millis(50);
/// The window of the average of the achieved speed.
const WINDOW: Duration = Duration::from_secs(1);
/// The slowest and the fastest speed that is paced. Beyond the upper one the loop runs freely.
pub const SPEED_RANGE: std::ops::RangeInclusive<f64> = 0.05..=1000.0;

/// Relates the vehicle's time to the wall clock.
#[derive(Debug, Clone)]
pub struct Pacer {
    step: Duration,
    speed: f64,
    paused: bool,
    /// The wall time up to which the due ticks were returned.
    handed_out: Duration,
    /// The fraction of a step left from the last call, in steps.
    carry: f64,
    window_start: Duration,
    window_ticks: u64,
    achieved: f64,
    /// The wall time that was dropped and not reported yet.
    lost: Duration,
}

impl Pacer {
    /// Creates a pacer for steps of `step_us` microseconds at `speed` times real time (infinite: as fast as
    /// possible).
    pub fn new(step_us: u64, speed: f64) -> Self {
        Self {
            step: Duration::from_micros(step_us),
            speed: clamp_speed(speed),
            paused: false,
            handed_out: Duration::ZERO,
            carry: 0.0,
            window_start: Duration::ZERO,
            window_ticks: 0,
            achieved: 0.0,
            lost: Duration::ZERO,
        }
    }

    /// Returns the requested multiple of real time; infinite = as fast as possible.
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Changes the speed. Values outside [`SPEED_RANGE`] are clamped, infinity is kept.
    pub fn set_speed(&mut self, speed: f64, now: Duration) {
        self.speed = clamp_speed(speed);
        self.drop_backlog(now);
    }

    /// Returns `true` while time is paused.
    pub fn is_paused(&self) -> bool {
        self.paused
    }

    /// Pauses or resumes time.
    pub fn set_paused(&mut self, paused: bool, now: Duration) {
        self.paused = paused;
        self.drop_backlog(now);
        if paused {
            self.achieved = 0.0;
        }
        self.window_start = now;
        self.window_ticks = 0;
    }

    /// Returns the achieved multiple of real time, averaged over the last second.
    pub fn achieved(&self) -> f64 {
        self.achieved
    }

    /// Returns the ticks due at wall time `now`, at most `most`. The rest stays due, up to 50 ms of wall
    /// time.
    pub fn due(&mut self, now: Duration, most: u64) -> u64 {
        if self.paused {
            self.handed_out = now;
            return 0;
        }
        if self.speed.is_infinite() {
            self.handed_out = now;
            return most;
        }
        let dropped = now.saturating_sub(self.handed_out).saturating_sub(MAX_BACKLOG);
        self.handed_out += dropped;
        let steps_per_second = self.speed / self.step.as_secs_f64();
        let due_steps = self.carry + now.saturating_sub(self.handed_out).as_secs_f64() * steps_per_second;
        let ticks = (due_steps as u64).min(most);
        // Ticks that were not returned stay due, but only up to 50 ms of wall time.
        let left = due_steps - ticks as f64;
        self.carry = left.min(MAX_BACKLOG.as_secs_f64() * steps_per_second);
        self.lost += dropped + Duration::from_secs_f64((left - self.carry) / steps_per_second);
        self.handed_out = now;
        ticks
    }

    /// Returns the wall time, counted like `now`, at which the next step is due; `None` while time is paused
    /// or runs as fast as possible.
    pub fn next_due(&self) -> Option<Duration> {
        if self.paused || self.speed.is_infinite() {
            return None;
        }
        let wait_s = (1.0 - self.carry).max(0.0) * self.step.as_secs_f64() / self.speed;
        Some(self.handed_out + Duration::from_secs_f64(wait_s))
    }

    /// Returns `true` if a due step was not returned yet.
    pub fn is_behind(&self) -> bool {
        self.carry >= 1.0
    }

    /// Returns the wall time that was dropped since the last call.
    pub fn take_lost(&mut self) -> Duration {
        std::mem::take(&mut self.lost)
    }

    /// Records that `ticks` were run by wall time `now`.
    pub fn ran(&mut self, ticks: u64, now: Duration) {
        self.window_ticks += ticks;
        let span = now.saturating_sub(self.window_start);
        if span >= WINDOW {
            self.achieved = self.window_ticks as f64 * self.step.as_secs_f64() / span.as_secs_f64();
            self.window_start = now;
            self.window_ticks = 0;
        }
    }

    fn drop_backlog(&mut self, now: Duration) {
        self.handed_out = now;
        self.carry = 0.0;
    }
}

fn clamp_speed(speed: f64) -> f64 {
    if speed == f64::INFINITY {
        speed
    } else if speed.is_finite() {
        speed.clamp(*SPEED_RANGE.start(), *SPEED_RANGE.end())
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ms(n: u64) -> Duration {
        Duration::from_millis(n)
    }

    #[test]
    fn real_time_is_one_tick_a_millisecond_whatever_the_calls() {
        let mut pacer = Pacer::new(1000, 1.0);
        let ticks: u64 = (1..=1000).map(|n| pacer.due(ms(n * 2), 10_000)).sum();
        assert!((1999..=2000).contains(&ticks), "{ticks}");
    }

    #[test]
    fn backlog_beyond_fifty_milliseconds_is_dropped() {
        let mut pacer = Pacer::new(1000, 10.0);
        assert_eq!(pacer.due(ms(5_000), 100_000), 500);
        assert_eq!(pacer.due(ms(5_002), 100_000), 20);
    }

    #[test]
    fn what_is_dropped_is_known() {
        let mut pacer = Pacer::new(1000, 1.0);
        pacer.due(ms(30), 10_000);
        assert_eq!(pacer.take_lost(), ms(0));
        pacer.due(ms(5_080), 10_000);
        assert_eq!(pacer.take_lost(), ms(5_000));
        // A machine that manages half of the due ticks: 50 ms of them wait, the rest is dropped.
        for step in 1..=100 {
            pacer.due(ms(5_080 + step * 10), 5);
        }
        assert_eq!(pacer.take_lost(), ms(450));
        pacer.set_paused(true, ms(7_000));
        pacer.due(ms(9_000), 10);
        pacer.set_paused(false, ms(9_000));
        pacer.set_speed(2.0, ms(9_010));
        pacer.due(ms(9_020), 100);
        assert_eq!(pacer.take_lost(), ms(0), "a pause is no loss");
        pacer.set_speed(f64::INFINITY, ms(9_020));
        pacer.due(ms(19_020), 10);
        assert_eq!(pacer.take_lost(), ms(0));
    }

    #[test]
    fn when_the_next_step_is_due_is_known() {
        let mut pacer = Pacer::new(1000, 1.0);
        assert_eq!(pacer.due(Duration::from_micros(5_400), 100), 5);
        assert_eq!(pacer.next_due(), Some(ms(6)));
        assert_eq!(pacer.due(ms(6), 100), 1);
        assert_eq!(pacer.next_due(), Some(ms(7)));
        pacer.set_paused(true, ms(7));
        assert_eq!(pacer.next_due(), None);
    }

    #[test]
    fn ticks_not_handed_out_stay_due() {
        let mut pacer = Pacer::new(1000, 1.0);
        assert_eq!(pacer.due(ms(40), 10), 10);
        assert_eq!(pacer.due(ms(40), 100), 30);
    }

    #[test]
    fn pause_and_freewheel() {
        let mut pacer = Pacer::new(1000, f64::INFINITY);
        assert_eq!(pacer.due(ms(1), 777), 777);
        pacer.set_paused(true, ms(1));
        assert_eq!(pacer.due(ms(100), 777), 0);
        pacer.set_paused(false, ms(200));
        pacer.set_speed(1.0, ms(200));
        assert_eq!(pacer.due(ms(210), 777), 10);
    }

    #[test]
    fn achieved_speed_is_measured() {
        let mut pacer = Pacer::new(1000, 4.0);
        pacer.ran(4000, ms(1000));
        assert!((pacer.achieved() - 4.0).abs() < 1e-9);
    }

    #[test]
    fn nonsense_factors_are_limited() {
        let mut pacer = Pacer::new(1000, f64::NAN);
        assert!((pacer.speed() - 1.0).abs() < 1e-9);
        pacer.set_speed(-3.0, ms(0));
        assert!((pacer.speed() - 0.05).abs() < 1e-9);
    }
}
