//! The data exchange with a SITL executable: its input is the state of the craft as its sensors measured it,
//! its output the motor command.
//!
//! The executable's clock is the wall clock times the rate of the stamps, which turns jitter into time. Every
//! packet therefore carries the same stamp, and the clock stays the wall clock. Positions are mirrored about
//! the first one that the executable processes. Until it has answered for a while, the craft is reported at
//! home, exactly, and with a fix. The packet carries one altitude for GPS and barometer; it is the
//! barometer's. It carries no battery.

use super::fdm::{Packet, State, mirrored, pressure_pa};
use super::servo;
use crate::geo::{LatLon, offset_to_degrees};
use crate::link::conventions::{Dialect, MotorOrder, Stamps};
use crate::math;
use crate::signals::{GpsSample, MotorCommand, SensorFrame, SimTime};
use nalgebra::{UnitQuaternion, Vector2, Vector3};

/// The stamp of every packet, s.
const STAMP_S: f64 = 1.0;
/// The time after its first answer for which the executable gets the true home, µs: the first position that
/// it processes is the centre of the mirror.
const AT_HOME_US: u64 = 200_000;
/// The silence after which the motors stop, µs. It counts the time for which packets have gone without an
/// answer: while this program is held up and sends none, there are no answers either.
const SILENCE_US: u64 = 1_000_000;
/// The wall time without an answer after which the craft waits for one, µs. A motor command that stays the
/// same for longer lets it tip over.
const PATIENCE_US: u64 = 10_000;
/// The value of latitude and longitude without a fix, degrees. It is out of range, so that the executable
/// skips the GPS.
const NO_FIX_DEG: f64 = 999.0;

/// The settings of the feed of an executable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeedConfig {
    /// The dialect of its packets.
    pub dialect: Dialect,
    /// The kind of stamps in its packets.
    pub stamps: Stamps,
    /// The order of the motors in its packets.
    pub motor_order: MotorOrder,
    /// The position of the craft at boot: latitude and longitude, degrees, and metres above mean sea level.
    pub home: (f64, f64, f64),
}

/// The state of the answers from the executable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FeedState {
    /// It has not answered yet.
    Waiting,
    Answering,
    /// It has answered, and has been silent for a second.
    Silent,
}

/// The feed of an executable.
#[derive(Debug, Clone)]
pub struct SitlFeed {
    config: FeedConfig,
    frame: SensorFrame,
    alt_amsl_m: f64,
    /// The newest GPS solution and the time of its delivery.
    gps: Option<(GpsSample, SimTime)>,
    /// The position of the packet after which it continues, until the next measurement.
    resumed_gps: Option<GpsSample>,
    /// The time of the first motor packet, µs of wall time.
    first_answer_us: Option<u64>,
    /// The time of the first packet that is still without an answer, µs of wall time.
    unanswered_us: Option<u64>,
    /// The time of the newest packet sent, µs of wall time.
    sent_us: u64,
}

impl SitlFeed {
    /// Creates a feed that has sent nothing yet.
    pub fn new(config: FeedConfig) -> Self {
        let (_, _, alt_amsl_m) = config.home;
        Self {
            config,
            frame: SensorFrame::default(),
            alt_amsl_m,
            gps: None,
            resumed_gps: None,
            first_answer_us: None,
            unanswered_us: None,
            sent_us: 0,
        }
    }

    /// Returns its settings.
    pub fn config(&self) -> FeedConfig {
        self.config
    }

    /// Continues after this packet, for an executable that has answered for a while.
    pub fn resume(&mut self, packet: &[u8]) {
        let FeedConfig { dialect, home: (home_lat_deg, home_lon_deg, _), .. } = self.config;
        let Ok(packet) = Packet::parse(packet) else { return };
        let state = dialect.decode(&packet, dialect.usual_gravity());
        let place = |centre_deg, value_deg| {
            if dialect.mirrors() { mirrored(centre_deg, value_deg) } else { value_deg }
        };
        let sample = GpsSample {
            fix: state.lat_deg != NO_FIX_DEG,
            position: LatLon::from_degrees(
                place(home_lat_deg, state.lat_deg),
                place(home_lon_deg, state.lon_deg),
            ),
            vel_enu: state.vel_enu,
            ..GpsSample::default()
        };
        (self.alt_amsl_m, self.resumed_gps, self.first_answer_us) = (state.alt_m, Some(sample), Some(0));
    }

    /// Starts again for a restarted executable: its first position is the centre of the mirror again.
    pub fn restart(&mut self) {
        *self = Self::new(self.config);
    }

