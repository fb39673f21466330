//! The packet exchange with an external simulator: classifies each state datagram and decides when to reply
//! and when to send unsolicited packets. The caller moves the bytes, owns the firmware and supplies the time.
//!
//! ```text
//!            datagram ─▶ receive() ─┬─ refused, old, double  dropped, no answer
//!                                   ├─ resync (> 0.5 s gap)  time base taken, data unused, servo packet only
//!                                   └─ state                 sensors + ticks to run, then servo and raw packet
//!   silence, refused ─▶ poll() ───── repeat the last servo packet ("kick"), since a simulator that lost one packet
//!                                    waits for it; surplus packets are compensated by replies withheld later
//! ```
//!
//! Times are microseconds of a steady clock. The firmware's own time advances with the simulator's stamps.
//! The simulator may therefore run at any speed, and its pause pauses the flight.

mod clock;
mod conventions;
mod kicks;
mod virtual_sensors;

use super::fdm::{Packet, PacketError};
use crate::link::conventions::{Dialect, Mirror};
use crate::signals::{Pose, SensorFrame};
use crate::telemetry::LinkState;
use clock::StampClock;
use conventions::{GravityTest, MirrorTest};
use kicks::Kicks;
use virtual_sensors::VirtualSensors;

/// The pause after which the next packet only sets the time base, µs.
const RESYNC_AFTER_US: u64 = 500_000;

/// The silence after which the link counts as lost, µs.
const SILENT_AFTER_US: u64 = 1_000_000;

/// The settings for the packets of the simulator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FdmLinkConfig {
    /// The dialect of the simulator; `None` = detected from its packets.
    pub dialect: Option<Dialect>,
    /// The handling of mirrored positions.
    pub mirror: Mirror,
    /// The length of a firmware tick, µs.
    pub tick_us: u64,
}

impl Default for FdmLinkConfig {
    fn default() -> Self {
        Self { dialect: None, mirror: Mirror::Auto, tick_us: 1000 }
    }
}

/// The packets to send back.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Reply {
    Nothing,
    /// The last servo packet again, no raw packet.
    Servo,
    /// The new servo packet and the new raw packet.
    Both,
}

/// The classification of a datagram.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PacketKind {
    Refused(PacketError),
    /// A packet that is older than the newest one.
    Old,
    /// The first packet after a pause. It only sets the time base.
    Resync {
        /// `true` if its stamp is earlier than before: the simulator was restarted, and the firmware disarms.
        restarted: bool,
    },
    /// A packet identical to the previous one, including the stamp.
    Duplicate,
    /// The craft's state.
    State,
}

/// A message to the user, sent once.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display)]
pub enum FdmNotice {
    /// The packets show that the acceleration contains gravity, unlike the dialect's default.
    #[strum(
        to_string = "the simulator's acceleration contains gravity, unlike that of the public plugin: adapted"
    )]
    GravityIncluded,
    #[strum(to_string = "the simulator's acceleration lacks gravity, unlike that of this dialect: adapted")]
    GravityMissing,
    /// The acceleration at rest is implausible.
    #[strum(
        to_string = "the simulator's acceleration at rest is neither 0 nor 1 g: the attitude may be wrong, try another --fdm-dialect"
    )]
    GravityUnclear,
    /// Positions move against the velocity.
    #[strum(
        to_string = "the simulator's positions are not mirrored: used unchanged from now on (--fdm-mirror off does so \
                     from the start)"
    )]
    NotMirrored,
    /// The stamps do not advance.
    #[strum(to_string = "the simulator's clock does not advance: the firmware follows the wall clock")]
    WallClock,
    /// The simulator was restarted.
    #[strum(to_string = "the simulator was restarted: disarmed")]
    Restarted,
}

/// The action for one datagram.
#[derive(Debug, Clone, PartialEq)]
pub struct Received {
    pub kind: PacketKind,
    /// The sensors to run the firmware on, for [`PacketKind::State`]. The caller sets their time.
    pub sensors: Option<Box<SensorFrame>>,
    /// The pose of the craft, for [`PacketKind::State`], with mirroring undone.
    pub pose: Option<Pose>,
    /// The number of ticks by which the firmware advances before the reply.
    pub ticks: u32,
    /// The packets to send after the ticks.
    pub reply: Reply,
    /// The messages to the user.
    pub notices: arrayvec::ArrayVec<FdmNotice, 4>,
}

