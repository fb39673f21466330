//! The conversation with an external simulator, in simulated wall time, without sockets.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::collections::VecDeque;

use betadeck::firmware::config::Configuration;
use betadeck::firmware::{AttitudeSource, Firmware, FirmwareOptions};
use betadeck::link::proto::fdm::{GZ_PLUGIN_SIZE, Packet, State, pressure_pa};
use betadeck::link::proto::fdm_link::{Answer, FdmLink, FdmLinkConfig, Notice, Received, Verdict};
use betadeck::signals::SimTime;
use betadeck::signals::fdm::Dialect;
use betadeck::signals::fdm::Mirror;
use betadeck::telemetry::{FirmwareEvent, LinkState};
use nalgebra::{UnitQuaternion, Vector3};

const MS: u64 = 1000;

/// A craft at rest, level, facing north.
fn at_rest(stamp_s: f64) -> State {
    State {
        stamp_s,
        rate_flu: Vector3::zeros(),
        specific_force_flu: Vector3::new(0.0, 0.0, betadeck::geo::GRAVITY),
        attitude: UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::FRAC_PI_2),
        vel_enu: Vector3::zeros(),
        lon_deg: -79.51825,
        lat_deg: 40.4635,
        alt_m: 0.0,
        pressure_pa: pressure_pa(0.0),
    }
}

fn bytes(dialect: Dialect, state: &State) -> Vec<u8> {
    let mut bytes = dialect.encode(state).to_bytes().to_vec();
    if dialect == Dialect::GzPlugin {
        bytes.resize(GZ_PLUGIN_SIZE, 0xff);
    }
    bytes
}

fn packet(stamp_s: f64) -> Vec<u8> {
    bytes(Dialect::SitlGz, &at_rest(stamp_s))
}

/// A link with `count` packets behind it, one a millisecond, and the time after them.
fn flowing(config: FdmLinkConfig, dialect: Dialect, count: u64) -> (FdmLink, u64) {
    let mut link = FdmLink::new(config, 0);
    for ms in 0..count {
        link.receive(&bytes(dialect, &at_rest(ms as f64 * 1e-3)), ms * MS);
    }
    (link, count * MS)
}

fn default_flow(count: u64) -> (FdmLink, u64) {
    flowing(FdmLinkConfig::default(), Dialect::SitlGz, count)
}

#[test]
fn ping_pong_answers_every_packet_once_and_nothing_more() {
    let mut link = FdmLink::new(FdmLinkConfig::default(), 0);
    let mut ticks = 0;
    for step in 0..3000_u64 {
        let now = step * MS;
        let received = link.receive(&packet(step as f64 * 1e-3), now);
        assert_eq!((received.verdict, received.answer), (Verdict::State, Answer::Both));
        ticks += received.ticks;
        assert!(!link.poll(now + 500));
    }
    assert_eq!(ticks, 2999);
    let last = 2999 * MS;
    assert!((0..95).all(|ms| !link.poll(last + ms * MS)));
}

#[test]
fn the_first_packet_after_a_pause_sets_the_time_only() {
    let (mut link, now) = default_flow(1000);
    let mut rolled = at_rest(1.6);
    rolled.attitude *= UnitQuaternion::from_euler_angles(1.57, 0.0, 0.0);
    let received = link.receive(&bytes(Dialect::SitlGz, &rolled), now + 600 * MS);
    assert_eq!(received.verdict, Verdict::Resync { restarted: false });
    assert_eq!(received.answer, Answer::Servo);
    assert_eq!((received.sensors, received.ticks), (None, 0));
    let next = link.receive(&packet(1.601), now + 601 * MS);
    assert_eq!((next.verdict, next.ticks, next.answer), (Verdict::State, 1, Answer::Both));
}

#[test]
fn the_first_packet_of_all_is_a_resync_when_it_comes_late() {
    let mut link = FdmLink::new(FdmLinkConfig::default(), 0);
    assert_eq!(link.receive(&packet(7.0), 501 * MS).verdict, Verdict::Resync { restarted: false });
    let mut link = FdmLink::new(FdmLinkConfig::default(), 0);
    assert_eq!(link.receive(&packet(7.0), 499 * MS).verdict, Verdict::State);
}

