//! When to send a servo packet unasked, and how many replies are withheld for it later.
//!
//! The simulator reads one servo packet a step and waits when there is none. So a lost packet must be replaced, and a
//! packet too many stays in its socket for ever and makes every command one step older. As many replies are
//! withheld afterwards as packets were sent unasked during a silence, less the one that ended it.

/// From one kick to the next until the first packet, and while the simulator refuses them, µs.
const WAITING_US: u64 = 500_000;
/// Silence before the first kick, µs.
const FIRST_US: u64 = 100_000;
/// From one kick to the next, µs: twice more quickly, since a kick can be lost too; after a second of silence; then
/// every ten.
const NEXT_US: [u64; 3] = [25_000, 20_000, 855_000];
/// Between further kicks, µs.
const LATER_US: u64 = 10_000_000;
/// A packet this soon after a kick was caused by it, µs.
const CAUSED_US: u64 = 50_000;

/// The kicks of one link.
#[derive(Debug, Clone)]
pub(super) struct Kicks {
    heard_at_us: Option<u64>,
    /// Newest servo packet that was sent unasked, the one at the start included.
    kicked_at_us: u64,
    /// Kicks of this silence that arrived.
    arrived: u32,
    /// Whether an answer of ours lies in the simulator's socket, from before this silence.
    has_answer: bool,
    unreachable: bool,
    surplus: u32,
}

impl Kicks {
    /// A link whose first servo packet is sent at `now_us`.
    pub(super) fn new(now_us: u64) -> Self {
        Self {
            heard_at_us: None,
            kicked_at_us: now_us,
            arrived: 0,
            has_answer: true,
            unreachable: false,
            surplus: 0,
        }
    }

    pub(super) fn heard_at_us(&self) -> Option<u64> {
        self.heard_at_us
    }

    /// When the next kick is due.
    pub(super) fn due_us(&self) -> u64 {
        match (self.heard_at_us, self.arrived) {
            (Some(heard), 0) if !self.unreachable => heard + FIRST_US,
            (Some(_), kicks) if !self.unreachable => {
                self.kicked_at_us + NEXT_US.get(kicks as usize - 1).copied().unwrap_or(LATER_US)
            }
            _ => self.kicked_at_us + WAITING_US,
        }
    }

    /// Whether to kick now.
    pub(super) fn poll(&mut self, now_us: u64) -> bool {
        if now_us < self.due_us() {
            return false;
        }
        self.kicked_at_us = now_us;
        self.arrived += 1;
        self.surplus = 0;
        // Until the contrary is reported.
        self.unreachable = false;
        true
    }

    /// The newest servo packet did not arrive.
    pub(super) fn refused(&mut self) {
        self.unreachable = true;
        if self.arrived > 0 {
            self.arrived -= 1;
        } else {
            self.has_answer = false;
        }
    }

    /// A packet came.
    pub(super) fn heard(&mut self, now_us: u64) {
        if self.arrived > 0 {
            let caused = now_us.saturating_sub(self.kicked_at_us) <= CAUSED_US;
            let awaited = caused || !self.has_answer;
            self.surplus = self.arrived - u32::from(awaited);
        }
        self.heard_at_us = Some(now_us);
        self.arrived = 0;
        self.has_answer = true;
        self.unreachable = false;
    }

    /// Whether this answer is one too many.
    pub(super) fn withhold(&mut self) -> bool {
        let withheld = self.surplus > 0;
        self.surplus = self.surplus.saturating_sub(1);
        withheld
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Times (ms) of the kicks until `end_ms`.
    fn kicks_until(kicks: &mut Kicks, start_ms: u64, end_ms: u64) -> Vec<u64> {
        (start_ms..end_ms).filter(|ms| kicks.poll(ms * 1000)).collect()
    }

    #[test]
    fn kicks_twice_a_second_until_the_first_packet() {
        let mut kicks = Kicks::new(0);
        assert_eq!(kicks_until(&mut kicks, 0, 2100), [500, 1000, 1500, 2000]);
    }

    #[test]
    fn a_silence_is_broken_after_a_tenth_a_second_and_every_ten() {
        let mut kicks = Kicks::new(0);
        kicks.heard(1_000_000);
        assert_eq!(kicks_until(&mut kicks, 1000, 23_000), [1100, 1125, 1145, 2000, 12_000, 22_000]);
    }

    #[test]
    fn kicks_twice_a_second_again_when_nobody_listens() {
        let mut kicks = Kicks::new(0);
        kicks.heard(0);
        assert!(kicks.poll(100_000));
        kicks.refused();
        assert_eq!(kicks.due_us(), 600_000);
        assert!(kicks.poll(600_000));
        kicks.heard(601_000);
        assert!(!kicks.withhold(), "the refused kick does not count, the other was awaited");
    }

    #[test]
    fn a_pause_costs_all_kicks_unless_the_last_ended_it() {
        let paused_until = |resumed_us: u64| {
            let mut kicks = Kicks::new(0);
            kicks.heard(0);
            kicks_until(&mut kicks, 0, 2000);
            kicks.heard(resumed_us);
            (0..9).take_while(|_| kicks.withhold()).count()
        };
        assert_eq!(paused_until(1_999_000), 4);
        assert_eq!(paused_until(1_040_000), 3);
    }

    #[test]
    fn a_new_silence_forgets_the_surplus() {
        let mut kicks = Kicks::new(0);
        kicks.heard(0);
        kicks_until(&mut kicks, 0, 2000);
        kicks.heard(2_000_000);
        assert!(kicks.withhold());
        assert!(kicks.poll(2_100_000));
        kicks.heard(2_110_000);
        assert!(!kicks.withhold());
    }
}
