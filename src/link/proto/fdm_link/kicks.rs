//! Decides when to send an unsolicited servo packet (a kick) and which replies to withhold for it later.
//!
//! The simulator reads one servo packet per step and waits when there is none. A lost packet must therefore
//! be replaced, while a surplus packet stays in its socket for ever and makes every command one step older.
//! The end of a silence does not show whether a packet was lost or the simulator paused. So every kick counts
//! as a surplus packet, and one reply is withheld for each. A simulator that continues without the reply has
//! read a surplus packet. A simulator that starves has nothing left to read; it gets the reply late, and
//! nothing more is withheld.
//!
//! If a link has just lost packets, a silence counts as another loss. The probe costs a pause, so it waits
//! there. A simulator that is only slow can look like one that starves, so a surplus that was given up is
//! checked once more.

/// The interval of the kicks before the first packet, and while the simulator refuses them, µs.
const WAITING_US: u64 = 500_000;
/// The silence before the first kick, µs.
const FIRST_US: u64 = 100_000;
/// The intervals of the next kicks, µs. Two follow quickly, since a kick can be lost too; the third follows
/// after a second of silence.
const NEXT_US: [u64; 3] = [25_000, 20_000, 855_000];
/// The interval of all further kicks, µs.
const LATER_US: u64 = 10_000_000;
/// The time after a kick within which a packet may be its effect, µs.
const CAUSED_US: u64 = 50_000;
/// The base of the silence after a withheld reply that shows that the simulator starves, µs. Twice the usual
/// interval is added. A simulator with packets left to read does not pause for that long.
const STARVED_US: u64 = 30_000;
/// A starved simulator answers the late reply within this time, µs …
const STARVING_ANSWERS_US: u64 = 3_000;
/// … or, if its steps take long, this many times in a row within [`CAUSED_US`].
const STARVED_OFTEN: u32 = 3;
/// The time for which a link that lost a packet is expected to lose more, µs.
const LOSSY_FOR_US: u64 = 5_000_000;
/// The time after which a waiting simulator continues by itself, µs …
const SIMULATOR_WAITS_US: u64 = 1_000_000;
/// … at most this many times.
const SIMULATOR_MISSES: u64 = 10;
/// The assumed interval of packets as long as nothing is known, µs.
const INTERVAL_US: f64 = 20_000.0;

/// The kicks of one link.
#[derive(Debug, Clone)]
pub(super) struct Kicks {
    heard_at_us: Option<u64>,
    /// The time of the newest kick, or of the packet at the start.
    kicked_at_us: u64,
    /// The kicks of this silence that arrived.
    arrived: u32,
    /// `true` if a reply from before this silence is in the simulator's socket.
    has_answer: bool,
    unreachable: bool,
    /// The packets that may be in the simulator's socket in addition to the one that it reads next.
    surplus: u32,
    /// Further surplus packets that are unlikely to exist. They are checked later.
    doubtful: u32,
    /// `true` if the surplus was doubtful before.
    is_second_look: bool,
    /// The number of withheld replies in a row for which the simulator seemed to starve.
    starved: u32,
    /// `true` if the reply to the newest packet was withheld because of the surplus.
    withheld: bool,
    /// The time of the last proven loss of a packet.
    lost_at_us: Option<u64>,
    /// The usual interval of the packets, µs.
    interval_us: f64,
}

impl Kicks {
    /// Creates the state of a link whose first servo packet is sent at `now_us`.
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

    /// Returns the time of the next kick.
    pub(super) fn due_us(&self) -> u64 {
        match (self.heard_at_us, self.arrived) {
            (Some(heard), 0) if !self.unreachable => heard + self.patience_us(),
            (Some(_), kicks) if !self.unreachable => {
                self.kicked_at_us + NEXT_US.get(kicks as usize - 1).copied().unwrap_or(LATER_US)
            }
            _ => self.kicked_at_us + WAITING_US,
        }
    }

    /// Returns the silence before the first kick. It is short after a withheld reply, for which the simulator
    /// may be waiting.
    fn patience_us(&self) -> u64 {
        if self.withheld {
            STARVED_US + (2.0 * self.interval_us).min(SIMULATOR_WAITS_US as f64) as u64
        } else {
            FIRST_US
        }
    }

    /// Returns `true` if a kick is due now.
    pub(super) fn poll(&mut self, now_us: u64) -> bool {
        if now_us < self.due_us() {
            return false;
        }
        self.kicked_at_us = now_us;
        self.arrived += 1;
        // Assume that it arrives until a refusal is reported.
        self.unreachable = false;
        true
    }

    /// Reports that the newest servo packet did not arrive: there is no socket, so nothing is in it.
    pub(super) fn refused(&mut self) {
        self.unreachable = true;
        self.arrived = 0;
        self.has_answer = false;
        self.withheld = false;
        (self.surplus, self.doubtful) = (0, 0);
    }

    /// Reports a packet that had not yet arrived when the newest kick was sent.
    pub(super) fn heard(&mut self, now_us: u64) {
        let withheld = std::mem::take(&mut self.withheld);
        let kicks = std::mem::take(&mut self.arrived);
        let since_kick_us = now_us.saturating_sub(self.kicked_at_us);
        // The simulator has read one packet, and the withheld reply did not replace it.
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

    /// Gives up the surplus, because the simulator starved.
    fn give_up_surplus(&mut self, now_us: u64) {
        let given_up = std::mem::take(&mut self.surplus);
        self.doubtful = if self.is_second_look { 0 } else { given_up };
        self.is_second_look = false;
        self.starved = 0;
        self.lost_at_us = Some(now_us);
    }

    /// Returns the number of packets for which the simulator stopped waiting while the firmware stood still
    /// and did not kick.
    fn misses(&self, now_us: u64) -> u32 {
        let silence = self.heard_at_us.map_or(0, |heard| now_us.saturating_sub(heard));
        (silence / SIMULATOR_WAITS_US).min(SIMULATOR_MISSES) as u32
    }

    fn is_lossy(&self, now_us: u64) -> bool {
        self.lost_at_us.is_some_and(|lost| now_us.saturating_sub(lost) < LOSSY_FOR_US)
    }

    /// Tracks the interval of the packets. A single long one changes little.
    fn measure_interval(&mut self, now_us: u64) {
        if let Some(heard) = self.heard_at_us {
            let interval = now_us.saturating_sub(heard) as f64;
            let longest = self.interval_us * 1.25 + 100.0;
            self.interval_us += (interval.min(longest) - self.interval_us) / 8.0;
        }
    }

    /// Returns `true` if the reply to the packet at `now_us` is withheld as surplus.
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

    /// Returns the times (ms) of the kicks until `end_ms`.
    fn kicks_until(kicks: &mut Kicks, start_ms: u64, end_ms: u64) -> Vec<u64> {
        (start_ms..end_ms).filter(|ms| kicks.poll(ms * 1000)).collect()
    }

    /// Returns the number of replies withheld in a row, for packets from `ms` on, one per millisecond.
    fn withheld_from(kicks: &mut Kicks, ms: u64) -> usize {
        (ms..)
            .take_while(|ms| {
                kicks.heard(ms * 1000);
                kicks.withhold(ms * 1000)
            })
            .count()
    }

    /// Returns `true` if any reply is withheld, for packets that arrive ten times a second.
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
        // The simulator was slow, and continued right after the late reply by chance.
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
        // Two are left over. The simulator pauses again and gets three more.
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