#[test]
fn old_stamps_are_ignored_until_they_are_the_new_time() {
    let (mut link, now) = default_flow(1000);
    for step in 0..100_u32 {
        let received = link.receive(&packet(0.9 + f64::from(step) * 1e-6), now + u64::from(step) * 4 * MS);
        assert_eq!((received.verdict, received.answer), (Verdict::Old, Answer::Nothing));
        assert_eq!(received.sensors, None);
    }
    let received = link.receive(&packet(0.91), now + 502 * MS);
    assert_eq!(received.verdict, Verdict::Resync { restarted: true });
    assert_eq!(received.notices.as_slice(), [Notice::Restarted]);
    assert_eq!(link.receive(&packet(0.911), now + 503 * MS).verdict, Verdict::State);
    assert_eq!(link.counters().old, 100);
}

#[test]
fn knocks_while_nobody_speaks() {
    let mut link = FdmLink::new(FdmLinkConfig::default(), 0);
    // The packet at the start and those of five seconds.
    let sent = 1 + (1..5000).filter(|ms| link.poll(ms * MS)).count();
    assert_eq!(sent, 10);
    assert_eq!(link.state(5000 * MS), LinkState::Waiting);
    for ms in 5000..10_000 {
        if link.poll(ms * MS) {
            link.refused();
        }
    }
    assert_eq!(link.counters().kicks, 19);
    assert_eq!(link.state(10_000 * MS), LinkState::Waiting);
}

#[test]
fn silence_is_a_state() {
    let (link, now) = default_flow(10);
    assert_eq!(link.state(now), LinkState::Flowing);
    assert_eq!(link.state(now + 1001 * MS), LinkState::Silent);
}

#[test]
fn a_position_off_the_globe_is_no_fix_and_harms_nothing_else() {
    let (mut link, start) = default_flow(500);
    let mut last_fix = 0;
    for ms in 0..3500 {
        let now = start + ms * MS;
        let mut state = at_rest(now as f64 * 1e-6);
        if ms < 3000 {
            state.lat_deg = 999.0;
        }
        let received = link.receive(&bytes(Dialect::SitlGz, &state), now);
        let sensors = received.sensors.unwrap();
        assert!(sensors.specific_force_flu.z > 9.0);
        if let Some(gps) = sensors.gps {
            assert!(ms >= 3000 && gps.fix);
            last_fix = ms;
            if ms < 3200 {
                assert!(ms <= 3200, "back within 0.2 s");
            }
        }
    }
    assert!(last_fix >= 3400);
}

#[test]
fn a_firmware_loses_the_fix_2500_ms_after_the_last_position_and_nothing_else() {
    let options =
        FirmwareOptions { attitude: AttitudeSource::Truth, gps_timeout_s: 2.5, ..FirmwareOptions::default() };
    let mut firmware = Firmware::new(Configuration::default(), options);
    let mut link = FdmLink::new(FdmLinkConfig::default(), 0);
    let mut time_ms = 0;
    let (mut lost_ms, mut back_ms) = (None, None);
    const GONE_MS: u64 = 4000;
    const HERE_MS: u64 = 7000;
    for ms in 0..8000 {
        let mut state = at_rest(ms as f64 * 1e-3);
        if (GONE_MS..HERE_MS).contains(&ms) {
            state.lat_deg = 999.0;
        }
        let received = link.receive(&bytes(Dialect::SitlGz, &state), ms * MS);
        let Some(mut sensors) = received.sensors else { continue };
        for _ in 0..received.ticks {
            time_ms += 1;
            sensors.time = SimTime(time_ms * MS);
            firmware.step(&sensors);
            (sensors.pressure_pa, sensors.mag_flu, sensors.gps) = (None, None, None);
        }
        while let Some(event) = firmware.take_event() {
            match event {
                FirmwareEvent::GpsLost { .. } => lost_ms = Some(ms),
                FirmwareEvent::GpsFix { .. } if ms > GONE_MS => back_ms = Some(ms),
                _ => {}
            }
        }
        if ms > 1000 {
            let facts = firmware.msp_facts(None);
            assert!(facts.roll_deg.abs() < 0.1 && facts.pitch_deg.abs() < 0.1, "level at {ms} ms");
        }
    }
    // A position comes every 100 ms, the last good one up to that long before the bad ones.
    let (lost_ms, back_ms) = (lost_ms.unwrap(), back_ms.unwrap());
    assert!((GONE_MS + 2400..=GONE_MS + 2700).contains(&lost_ms), "{lost_ms}");
    assert!((HERE_MS..=HERE_MS + 200).contains(&back_ms), "{back_ms}");
}

