//! Datagrams of a simulator. The bytes are one datagram, and are also cut into an exchange.

use betadeck::firmware::config::Configuration;
use betadeck::firmware::{Firmware, FirmwareOptions};
use betadeck::link::conventions::Dialect;
use betadeck::link::proto::fdm::{self, Gravity, Packet, PacketError, State};
use betadeck::link::proto::fdm_link::{FdmLink, FdmLinkConfig, PacketKind, Reply};
use betadeck::signals::SensorFrame;
use betadeck::telemetry::LinkState;

use super::craft;

/// The most ticks that one datagram may request: half a second of them and a rounded one.
const MAX_TICKS: u32 = 501;
/// The ticks that are actually run after each datagram.
const TICKS: u32 = 2;
/// Microseconds for each unit of the byte that sets the simulator's wait.
const PAUSE_UNIT_US: u64 = 4_096;

const DIALECTS: [Dialect; 3] = [Dialect::SitlGz, Dialect::GzPlugin, Dialect::Legacy];

/// Reads one datagram, and flies on many.
pub fn run(data: &[u8]) {
    one_datagram(data);
    exchange(data);
}

fn one_datagram(data: &[u8]) {
    match Packet::parse(data) {
        Ok(packet) => {
            assert_eq!(packet.size, data.len());
            assert_eq!(packet.to_bytes(), data[..fdm::SIZE]);
            for dialect in DIALECTS {
                for gravity in [Gravity::Included, Gravity::Missing] {
                    assert_sane(&dialect.decode(&packet, gravity));
                }
                assert_encodes(dialect, &dialect.decode(&packet, dialect.usual_gravity()));
            }
        }
        Err(refusal) => assert_eq!(refusal == PacketError::TooShort, data.len() < fdm::SIZE),
    }
}

fn assert_sane(state: &State) {
    assert!(state.rate_flu.iter().chain(&state.specific_force_flu).all(|value| value.is_finite()));
    assert!((state.attitude.norm() - 1.0).abs() < 1e-9 && state.pressure_pa.is_finite());
}

/// Asserts that a state survives the wire, as far as the dialect carries it.
fn assert_encodes(dialect: Dialect, state: &State) {
    let packet = Packet::parse(&dialect.encode(state).to_bytes()).expect("our own datagram");
    let back = dialect.decode(&packet, dialect.usual_gravity());
    assert!((back.rate_flu - state.rate_flu).norm() < 1e-9);
    assert!((back.specific_force_flu - state.specific_force_flu).norm() < 1e-9);
    assert!(back.attitude.angle_to(&state.attitude) < 1e-6);
    assert_eq!((back.lat_deg, back.lon_deg, back.alt_m), (state.lat_deg, state.lon_deg, state.alt_m));
}

/// Exchanges datagrams. The first byte of each, which hardly changes its stamp, sets the simulator's wait
/// before it.
fn exchange(data: &[u8]) {
    let mut link = FdmLink::new(FdmLinkConfig::default(), 0);
    let mut firmware = Firmware::new(Configuration::default(), FirmwareOptions::default());
    let mut now_us = 0;
    let mut count = 0;
    for datagram in data.chunks(fdm::SIZE) {
        let wait = u64::from(datagram[0]) * PAUSE_UNIT_US;
        for part in 1..=4 {
            link.poll(now_us + wait * part / 4);
        }
        now_us += wait;
        count += 1;
        let received = link.receive(datagram, now_us);
        assert!(received.ticks <= MAX_TICKS, "{} ticks", received.ticks);
        assert_eq!(received.sensors.is_some(), received.kind == PacketKind::State);
        if let PacketKind::Refused(_) | PacketKind::Old = received.kind {
            assert_eq!((received.ticks, received.reply), (0, Reply::Nothing));
        }
        if !matches!(received.kind, PacketKind::Refused(_)) {
            assert_eq!(link.state(now_us), LinkState::Flowing);
        }
        if let Some(sensors) = received.sensors {
            assert_finite(&sensors);
            for _ in 0..received.ticks.min(TICKS) {
                craft::assert_step(&mut firmware, &sensors);
            }
        }
    }
    let counters = link.counters();
    assert_eq!(counters.received, count);
    assert!(counters.wrong_size + counters.senseless + counters.old + counters.resyncs <= count);
}

fn assert_finite(sensors: &SensorFrame) {
    assert!(sensors.rate_flu.iter().chain(&sensors.specific_force_flu).all(|value| value.is_finite()));
    assert!(sensors.pressure_pa.is_none_or(f64::is_finite));
    assert!(sensors.mag_flu.is_none_or(|field| field.iter().all(|value| value.is_finite())));
    assert!(sensors.gps.is_none_or(|gps| gps.position.is_on_globe()), "{:?}", sensors.gps);
}