    /// Stores the sensors' measurements.
    pub fn sense(&mut self, frame: &SensorFrame) {
        self.frame = *frame;
        if let Some(pressure_pa) = frame.pressure_pa {
            self.alt_amsl_m = altitude_m(pressure_pa);
        }
        if let Some(gps) = frame.gps.or(self.resumed_gps.take()) {
            self.gps = Some((gps, frame.time));
        }
    }

    /// Returns the packet for the newest measurements. `now_us` is wall time.
    pub fn packet(&self, now_us: u64) -> Packet {
        let Position { lat_deg, lon_deg, vel_enu } = match self.gps {
            Some((gps, at)) if !self.is_at_home(now_us) => self.measured(&gps, at),
            _ => self.at_home(),
        };
        let dialect = self.config.dialect;
        let (home_lat_deg, home_lon_deg, _) = self.config.home;
        let on_wire = |centre_deg, value_deg| {
            if dialect.mirrors() && value_deg != NO_FIX_DEG {
                mirrored(centre_deg, value_deg)
            } else {
                value_deg
            }
        };
        dialect.encode(&State {
            stamp_s: match self.config.stamps {
                Stamps::Constant => STAMP_S,
                Stamps::Sim => STAMP_S + self.frame.time.as_secs_f64(),
            },
            rate_flu: self.frame.rate_flu,
            specific_force_flu: self.frame.specific_force_flu,
            attitude: self.frame.truth_attitude.unwrap_or_else(UnitQuaternion::identity),
            vel_enu,
            lon_deg: on_wire(home_lon_deg, lon_deg),
            lat_deg: on_wire(home_lat_deg, lat_deg),
            alt_m: self.alt_amsl_m,
            pressure_pa: pressure_pa(self.alt_amsl_m),
        })
    }

    /// Records that a packet was sent at `now_us` of wall time.
    pub fn sent(&mut self, now_us: u64) {
        self.unanswered_us.get_or_insert(now_us);
        self.sent_us = now_us;
    }

    /// Returns the motor command of a packet that arrived at `now_us` of wall time; `None` if it is none.
    pub fn answered(&mut self, datagram: &[u8], now_us: u64) -> Option<MotorCommand> {
        let values = self.config.motor_order.in_native_order(servo::decode(datagram)?);
        self.first_answer_us.get_or_insert(now_us);
        self.unanswered_us = None;
        Some(MotorCommand(values.map(|value| f64::from(value).clamp(0.0, 1.0))))
    }

    pub fn state(&self, now_us: u64) -> FeedState {
        let is_silent =
            self.unanswered_us.is_some_and(|since_us| now_us.saturating_sub(since_us) >= SILENCE_US);
        match (self.first_answer_us, is_silent) {
            (None, _) => FeedState::Waiting,
            (Some(_), true) => FeedState::Silent,
            (Some(_), false) => FeedState::Answering,
        }
    }

    /// Returns `true` while the craft must wait: an executable that answered and is held up now would find
    /// the craft elsewhere. A step is flown every 10 ms all the same, because its packet or the answer may
    /// have been lost.
    pub fn waits(&self, now_us: u64) -> bool {
        self.is_held_up(now_us) && now_us.saturating_sub(self.sent_us) < PATIENCE_US
    }

    /// Returns `true` if the executable has not answered for longer than the motor command may stay the same,
    /// but not long enough to count as silent.
    pub fn is_held_up(&self, now_us: u64) -> bool {
        let is_late = |since_us| now_us.saturating_sub(since_us) >= PATIENCE_US;
        self.state(now_us) == FeedState::Answering && self.unanswered_us.is_some_and(is_late)
    }

    /// Returns the time since which packets are without an answer, µs of wall time.
    pub fn unanswered_since_us(&self) -> Option<u64> {
        self.unanswered_us
    }

    fn is_at_home(&self, now_us: u64) -> bool {
        self.first_answer_us.is_none_or(|first_us| now_us.saturating_sub(first_us) < AT_HOME_US)
    }

    fn at_home(&self) -> Position {
        let (lat_deg, lon_deg, _) = self.config.home;
        Position { lat_deg, lon_deg, vel_enu: Vector3::zeros() }
    }