#[test]
fn sensors_sample_at_their_own_rates() {
    let mut link = FdmLink::new(FdmLinkConfig::default(), 0);
    let (mut gps, mut baro, mut mag) = (0, 0, 0);
    for step in 0..1990_u64 {
        let received = link.receive(&packet(step as f64 * 0.5e-3), step * MS);
        let sensors = received.sensors.unwrap();
        gps += u32::from(sensors.gps.is_some());
        baro += u32::from(sensors.pressure_pa.is_some());
        mag += u32::from(sensors.mag_flu.is_some());
        assert!(sensors.truth_attitude.is_some());
    }
    assert_eq!((gps, baro, mag), (10, 50, 100));
}

/// Flies north at 5 m/s for three seconds; positions are mirrored on the wire when `mirrored`.
fn fly_north(config: FdmLinkConfig, dialect: Dialect, mirrored: bool) -> (Vec<Notice>, f64) {
    let (mut link, start) = flowing(config, dialect, 300);
    let mut notices = Vec::new();
    let mut lat = 0.0;
    for ms in 0..3000 {
        let now = start + ms * MS;
        let mut state = at_rest(now as f64 * 1e-6);
        state.vel_enu = Vector3::new(0.0, 5.0, 0.0);
        let north_deg = ms as f64 * 5e-3 / 111_043.55;
        state.lat_deg += if mirrored { -north_deg } else { north_deg };
        let received = link.receive(&bytes(dialect, &state), now);
        notices.extend(received.notices);
        if let Some(gps) = received.sensors.unwrap().gps {
            lat = gps.position.lat_deg();
        }
    }
    (notices, lat)
}

#[test]
fn mirrored_positions_are_turned_back() {
    let (notices, lat) = fly_north(FdmLinkConfig::default(), Dialect::GzPlugin, true);
    assert!(notices.is_empty());
    assert!(lat > 40.4635 + 0.0001);
}

#[test]
fn positions_that_are_not_mirrored_are_noticed() {
    let (notices, lat) = fly_north(FdmLinkConfig::default(), Dialect::GzPlugin, false);
    assert_eq!(notices, [Notice::NotMirrored]);
    assert!(lat > 40.4635 + 0.0001);
    let forced = FdmLinkConfig { mirror: Mirror::On, ..FdmLinkConfig::default() };
    let (notices, lat) = fly_north(forced, Dialect::GzPlugin, false);
    assert!(notices.is_empty() && lat < 40.4635);
    let off = FdmLinkConfig { mirror: Mirror::Off, ..FdmLinkConfig::default() };
    assert!(fly_north(off, Dialect::SitlGz, false).1 > 40.4635);
}

#[test]
fn gravity_is_found_in_the_acceleration_at_rest() {
    // A newer plugin sends the specific force in the plugin's layout.
    let mut link = FdmLink::new(FdmLinkConfig::default(), 0);
    let mut notices = Vec::new();
    let mut force = 0.0;
    for ms in 0..400_u64 {
        let mut packet = Dialect::GzPlugin.encode(&at_rest(ms as f64 * 1e-3));
        packet.fields[6] = -betadeck::geo::GRAVITY;
        let mut bytes = packet.to_bytes().to_vec();
        bytes.resize(GZ_PLUGIN_SIZE, 0);
        let received = link.receive(&bytes, ms * MS);
        notices.extend(received.notices);
        force = received.sensors.unwrap().specific_force_flu.z;
    }
    assert_eq!(notices, [Notice::GravityIncluded]);
    assert!((force - betadeck::geo::GRAVITY).abs() < 1e-9);
}

#[test]
fn an_acceleration_that_makes_no_sense_is_told_once() {
    let mut link = FdmLink::new(FdmLinkConfig::default(), 0);
    let mut notices = Vec::new();
    for ms in 0..1000_u64 {
        let mut packet = Dialect::SitlGz.encode(&at_rest(ms as f64 * 1e-3));
        packet.fields[6] = -5.0;
        notices.extend(link.receive(&packet.to_bytes(), ms * MS).notices);
    }
    assert_eq!(notices, [Notice::GravityUnclear]);
}

#[test]
fn the_dialect_follows_the_size_and_can_be_told() {
    let (link, _) = flowing(FdmLinkConfig::default(), Dialect::GzPlugin, 10);
    assert_eq!(link.dialect(), Some(Dialect::GzPlugin));
    let legacy = FdmLinkConfig { dialect: Some(Dialect::Legacy), ..FdmLinkConfig::default() };
    let (mut link, now) = flowing(legacy, Dialect::Legacy, 10);
    let received = link.receive(&bytes(Dialect::Legacy, &at_rest(0.010)), now);
    assert!(received.sensors.unwrap().truth_attitude.unwrap().angle_to(&at_rest(0.0).attitude) < 1e-9);
}