impl Received {
    fn only(kind: PacketKind) -> Self {
        Self {
            kind,
            sensors: None,
            pose: None,
            ticks: 0,
            reply: Reply::Nothing,
            notices: arrayvec::ArrayVec::new(),
        }
    }
}

/// Counters of the datagrams.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counters {
    pub received: u64,
    pub wrong_size: u64,
    /// Long enough but implausible.
    pub senseless: u64,
    /// Older than the newest.
    pub old: u64,
    /// Identical to the previous one.
    pub duplicates: u64,
    /// Used as a time base only.
    pub resyncs: u64,
    /// Unsolicited servo packets.
    pub kicks: u64,
}

/// The packet exchange with one simulator.
#[derive(Debug, Clone)]
pub struct FdmLink {
    config: FdmLinkConfig,
    clock: StampClock,
    kicks: Kicks,
    dialect: Option<Dialect>,
    gravity: GravityTest,
    mirror: MirrorTest,
    sensors: VirtualSensors,
    counters: Counters,
    /// The last state packet.
    newest: Option<Packet>,
}

impl FdmLink {
    /// Creates a link that starts at `now_us`. The caller sends one servo and one raw packet at once, and
    /// calls [`Self::refused`] if nobody receives them.
    pub fn new(config: FdmLinkConfig, now_us: u64) -> Self {
        Self {
            config,
            clock: StampClock::new(now_us, config.tick_us),
            kicks: Kicks::new(now_us),
            dialect: config.dialect,
            gravity: GravityTest::default(),
            mirror: MirrorTest::default(),
            sensors: VirtualSensors::default(),
            counters: Counters::default(),
            newest: None,
        }
    }

    pub fn receive(&mut self, datagram: &[u8], now_us: u64) -> Received {
        self.counters.received += 1;
        let packet = match Packet::parse(datagram) {
            Ok(packet) => packet,
            Err(refusal) => {
                match refusal {
                    PacketError::TooShort => self.counters.wrong_size += 1,
                    _ => self.counters.senseless += 1,
                }
                return Received::only(PacketKind::Refused(refusal));
            }
        };
        self.kicks.heard(now_us);
        if self.clock.gap_us(now_us) > RESYNC_AFTER_US {
            // Its data is not used. A repetition of it is therefore no duplicate.
            self.newest = None;
            return self.resync(packet.stamp_s(), now_us);
        }
        if self.clock.is_old(packet.stamp_s()) {
            self.counters.old += 1;
            return Received::only(PacketKind::Old);
        }
        self.state_packet(&packet, now_us)
    }

    fn resync(&mut self, stamp_s: f64, now_us: u64) -> Received {
        self.counters.resyncs += 1;
        let restarted = self.clock.is_old(stamp_s);
        self.clock.take(stamp_s, now_us);
        let mut received = Received::only(PacketKind::Resync { restarted });
        // A resync always gets a reply, as in the reference. Surplus replies are withheld later.
        received.reply = Reply::Servo;
        if restarted {
            self.dialect = self.config.dialect;
            self.gravity = GravityTest::default();
            self.mirror = MirrorTest::default();
            received.notices.push(FdmNotice::Restarted);
        }
        received
    }