    /// Returns the current position by the receiver's solution. It is extrapolated with the velocity because
    /// a packet may be read at any time.
    fn measured(&self, gps: &GpsSample, at: SimTime) -> Position {
        if !gps.fix {
            return Position { lat_deg: NO_FIX_DEG, lon_deg: NO_FIX_DEG, vel_enu: Vector3::zeros() };
        }
        let age_s = self.frame.time.seconds_since(at) + gps.latency_s;
        let moved_ne = Vector2::new(gps.vel_enu.y, gps.vel_enu.x) * age_s;
        let (lat_deg, lon_deg) = offset_to_degrees(gps.position, moved_ne);
        Position { lat_deg, lon_deg, vel_enu: gps.vel_enu }
    }
}

struct Position {
    lat_deg: f64,
    lon_deg: f64,
    vel_enu: Vector3<f64>,
}

/// Returns the height (m) in the troposphere of the standard atmosphere at a pressure (Pa), the inverse of
/// [`pressure_pa`].
fn altitude_m(pressure_pa: f64) -> f64 {
    (1.0 - math::powf((pressure_pa / 101_325.0).max(0.0), 1.0 / 5.255_88)) / 2.255_77e-5
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::LatLon;

    const HOME: (f64, f64, f64) = (40.4635, -79.5182, 300.0);
    const MS: u64 = 1000;

    fn feed(dialect: Dialect) -> SitlFeed {
        let config =
            FeedConfig { dialect, stamps: Stamps::Constant, motor_order: MotorOrder::Native, home: HOME };
        SitlFeed::new(config)
    }

    fn frame_at(ms: u64, lat_deg: f64, fix: bool) -> SensorFrame {
        let gps = GpsSample {
            fix,
            position: LatLon::from_degrees(lat_deg, HOME.1),
            vel_enu: Vector3::new(0.0, 5.0, 0.0),
            ..GpsSample::default()
        };
        SensorFrame {
            time: SimTime(ms * MS),
            gps: Some(gps),
            pressure_pa: Some(pressure_pa(320.0)),
            truth_attitude: Some(UnitQuaternion::identity()),
            ..SensorFrame::default()
        }
    }

    fn motors(feed: &mut SitlFeed, ms: u64) -> Option<MotorCommand> {
        feed.answered(&servo::encode([1100.0, 1200.0, 1300.0, 1400.0]), ms * MS)
    }

    /// Returns the latitude on the wire.
    fn latitude(feed: &SitlFeed, ms: u64) -> f64 {
        feed.packet(ms * MS).fields[15]
    }

    #[test]
    fn a_craft_waits_for_an_executable_that_is_held_up_and_asks_again_meanwhile() {
        let mut feed = feed(Dialect::SitlGz);
        feed.sent(0);
        assert!(!feed.waits(50 * MS), "it boots");
        motors(&mut feed, 50);
        let mut flown = 0;
        for ms in 51..1051 {
            if !feed.waits(ms * MS) {
                feed.sent(ms * MS);
                flown += 1;
            }
        }
        // Ten at once, then one in ten.
        assert!((105..=115).contains(&flown), "{flown}");
        assert!(!feed.waits(1060 * MS), "it is silent, which is reported and has its own rule");
        motors(&mut feed, 1061);
        assert!(!feed.waits(1062 * MS));
    }

    #[test]
    fn a_feed_that_continues_after_a_packet_sends_the_same_places_as_the_feed_that_sent_it() {
        for dialect in [Dialect::SitlGz, Dialect::Legacy] {
            let mut first = feed(dialect);
            motors(&mut first, 50);
            let sense = |feed: &mut SitlFeed, ms: u64, has_gps: bool| {
                let mut frame = frame_at(ms, HOME.0 + 0.001, true);
                (frame.pressure_pa, frame.gps) =
                    (frame.pressure_pa.filter(|_| has_gps), frame.gps.filter(|_| has_gps));
                feed.sense(&frame);
            };
            sense(&mut first, 42_300, true);
            sense(&mut first, 42_331, false);
            let mut second = feed(dialect);
            second.resume(&first.packet(42_331 * MS).to_bytes());
            for ms in [42_332, 42_395] {
                sense(&mut first, ms, false);
                sense(&mut second, ms, false);
                // 1e-7 degrees are 1 cm.
                let apart = latitude(&first, ms) - latitude(&second, ms);
                assert!(apart.abs() < 1.5e-7, "{apart} degrees at {ms} ms");
                assert_eq!(first.alt_amsl_m.to_bits(), second.alt_amsl_m.to_bits());
            }
        }
    }

    #[test]
    fn every_packet_carries_the_same_stamp_unless_the_executable_follows_simulated_time() {
        let mut constant = feed(Dialect::SitlGz);
        let mut sim = SitlFeed::new(FeedConfig { stamps: Stamps::Sim, ..constant.config });
        for ms in [0, 7, 900] {
            constant.sense(&frame_at(ms, HOME.0, true));
            sim.sense(&frame_at(ms, HOME.0, true));
            assert_eq!(constant.packet(ms * MS).stamp_s().to_bits(), 1.0_f64.to_bits());
            assert!((sim.packet(ms * MS).stamp_s() - 1.0 - ms as f64 * 1e-3).abs() < 1e-12);
        }
    }

    #[test]
    fn until_it_has_answered_for_a_while_the_craft_is_at_home_with_a_fix() {
        let mut feed = feed(Dialect::SitlGz);
        let north = HOME.0 + 0.001;
        for (ms, fix) in [(0, false), (500, true)] {
            feed.sense(&frame_at(ms, north, fix));
            assert!((latitude(&feed, ms) - HOME.0).abs() < 1e-12);
        }
        assert!(motors(&mut feed, 1000).is_some());
        assert!((latitude(&feed, 1199) - HOME.0).abs() < 1e-12);
        // Mirrored about home, and extrapolated at 5 m/s from the solution of half a second before.
        feed.sense(&SensorFrame { time: SimTime(1000 * MS), gps: None, ..frame_at(0, 0.0, true) });
        let carried_m = (HOME.0 - 0.001 - latitude(&feed, 1200)) * 111_319.5;
        assert!((carried_m - 2.5).abs() < 0.01, "{carried_m}");
        feed.restart();
        assert!((latitude(&feed, 1300) - HOME.0).abs() < 1e-12);
    }

    #[test]
    fn without_a_fix_the_place_is_out_of_range_and_the_rest_goes_on() {
        let mut feed = feed(Dialect::SitlGz);
        motors(&mut feed, 0);
        feed.sense(&frame_at(1000, HOME.0, false));
        let fields = feed.packet(1000 * MS).fields;
        assert_eq!((fields[14].to_bits(), fields[15].to_bits()), (999.0_f64.to_bits(), 999.0_f64.to_bits()));
        assert!((fields[16] - 320.0).abs() < 1e-6 && (fields[6] + crate::geo::GRAVITY).abs() < 1e-9);
    }

    #[test]
    fn a_dialect_without_a_mirror_has_true_positions() {
        let mut feed = feed(Dialect::Legacy);
        motors(&mut feed, 0);
        feed.sense(&frame_at(1000, HOME.0 + 0.001, true));
        assert!((latitude(&feed, 1000) - HOME.0 - 0.001).abs() < 1e-7);
    }

    #[test]
    fn motors_come_in_the_order_of_the_airframe_and_nonsense_is_none() {
        let mut native = feed(Dialect::SitlGz);
        let values = motors(&mut native, 0).unwrap().0;
        assert!(
            std::iter::zip(values, [0.1, 0.2, 0.3, 0.4]).all(|(a, b)| (a - b).abs() < 1e-6),
            "{values:?}"
        );
        let mut legacy = SitlFeed::new(FeedConfig { motor_order: MotorOrder::Legacy, ..native.config });
        let sent = MotorOrder::Legacy.arrange([1100.0, 1200.0, 1300.0, 1400.0]);
        assert_eq!(legacy.answered(&servo::encode(sent), 0).unwrap().0, values);
        assert!(legacy.answered(&[0; 15], 0).is_none() && legacy.answered(&[0xff; 16], 0).is_none());
    }

    #[test]
    fn a_second_of_silence_is_reported() {
        let mut feed = feed(Dialect::SitlGz);
        assert_eq!(feed.state(5000 * MS), FeedState::Waiting);
        motors(&mut feed, 5000);
        for ms in 5001..5900 {
            feed.sent(ms * MS);
        }
        assert_eq!(feed.state(6000 * MS), FeedState::Answering);
        assert_eq!(feed.state(6001 * MS), FeedState::Silent);
        motors(&mut feed, 6002);
        assert_eq!(feed.state(6002 * MS), FeedState::Answering);
    }

    #[test]
    fn who_was_not_asked_is_not_silent() {
        let mut feed = feed(Dialect::SitlGz);
        feed.sent(1000 * MS);
        motors(&mut feed, 1001);
        // This program was held up for three seconds.
        assert_eq!(feed.state(4000 * MS), FeedState::Answering);
        feed.sent(4000 * MS);
        assert_eq!(feed.state(4001 * MS), FeedState::Answering);
    }
}
