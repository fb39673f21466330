//! Datagrams that are not packets of a simulator.

use betadeck::link::proto::fdm::Packet;
use betadeck::link::proto::fdm_link::PacketKind;
use nalgebra::Vector3;

use super::{SeededChance, default_flow, packet};

#[test]
fn a_hundred_thousand_datagrams_of_noise_leave_no_trace() {
    let mut chance = SeededChance(1);
    let (mut link, mut now) = default_flow(10);
    let good = packet(0.01);
    for _ in 0..100_000 {
        chance.happens(0.5);
        let size = (chance.0 >> 40) as usize % 1500;
        let mut datagram: Vec<u8> = (0..size).map(|at| (chance.0 >> (at % 57)) as u8 ^ at as u8).collect();
        // Half of the datagrams are nearly valid.
        if chance.happens(0.5) && size >= 144 {
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

#[test]
fn stored_packets_are_parsed_alike_by_link_and_codec() {
    let (mut link, now) = default_flow(10);
    let short = link.receive(&packet(1.0)[..143], now);
    assert!(matches!(short.kind, PacketKind::Refused(_)));
    assert!(Packet::parse(&packet(1.0)).is_ok());
    assert_eq!(link.counters().wrong_size, 1);
}
