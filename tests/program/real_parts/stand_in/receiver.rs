//! The public executable's rules for state packets: which it takes, which it answers, and their effect on its clock.

use super::packet::{Packet, Sensors};

/// The silence after which the next packet only sets the time base, µs.
const RESYNC_US: u64 = 500_000;
/// The gap between two stamps from which on they do not set the clock's rate, s.
const STAMP_GAP_S: f64 = 0.02;
/// The boot time, µs. Before it, the executable listens but is not ready for packets.
pub(crate) const BOOT_US: u64 = 500_000;

/// The handling of a packet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Taken {
    /// Too short.
    Refused,
    /// Sets the time base: one motor packet goes out at once, and the data are ignored.
    Resync,
    /// Has an older stamp than the last: not answered.
    Old,
    /// Provides the sensor data from now on; the next turn of the mixer answers it.
    State,
}

/// The receiver. Times are wall time since the start of the executable, µs.
#[derive(Debug)]
pub(crate) struct Receiver {
    last: (f64, u64),
    rate: f64,
    clock: (f64, u64),
    centre: Option<(f64, f64)>,
    gate: bool,
    sensors: Option<Sensors>,
    gps_at: Option<u64>,
    pub(crate) seen: Seen,
}

/// The statistics of the received packets.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Seen {
    /// State packets of sufficient size.
    pub(crate) packets: u64,
    /// State packets before the boot, which the real executable often does not survive.
    pub(crate) before_boot: u64,
    /// Packets that were answered: by the time base's packet or by the mixer.
    pub(crate) answered: u64,
    /// Stamps that differ from the one before.
    pub(crate) other_stamps: u64,
    /// The largest leap of the clock between two packets, against the wall clock, µs.
    pub(crate) worst_leap_us: f64,
    /// Positions other than the first one, received before the first answer was sent.
    pub(crate) moved_before_answer: u64,
}

impl Receiver {
    pub(crate) fn new() -> Self {
        Self {
            last: (0.0, 0),
            rate: 1.0,
            clock: (0.0, 0),
            centre: None,
            gate: false,
            sensors: None,
            gps_at: None,
            seen: Seen::default(),
        }
    }

    /// Takes a datagram that arrived at `wall_us`.
    pub(crate) fn receive(&mut self, datagram: &[u8], wall_us: u64) -> Taken {
        let Some(packet) = Packet::read(datagram) else { return Taken::Refused };
        self.note(&packet, wall_us);
        let (stamp, at) = self.last;
        if wall_us.saturating_sub(at) > RESYNC_US {
            self.last = (packet.stamp_s(), wall_us);
            self.seen.answered += 1;
            return Taken::Resync;
        }
        if packet.stamp_s() < stamp {
            return Taken::Old;
        }
        let centre = *self.centre.get_or_insert(packet.position());
        let sensors = packet.sensors(centre);
        if sensors.gps.is_some() {
            self.gps_at = Some(wall_us);
        }
        self.sensors = Some(sensors);
        let step_s = packet.stamp_s() - stamp;
        self.clock_us(wall_us);
        if step_s > 0.0 && step_s < STAMP_GAP_S {
            self.rate = step_s * 1e6 / (wall_us - at).max(1) as f64;
        }
        self.last = (packet.stamp_s(), wall_us);
        self.gate = true;
        Taken::State
    }

    fn note(&mut self, packet: &Packet, wall_us: u64) {
        self.seen.packets += 1;
        if wall_us < BOOT_US {
            self.seen.before_boot += 1;
        }
        if self.seen.packets > 1 && packet.stamp_s().to_bits() != self.last.0.to_bits() {
            self.seen.other_stamps += 1;
        }
        let before = self.clock.0 - self.clock.1 as f64;
        let after = self.clock_us(wall_us) - wall_us as f64;
        self.seen.worst_leap_us = self.seen.worst_leap_us.max((after - before).abs());
        let moved = self.centre.is_some_and(|centre| centre != packet.position());
        if moved && self.seen.answered == 0 {
            self.seen.moved_before_answer += 1;
        }
    }

    /// Runs the mixer's turn, a thousand times a second. Returns `true` if it sends, which is one packet to each port.
    pub(crate) fn mixer_sends(&mut self) -> bool {
        let sends = std::mem::take(&mut self.gate);
        if sends {
            self.seen.answered += 1;
        }
        sends
    }

    /// Returns the executable's own clock, µs.
    pub(crate) fn clock_us(&mut self, wall_us: u64) -> f64 {
        let (clock, at) = self.clock;
        self.clock = (clock + wall_us.saturating_sub(at) as f64 * self.rate, wall_us.max(at));
        self.clock.0
    }

    pub(crate) fn sensors(&self) -> Option<Sensors> {
        self.sensors
    }

    /// Returns `true` while it has a fix. The fix is lost 2.5 s after the last solution.
    pub(crate) fn has_fix(&self, wall_us: u64) -> bool {
        self.gps_at.is_some_and(|at| wall_us.saturating_sub(at) <= 2_500_000)
    }
}