    fn state_packet(&mut self, packet: &Packet, now_us: u64) -> Received {
        let mut received = Received::only(PacketKind::State);
        let was_wall_clock = self.clock.is_wall_clock();
        let ticks = self.clock.advance(packet.stamp_s(), now_us);
        // A simulator that reads one reply per step would keep the second one for ever. A simulator whose
        // clock does not advance repeats itself while nothing moves, and waits for the replies.
        if self.newest.replace(*packet).is_some_and(|newest| newest.is_same(packet))
            && !self.clock.is_wall_clock()
        {
            self.counters.duplicates += 1;
            return Received::only(PacketKind::Duplicate);
        }
        if self.clock.is_wall_clock() && !was_wall_clock {
            received.notices.push(FdmNotice::WallClock);
        }
        let elapsed_us = u64::from(ticks) * self.config.tick_us;

        let dialect = *self.dialect.get_or_insert_with(|| Dialect::from_size(packet.size));
        if self.config.dialect.is_none() {
            received.notices.extend(self.gravity.watch(packet, dialect, elapsed_us));
        }
        let mut state = dialect.decode(packet, self.gravity.gravity(dialect));
        let mirrors = match self.config.mirror {
            Mirror::Auto => dialect.mirrors() && !self.mirror.is_refuted(),
            Mirror::On => true,
            Mirror::Off => false,
        };
        let position = self.mirror.place(&state, mirrors);
        if self.config.mirror == Mirror::Auto && mirrors {
            received.notices.extend(self.mirror.watch(position, state.vel_enu, elapsed_us));
        }
        if let Some((lat_deg, lon_deg)) = position {
            (state.lat_deg, state.lon_deg) = (lat_deg, lon_deg);
        }

        received.pose = Some(Pose {
            place_deg: position,
            alt_m: state.alt_m,
            vel_enu: state.vel_enu,
            attitude: state.attitude,
        });
        received.sensors = Some(Box::new(self.sensors.frame(&state, position.is_some(), elapsed_us)));
        received.ticks = ticks;
        received.reply = if self.kicks.withhold() { Reply::Nothing } else { Reply::Both };
        received
    }

    /// Returns the time at which [`Self::poll`] must run next, if no packet arrives before.
    pub fn due_us(&self) -> u64 {
        self.kicks.due_us()
    }

    /// Returns `true` if the last servo packet must be sent again now.
    pub fn poll(&mut self, now_us: u64) -> bool {
        let kicks = self.kicks.poll(now_us);
        self.counters.kicks += u64::from(kicks);
        kicks
    }

    /// Reports that the newest servo packet was refused because nobody listens.
    pub fn refused(&mut self) {
        self.kicks.refused();
    }

    /// Returns the state of the link to the simulator at `now_us`.
    pub fn state(&self, now_us: u64) -> LinkState {
        match self.kicks.heard_at_us() {
            None => LinkState::Waiting,
            Some(heard) if now_us.saturating_sub(heard) > SILENT_AFTER_US => LinkState::Silent,
            Some(_) => LinkState::Flowing,
        }
    }

    /// Returns the dialect of the simulator, once known.
    pub fn dialect(&self) -> Option<Dialect> {
        self.dialect
    }

    /// Returns the counters of the datagrams.
    pub fn counters(&self) -> Counters {
        self.counters
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::link::proto::fdm::FIELDS;

    /// Returns the datagram of a craft at rest with this stamp and first body rate.
    fn datagram(stamp_s: f64, field_1: f64) -> Vec<u8> {
        let mut fields = [0.0; FIELDS];
        (fields[0], fields[1], fields[6], fields[10]) = (stamp_s, field_1, -9.8, 1.0);
        Packet { fields, size: 144 }.to_bytes().to_vec()
    }

    /// Returns a link that has received a hundred packets, the newest with stamp 0.099.
    fn flowing() -> FdmLink {
        let mut link = FdmLink::new(FdmLinkConfig::default(), 0);
        for ms in 0..100_u32 {
            link.receive(&datagram(f64::from(ms) * 1e-3, 0.0), u64::from(ms) * 1000);
        }
        link
    }

    #[test]
    fn a_doubled_packet_is_answered_once() {
        let mut link = flowing();
        let first = link.receive(&datagram(0.1, 0.0), 100_000);
        assert_eq!((first.kind, first.reply), (PacketKind::State, Reply::Both));
        let second = link.receive(&datagram(0.1, 0.0), 100_100);
        assert_eq!((second.kind, second.reply, second.ticks), (PacketKind::Duplicate, Reply::Nothing, 0));
        let other = link.receive(&datagram(0.1, 0.01), 100_200);
        assert_eq!(
            (other.kind, other.reply),
            (PacketKind::State, Reply::Both),
            "the same stamp, other bytes"
        );
        assert_eq!(link.counters().duplicates, 1);
    }

    #[test]
    fn duplicates_count_towards_the_wall_clock_and_are_answered_by_it() {
        let mut link = flowing();
        let answers: Vec<Reply> =
            (1..=30).map(|ms| link.receive(&datagram(0.099, 0.0), 99_000 + ms * 1000).reply).collect();
        assert_eq!(answers[..19], [Reply::Nothing; 19]);
        assert_eq!(answers[19..], [Reply::Both; 11]);
    }
}
