//! Decides when to send an unsolicited servo packet (a kick) and which replies to withhold for it later.
//!
//! The simulator reads one servo packet per step and waits when there is none. A lost packet must therefore
//! be replaced, while a surplus packet stays in its socket for ever and makes every command one step older.
//! The end of a silence does not show whether a packet was lost or the simulator paused. So every kick counts
//! as a surplus packet, and one reply is withheld for each. A simulator that continues without the reply has
//! read a surplus packet. A simulator that starves has nothing left to read; it gets the reply late, and
//! nothing more is withheld.
//!
//! A simulator that the host stops for a moment can look like one that starves. Two rules keep that from
//! leaving packets in its socket: the silence that counts as starving grows with the pauses of the simulator,
//! and a surplus that was given up is checked several times more.
//!
//! If a link has lost several packets and no kick was surplus, a silence counts as another loss, because a
//! check costs a pause.

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
/// interval is added. A simulator with packets left to read does not pause for that long …
const STARVED_US: u64 = 30_000;
/// … unless its steps are irregular: this many times the usual deviation from the interval is added, too.
const DEVIATIONS: f64 = 4.0;
/// A starved simulator answers the late reply within this time, µs …
const STARVING_ANSWERS_US: u64 = 3_000;
/// … or, if its steps take long, this many times in a row within [`CAUSED_US`].
const STARVED_OFTEN: u32 = 3;
/// The number of packets after which a surplus that was given up is checked again. Each check costs a pause,
/// so the number doubles with every check …
const CHECKED_AFTER: u32 = 50;
/// … of which there are this many.
const CHECKS: u32 = 6;
/// The number of losses in a row that the simulator proved, after which the next silence counts as another
/// loss. Its packet is only checked with the others.
const PROVEN_LOSSES: u32 = 3;
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
    /// `true` if some of them are kicks.
    has_kicks: bool,
    /// Further surplus packets that are unlikely to exist. They are checked later.
    doubtful: u32,
    /// The number of checks of the doubtful packets.
    checks: u32,
    /// The number of losses that the simulator proved since it last read a surplus packet.
    proven_losses: u32,
    /// The number of packets until the next check.
    next_check: u32,
    /// The number of withheld replies in a row for which the simulator seemed to starve.
    starved: u32,
    /// `true` if the reply to the newest packet was withheld because of the surplus.
    withheld: bool,
    /// The usual interval of the packets, µs.
    interval_us: f64,
    /// The usual deviation from it, µs.
    deviation_us: f64,
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
            has_kicks: false,
            doubtful: 0,
            checks: 0,
            proven_losses: 0,
            next_check: 0,
            starved: 0,
            withheld: false,
            interval_us: INTERVAL_US,
            deviation_us: 0.0,
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
            let usual_us = 2.0 * self.interval_us + DEVIATIONS * self.deviation_us;
            STARVED_US + usual_us.min(SIMULATOR_WAITS_US as f64) as u64
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

    /// Records that the last servo packet was refused, so nothing is queued.
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
            if withheld {
                self.proven_losses = 0;
            }
        } else if self.starved >= STARVED_OFTEN || self.starved > 0 && since_kick_us <= STARVING_ANSWERS_US {
            self.give_up(if self.has_kicks { left + kicks } else { 0 });
        } else if !self.has_answer {
            self.surplus = kicks - 1;
        } else if since_kick_us <= CAUSED_US && self.proven_losses >= PROVEN_LOSSES {
            self.surplus = left + kicks - 1;
            self.check_later(self.doubtful + 1);
        } else {
            self.surplus = left + kicks + std::mem::take(&mut self.doubtful);
            self.has_kicks = true;
            self.checks = 0;
        }
        self.has_kicks &= self.surplus > 0;
        self.next_check = self.next_check.saturating_sub(1);
        self.measure_intervals(now_us, kicks);
        self.heard_at_us = Some(now_us);
        self.has_answer = true;
        self.unreachable = false;
    }

    /// Gives up the surplus, because the simulator starved. At most `doubtful` packets may exist nevertheless.
    fn give_up(&mut self, doubtful: u32) {
        self.surplus = 0;
        self.starved = 0;
        self.proven_losses += 1;
        self.doubtful = 0;
        if self.checks < CHECKS {
            self.check_later(doubtful);
        }
    }

    /// Has this number of doubtful packets checked later.
    fn check_later(&mut self, doubtful: u32) {
        if self.doubtful == 0 {
            self.next_check = CHECKED_AFTER << self.checks;
        }
        self.doubtful = doubtful;
    }

    /// Returns the number of packets for which the simulator stopped waiting while the firmware stood still
    /// and did not kick.
    fn misses(&self, now_us: u64) -> u32 {
        let silence = self.heard_at_us.map_or(0, |heard| now_us.saturating_sub(heard));
        (silence / SIMULATOR_WAITS_US).min(SIMULATOR_MISSES) as u32
    }

    /// Tracks the usual interval of the packets, which a single long one changes little, and the deviation from
    /// it, as a TCP sender does for its time-outs. A silence that ended with a kick may be a loss and is no
    /// deviation.
    fn measure_intervals(&mut self, now_us: u64, kicks: u32) {
        let Some(heard) = self.heard_at_us else { return };
        let interval_us = now_us.saturating_sub(heard) as f64;
        if kicks == 0 {
            // A longer one is a pause of the firmware.
            let deviation_us = (interval_us.min(FIRST_US as f64) - self.interval_us).abs();
            self.deviation_us += (deviation_us - self.deviation_us) / 16.0;
        }
        let longest_us = self.interval_us * 1.25 + 100.0;
        self.interval_us += (interval_us.min(longest_us) - self.interval_us) / 8.0;
    }

    /// Returns `true` if the reply to the newest packet is withheld as surplus.
    pub(super) fn withhold(&mut self) -> bool {
        if self.surplus == 0 && self.doubtful > 0 && self.next_check == 0 {
            self.surplus = std::mem::take(&mut self.doubtful);
            self.has_kicks = true;
            self.checks = CHECKS.min(self.checks + 1);
        }
        self.withheld = self.surplus > 0;
        self.withheld
    }
}

#[cfg(test)]
mod busy_host;
#[cfg(test)]
mod tests;
