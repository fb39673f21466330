//! Derives the firmware's time from the simulator's stamps.

/// The largest step of the stamps that is accepted, s.
const MAX_STEP_S: f64 = 0.5;

/// The number of equal stamps in a row after which the wall clock is used.
const STANDING_STILL: u32 = 20;

/// Follows the stamps of a simulator.
#[derive(Debug, Clone)]
pub(super) struct StampClock {
    tick_us: u64,
    stamp_s: f64,
    taken_at_us: u64,
    equal: u32,
    /// The time that has not filled a tick yet, µs; negative after rounding up.
    carry_us: f64,
}

impl StampClock {
    pub(super) fn new(now_us: u64, tick_us: u64) -> Self {
        Self {
            tick_us: tick_us.max(1),
            stamp_s: f64::NEG_INFINITY,
            taken_at_us: now_us,
            equal: 0,
            carry_us: 0.0,
        }
    }

    /// Returns the wall time since the newest packet, or since the start, µs.
    pub(super) fn gap_us(&self, now_us: u64) -> u64 {
        now_us.saturating_sub(self.taken_at_us)
    }

    /// Returns `true` if a stamp is older than the newest.
    pub(super) fn is_old(&self, stamp_s: f64) -> bool {
        stamp_s < self.stamp_s
    }

    /// Returns `true` while the wall clock is used because the stamps do not advance.
    pub(super) fn is_wall_clock(&self) -> bool {
        self.equal >= STANDING_STILL
    }

    /// Takes a stamp as the time base.
    pub(super) fn take(&mut self, stamp_s: f64, now_us: u64) {
        self.stamp_s = stamp_s;
        self.taken_at_us = now_us;
    }

    /// Takes a stamp. Returns the number of firmware ticks since the previous one.
    pub(super) fn advance(&mut self, stamp_s: f64, now_us: u64) -> u32 {
        let step_s = stamp_s - self.stamp_s;
        self.equal = if step_s == 0.0 { self.equal.saturating_add(1) } else { 0 };
        let elapsed_us = if self.is_wall_clock() {
            self.gap_us(now_us) as f64
        } else if step_s > 0.0 && step_s <= MAX_STEP_S {
            step_s * 1e6
        } else {
            0.0
        };
        self.take(stamp_s, now_us);
        let due_us = self.carry_us + elapsed_us;
        let tick_us = self.tick_us as f64;
        let ticks = (due_us / tick_us).round().max(0.0);
        self.carry_us = due_us - ticks * tick_us;
        ticks as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stamps_of_half_a_tick_lose_nothing() {
        let mut clock = StampClock::new(0, 1000);
        clock.take(0.0, 0);
        let ticks: u32 = (1..=1000).map(|step| clock.advance(f64::from(step) * 0.0004, 0)).sum();
        assert_eq!(ticks, 400);
    }

    #[test]
    fn a_leap_of_the_stamps_is_not_followed() {
        let mut clock = StampClock::new(0, 1000);
        clock.take(0.0, 0);
        assert_eq!(clock.advance(0.5, 0), 500);
        assert_eq!(clock.advance(1.1, 0), 0);
        assert_eq!(clock.advance(1.101, 0), 1);
    }

    #[test]
    fn standing_stamps_hand_over_to_the_wall_clock_and_back() {
        let mut clock = StampClock::new(0, 1000);
        clock.take(5.0, 0);
        let ticks: Vec<u32> = (1..=30).map(|step| clock.advance(5.0, step * 2000)).collect();
        assert_eq!(ticks[..19], [0; 19]);
        assert_eq!(ticks[19..], [2; 11]);
        assert_eq!(clock.advance(5.001, 70_000), 1);
        assert!(!clock.is_wall_clock());
    }
}
