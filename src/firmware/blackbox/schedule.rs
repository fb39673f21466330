//! The loops in which main frames are due.

/// The time from one whole main frame to the next, µs.
pub const I_INTERVAL_US: u32 = 32_000;

/// The counter of loops, and the loops with frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Schedule {
    i_interval: u32,
    /// The loops from one main frame to the next, less one. They are a power of two.
    p_mask: u32,
    iteration: u32,
    since_intra: u32,
}

impl Schedule {
    /// Begins at the first loop, for loops of `loop_us` microseconds. Main frames are `1 << rate_power` loops apart.
    pub fn new(loop_us: u32, rate_power: u8) -> Self {
        let i_interval = (I_INTERVAL_US / loop_us.max(1)).max(1);
        Self { i_interval, p_mask: (1 << rate_power.min(30)) - 1, iteration: 0, since_intra: 0 }
    }

    /// Returns the loops from one whole frame to the next.
    pub fn i_interval(&self) -> u32 {
        self.i_interval
    }

    /// Returns the loops from one main frame to the next.
    pub fn p_interval(&self) -> u32 {
        (self.p_mask + 1).min(self.i_interval)
    }

    /// Returns `true` if all main frames are whole ones.
    pub fn is_only_intra(&self) -> bool {
        self.p_interval() == self.i_interval
    }

    /// Returns the number of this loop.
    pub fn iteration(&self) -> u32 {
        self.iteration
    }

    /// Returns `true` if a whole frame is due in this loop.
    pub fn is_intra(&self) -> bool {
        self.since_intra == 0
    }

    /// Returns `true` if a main frame with differences is due in this loop.
    pub fn is_inter(&self) -> bool {
        self.since_intra != 0 && self.since_intra & self.p_mask == 0
    }

    /// Goes on to the next loop.
    pub fn advance(&mut self) {
        self.iteration = self.iteration.wrapping_add(1);
        self.since_intra += 1;
        if self.since_intra >= self.i_interval {
            self.since_intra = 0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the frames of the first loops: `I`, `P`, or a dot.
    fn frames(mut schedule: Schedule, loops: usize) -> String {
        let mut frames = String::new();
        for _ in 0..loops {
            frames.push(match (schedule.is_intra(), schedule.is_inter()) {
                (true, _) => 'I',
                (_, true) => 'P',
                _ => '.',
            });
            schedule.advance();
        }
        frames
    }

    #[test]
    fn whole_frames_are_32_ms_apart_at_every_rate() {
        for (rate_hz, interval) in [(400, 12), (500, 16), (1000, 32), (2000, 64), (4000, 128), (8000, 256)] {
            assert_eq!(Schedule::new(1_000_000 / rate_hz, 0).i_interval(), interval, "{rate_hz} Hz");
        }
    }

    #[test]
    fn the_frames_between_are_a_power_of_two_apart() {
        assert_eq!(frames(Schedule::new(1000, 3), 40), "I.......P.......P.......P.......I.......");
        assert_eq!(frames(Schedule::new(2500, 2), 16), "I...P...P...I...");
        assert_eq!(frames(Schedule::new(2500, 0), 14), "IPPPPPPPPPPPIP");
    }

    #[test]
    fn frames_that_are_too_far_apart_are_all_whole_ones() {
        let schedule = Schedule::new(2500, 4);
        assert!(schedule.is_only_intra());
        assert_eq!((schedule.p_interval(), schedule.i_interval()), (12, 12));
        assert_eq!(frames(schedule, 14), "I...........I.");
        assert!(!Schedule::new(1000, 4).is_only_intra());
    }
}
