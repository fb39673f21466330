//! When to send a servo packet unasked, and which replies are withheld for it later.
//!
//! The simulator reads one servo packet a step and waits when there is none. So a lost packet must be replaced, and a
//! packet too many stays in its socket for ever and makes every command one step older. Whether a silence came from a
//! lost packet or from a simulator that stood still cannot be seen when it ends. So every packet that was sent unasked
//! counts as one too many, and for each of them one reply is withheld. A simulator that goes on without the reply has
//! read one of them; one that starves has nothing left to read, gets the reply late, and nothing is withheld any more.
//!
//! A link that was just shown to lose packets is taken to have lost one again: there the probe, which costs a pause, waits.
//! A simulator that is only slow can be mistaken for one that starves, so what was given up is looked for once more.

/// From one kick to the next until the first packet, and while the simulator refuses them, µs.
const WAITING_US: u64 = 500_000;
/// Silence before the first kick, µs.
const FIRST_US: u64 = 100_000;
/// From one kick to the next, µs: twice more quickly, since a kick can be lost too; after a second of silence; then
/// every ten.
const NEXT_US: [u64; 3] = [25_000, 20_000, 855_000];
/// Between further kicks, µs.
const LATER_US: u64 = 10_000_000;
/// A packet this soon after a kick may have been caused by it, µs.
const CAUSED_US: u64 = 50_000;
/// Silence after a withheld reply that a simulator with packets left to read does not make: this and twice the usual
/// interval, µs.
const STARVED_US: u64 = 30_000;
/// A simulator that starved answers the late reply within this time, µs …
const STARVING_ANSWERS_US: u64 = 3_000;
/// … or, when it takes long for a step, so many in a row within [`CAUSED_US`].
const STARVED_OFTEN: u32 = 3;
/// How long a link that lost a packet is taken to lose more, µs.
const LOSSY_FOR_US: u64 = 5_000_000;
/// A simulator goes on by itself after waiting for so long, µs …
const SIMULATOR_WAITS_US: u64 = 1_000_000;
/// … so many times.
const SIMULATOR_MISSES: u64 = 10;
/// Usual interval of packets as long as nothing is known, µs.
const INTERVAL_US: f64 = 20_000.0;

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
    /// Packets that may lie in the simulator's socket beyond the one it is to read next.
    surplus: u32,
    /// More of them that are unlikely to be there, to be looked for later.
    doubtful: u32,
    /// The surplus is what was doubtful before.
    is_second_look: bool,
    /// Withheld replies in a row for which the simulator seemed to starve.
    starved: u32,
    /// The newest packet was not replied to because of the surplus.
    withheld: bool,
    /// When it was shown last that a packet was lost.
    lost_at_us: Option<u64>,
    /// Usual interval of the packets, µs.
    interval_us: f64,
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
            doubtful: 0,
            is_second_look: false,
            starved: 0,
            withheld: false,
            lost_at_us: None,
            interval_us: INTERVAL_US,
        }
    }

    pub(super) fn heard_at_us(&self) -> Option<u64> {
        self.heard_at_us
    }

    /// When the next kick is due.
    pub(super) fn due_us(&self) -> u64 {
        match (self.heard_at_us, self.arrived) {
            (Some(heard), 0) if !self.unreachable => heard + self.patience_us(),
            (Some(_), kicks) if !self.unreachable => {
                self.kicked_at_us + NEXT_US.get(kicks as usize - 1).copied().unwrap_or(LATER_US)
            }
            _ => self.kicked_at_us + WAITING_US,
        }
    }

    /// Silence before the first kick: short after a withheld reply, for which the simulator may wait.
    fn patience_us(&self) -> u64 {
        if self.withheld {
            STARVED_US + (2.0 * self.interval_us).min(SIMULATOR_WAITS_US as f64) as u64
        } else {
            FIRST_US
        }
    }

    /// Whether to kick now.
    pub(super) fn poll(&mut self, now_us: u64) -> bool {
        if now_us < self.due_us() {
            return false;
        }
        self.kicked_at_us = now_us;
        self.arrived += 1;
        // Until the contrary is reported.
        self.unreachable = false;
        true
    }

    /// The newest servo packet did not arrive: there is no socket, nor anything in it.
    pub(super) fn refused(&mut self) {
        self.unreachable = true;
        self.arrived = 0;
        self.has_answer = false;
        self.withheld = false;
        (self.surplus, self.doubtful) = (0, 0);
    }

    /// A packet came, which was not there yet when the newest kick was sent.
    pub(super) fn heard(&mut self, now_us: u64) {
        let withheld = std::mem::take(&mut self.withheld);
        let kicks = std::mem::take(&mut self.arrived);
        let since_kick_us = now_us.saturating_sub(self.kicked_at_us);
        // The simulator has read one packet: that which was withheld is missing.
        let left = self.surplus.saturating_sub(u32::from(withheld));
        self.starved = if withheld && kicks > 0 && since_kick_us <= CAUSED_US { self.starved + 1 } else { 0 };
        if kicks == 0 {
            self.surplus = left + self.misses(now_us);
        } else if self.starved >= STARVED_OFTEN || self.starved > 0 && since_kick_us <= STARVING_ANSWERS_US {
            self.give_up_surplus(now_us);
        } else if !self.has_answer {
            self.surplus = kicks - 1;
        } else if since_kick_us <= CAUSED_US && self.is_lossy(now_us) {
            self.surplus = left + kicks - 1;
            self.doubtful += 1;
        } else {
            self.surplus = left + kicks;
        }
        self.measure_interval(now_us);
        self.heard_at_us = Some(now_us);
        self.has_answer = true;
        self.unreachable = false;
    }

    /// The simulator starved: there is nothing left over.
    fn give_up_surplus(&mut self, now_us: u64) {
        let given_up = std::mem::take(&mut self.surplus);
        self.doubtful = if self.is_second_look { 0 } else { given_up };
        self.is_second_look = false;
        self.starved = 0;
        self.lost_at_us = Some(now_us);
    }

    /// Packets for which the simulator did not wait any longer, while the firmware stood still and did not kick.
    fn misses(&self, now_us: u64) -> u32 {
        let silence = self.heard_at_us.map_or(0, |heard| now_us.saturating_sub(heard));
        (silence / SIMULATOR_WAITS_US).min(SIMULATOR_MISSES) as u32
    }

    fn is_lossy(&self, now_us: u64) -> bool {
        self.lost_at_us.is_some_and(|lost| now_us.saturating_sub(lost) < LOSSY_FOR_US)
    }

    /// Follows the interval of the packets; a single long one changes little.
    fn measure_interval(&mut self, now_us: u64) {
        if let Some(heard) = self.heard_at_us {
            let interval = now_us.saturating_sub(heard) as f64;
            let longest = self.interval_us * 1.25 + 100.0;
            self.interval_us += (interval.min(longest) - self.interval_us) / 8.0;
        }
    }

    /// Whether the answer to the packet of `now_us` is one too many.
    pub(super) fn withhold(&mut self, now_us: u64) -> bool {
        if self.doubtful > 0 && !self.is_lossy(now_us) {
            self.surplus += std::mem::take(&mut self.doubtful);
            self.is_second_look = true;
        }
        self.is_second_look &= self.surplus > 0;
        self.withheld = self.surplus > 0;
        self.withheld
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Times (ms) of the kicks until `end_ms`.
    fn kicks_until(kicks: &mut Kicks, start_ms: u64, end_ms: u64) -> Vec<u64> {
        (start_ms..end_ms).filter(|ms| kicks.poll(ms * 1000)).collect()
    }

    /// How many replies in a row are withheld, to packets from `ms` on, one a millisecond.
    fn withheld_from(kicks: &mut Kicks, ms: u64) -> usize {
        (ms..)
            .take_while(|ms| {
                kicks.heard(ms * 1000);
                kicks.withhold(ms * 1000)
            })
            .count()
    }

    /// Whether a reply is withheld, to packets that come ten times a second.
    fn any_withheld(kicks: &mut Kicks, start_ms: u64, end_ms: u64) -> bool {
        (start_ms..end_ms).step_by(100).any(|ms| {
            kicks.heard(ms * 1000);
            kicks.withhold(ms * 1000)
        })
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
        assert!(!kicks.withhold(601_000), "the refused kick does not count, the other was awaited");
    }

    #[test]
    fn a_pause_costs_all_kicks_whenever_it_ends() {
        for resumed_ms in [1040, 1500, 1999] {
            let mut kicks = Kicks::new(0);
            kicks.heard(0);
            assert_eq!(kicks_until(&mut kicks, 0, resumed_ms).len(), 4);
            assert_eq!(withheld_from(&mut kicks, resumed_ms), 4, "{resumed_ms} ms");
        }
    }

    #[test]
    fn a_simulator_that_starves_without_the_withheld_reply_gets_it_and_owes_nothing() {
        let mut kicks = Kicks::new(0);
        kicks.heard(0);
        kicks_until(&mut kicks, 0, 2000);
        kicks.heard(2_000_000);
        assert!(kicks.withhold(2_000_000));
        assert!(!kicks.poll(2_030_000));
        assert!(kicks.poll(2_090_000));
        kicks.heard(2_091_000);
        assert!(!kicks.withhold(2_091_000));
    }

    #[test]
    fn a_starving_simulator_with_long_steps_is_believed_the_third_time() {
        let mut kicks = Kicks::new(0);
        kicks.heard(0);
        assert!(kicks.poll(100_000));
        kicks.heard(110_000);
        for ms in [200, 300, 400] {
            assert!(kicks.withhold(ms * 1000 - 90_000), "{ms} ms");
            assert!(kicks.poll(ms * 1000));
            kicks.heard(ms * 1000 + 10_000);
        }
        assert!(!kicks.withhold(410_000));
    }

    #[test]
    fn what_was_given_up_by_mistake_is_found_five_seconds_later() {
        let mut kicks = Kicks::new(0);
        kicks.heard(0);
        assert_eq!(kicks_until(&mut kicks, 0, 500).len(), 3);
        kicks.heard(500_000);
        assert!(kicks.withhold(500_000));
        // It was slow, and by chance went on right after the late reply.
        assert!(kicks.poll(600_000));
        kicks.heard(601_000);
        assert!(!kicks.withhold(601_000));
        assert!(!any_withheld(&mut kicks, 700, 5600));
        assert_eq!(withheld_from(&mut kicks, 5602), 3);
        assert!(!any_withheld(&mut kicks, 5700, 20_000));
    }

    #[test]
    fn a_second_stall_while_a_reply_is_withheld_is_counted_too() {
        let mut kicks = Kicks::new(0);
        kicks.heard(0);
        assert_eq!(kicks_until(&mut kicks, 0, 140).len(), 2);
        kicks.heard(140_000);
        assert!(kicks.withhold(140_000));
        // Two are left over; the simulator stands still again and is sent three more.
        assert_eq!(kicks_until(&mut kicks, 140, 500).len(), 3);
        assert_eq!(withheld_from(&mut kicks, 500), 4, "it has read one of the five");
    }

    #[test]
    fn where_packets_are_lost_the_probe_waits_until_none_was_for_five_seconds() {
        let mut kicks = Kicks::new(0);
        kicks.heard(0);
        assert!(kicks.poll(100_000));
        kicks.heard(100_500);
        assert!(kicks.withhold(100_500), "not known yet whether it was lost");
        assert!(kicks.poll(200_000));
        kicks.heard(200_500);
        assert!(!kicks.withhold(200_500));
        assert!(kicks.poll(300_500));
        kicks.heard(301_000);
        assert!(!kicks.withhold(301_000), "lost again");
        assert!(!any_withheld(&mut kicks, 400, 5200));
        assert!(any_withheld(&mut kicks, 5300, 5400));
    }
}