/// A small generator, so that the losses are the same in every run.
struct Dice(u64);

impl Dice {
    fn roll(&mut self, chance: f64) -> bool {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as f64 / f64::from(1_u32 << 31)) < chance
    }
}

#[test]
fn a_hundred_thousand_datagrams_of_noise_leave_no_trace() {
    let mut dice = Dice(1);
    let (mut link, mut now) = default_flow(10);
    let good = packet(0.01);
    for _ in 0..100_000 {
        dice.roll(0.5);
        let size = (dice.0 >> 40) as usize % 1500;
        let mut datagram: Vec<u8> = (0..size).map(|at| (dice.0 >> (at % 57)) as u8 ^ at as u8).collect();
        // Half of them are nearly good.
        if dice.roll(0.5) && size >= 144 {
            datagram[..144].copy_from_slice(&good);
            datagram[size % 144] ^= 1 << (size % 8);
        }
        now += 10;
        let received = link.receive(&datagram, now);
        if let Some(sensors) = received.sensors {
            let finite = |vector: Vector3<f64>| vector.iter().all(|value| value.is_finite());
            assert!(finite(sensors.rate_flu) && finite(sensors.specific_force_flu));
            assert!(sensors.pressure_pa.is_none_or(f64::is_finite));
            assert!(sensors.gps.is_none_or(|gps| finite(gps.vel_enu) && gps.position.is_on_globe()));
        }
    }
    let counters = link.counters();
    assert!(counters.wrong_size > 1000 && counters.senseless > 1000);
}

/// A simulator that keeps the rules of the public plugin: one servo packet a step, one state a step, a wait when there
/// is none.
struct Plugin {
    /// Whether its socket is bound.
    bound: bool,
    paused: bool,
    socket: VecDeque<()>,
    online: bool,
    misses: u32,
    sim_ms: u64,
    /// When it began to wait for a packet, µs.
    waiting_since: u64,
}

impl Plugin {
    fn new() -> Self {
        Self {
            bound: false,
            paused: false,
            socket: VecDeque::new(),
            online: false,
            misses: 0,
            sim_ms: 0,
            waiting_since: 0,
        }
    }

    /// The state it sends at `now`, if it completes a step.
    fn run(&mut self, now: u64) -> Option<Vec<u8>> {
        if !self.bound || self.paused || now < self.waiting_since {
            return None;
        }
        if self.socket.pop_front().is_some() {
            self.online = true;
            self.misses = 0;
        } else {
            let patience = if self.online { 1000 * MS } else { MS };
            if now - self.waiting_since < patience {
                return None;
            }
            self.misses += 1;
            if self.misses > 5 {
                self.online = false;
            }
        }
        self.waiting_since = now + MS;
        self.sim_ms += 1;
        self.online.then(|| packet((self.sim_ms - 1) as f64 * 1e-3))
    }
}

/// Both sides and the lossy cable between them.
struct Cable {
    link: FdmLink,
    plugin: Plugin,
    dice: Dice,
    loss: f64,
    now: u64,
    last_state: u64,
    longest_gap: u64,
    steps_since_trouble: u32,
    longest_queue: usize,
    states: u32,
}

impl Cable {
    fn new(loss: f64) -> Self {
        Self {
            link: FdmLink::new(FdmLinkConfig::default(), 0),
            plugin: Plugin::new(),
            dice: Dice(7),
            loss,
            now: 0,
            last_state: 0,
            longest_gap: 0,
            steps_since_trouble: 0,
            longest_queue: 0,
            states: 0,
        }
    }

    fn send_servo(&mut self) {
        if !self.plugin.bound {
            self.link.refused();
        } else if self.dice.roll(self.loss) {
            self.steps_since_trouble = 0;
        } else {
            self.plugin.socket.push_back(());
        }
    }

    fn run_until(&mut self, end: u64) {
        while self.now < end {
            if let Some(state) = self.plugin.run(self.now) {
                self.step(&state);
            }
            if self.link.poll(self.now) {
                self.send_servo();
            }
            self.now += 100;
        }
    }

    fn step(&mut self, state: &[u8]) {
        self.longest_gap = self.longest_gap.max(self.now - self.last_state);
        self.last_state = self.now;
        self.states += 1;
        self.steps_since_trouble += 1;
        if self.dice.roll(self.loss) {
            self.steps_since_trouble = 0;
            return;
        }
        let Received { answer, .. } = self.link.receive(state, self.now);
        if answer != Answer::Nothing {
            self.send_servo();
        }
        if self.steps_since_trouble > 20 {
            self.longest_queue = self.longest_queue.max(self.plugin.socket.len());
        }
    }

    fn trouble(&mut self) {
        self.steps_since_trouble = 0;
        self.last_state = self.now;
    }

    /// Runs on for a second: the time until packets flow.
    fn time_to_flow(&mut self) -> u64 {
        self.trouble();
        let start = self.now;
        let before = self.states;
        while self.states < before + 20 && self.now < start + 1000 * MS {
            self.run_until(self.now + MS);
        }
        self.now - start
    }
}

#[test]
fn either_side_may_start_first() {
    for (firmware_waits, simulator_waits) in [(0, 0), (0, 3456), (3456, 0), (1, 777)] {
        let mut cable = Cable::new(0.0);
        if firmware_waits == 0 && simulator_waits > 0 {
            // Nobody was there for the first packet.
            cable.link.refused();
            cable.run_until(simulator_waits * MS);
            cable.plugin.bound = true;
            cable.plugin.waiting_since = cable.now;
        } else {
            cable.plugin.bound = true;
            cable.send_servo();
        }
        let took = cable.time_to_flow();
        assert!(took <= 600 * MS, "{took} µs");
        cable.longest_gap = 0;
        cable.run_until(cable.now + 5000 * MS);
        assert!(cable.longest_gap <= 2 * MS, "{} µs", cable.longest_gap);
        assert!(cable.longest_queue <= 1, "{}", cable.longest_queue);
    }
}

#[test]
fn lost_packets_stall_the_simulator_for_a_tenth_at_most() {
    let mut cable = Cable::new(0.01);
    cable.plugin.bound = true;
    cable.send_servo();
    cable.run_until(30_000 * MS);
    assert!(cable.longest_gap <= 150 * MS, "{} µs", cable.longest_gap);
    assert!(cable.longest_queue <= 1, "{} packets wait", cable.longest_queue);
    assert!(cable.plugin.sim_ms > 10_000, "{} steps", cable.plugin.sim_ms);
}

#[test]
fn a_long_pause_leaves_no_packets_behind() {
    let mut cable = Cable::new(0.0);
    cable.plugin.bound = true;
    cable.send_servo();
    cable.run_until(5000 * MS);
    cable.plugin.paused = true;
    cable.run_until(65_000 * MS);
    assert!(cable.plugin.socket.len() > 5);
    assert_eq!(cable.link.state(cable.now), LinkState::Silent);
    cable.plugin.paused = false;
    cable.plugin.waiting_since = cable.now;
    assert!(cable.time_to_flow() <= 600 * MS);
    cable.longest_gap = 0;
    cable.run_until(cable.now + 5000 * MS);
    assert!(cable.longest_gap <= 150 * MS && cable.longest_queue <= 1, "{}", cable.longest_queue);
}

#[test]
fn a_restarted_simulator_is_picked_up() {
    for gone_ms in [50, 300, 5000] {
        let mut cable = Cable::new(0.0);
        cable.plugin.bound = true;
        cable.send_servo();
        cable.run_until(3000 * MS);
        cable.plugin = Plugin::new();
        cable.run_until((3000 + gone_ms) * MS);
        cable.plugin.bound = true;
        cable.plugin.waiting_since = cable.now;
        cable.trouble();
        let took = cable.time_to_flow();
        assert!(took <= 650 * MS, "gone for {gone_ms} ms: {took} µs");
        cable.longest_gap = 0;
        cable.run_until(cable.now + 3000 * MS);
        assert!(cable.longest_gap <= 150 * MS && cable.longest_queue <= 1);
        assert_eq!(cable.link.state(cable.now), LinkState::Flowing);
    }
}

#[test]
fn stored_packets_are_parsed_alike_by_link_and_codec() {
    let (mut link, now) = default_flow(10);
    let short = link.receive(&packet(1.0)[..143], now);
    assert!(matches!(short.verdict, Verdict::Refused(_)));
    assert!(Packet::parse(&packet(1.0)).is_ok());
    assert_eq!(link.counters().wrong_size, 1);
}
