//! The rules of timing: the packets that are answered, those that only set the time base, and the packets
//! sent unasked.

use betadeck::link::conventions::Dialect;
use betadeck::link::proto::fdm_link::{FdmLink, FdmLinkConfig, FdmNotice, PacketKind, Reply};
use betadeck::telemetry::LinkState;
use nalgebra::UnitQuaternion;

use super::{MS, at_rest, bytes, default_flow, packet};

#[test]
fn ping_pong_answers_every_packet_once_and_nothing_more() {
    let mut link = FdmLink::new(FdmLinkConfig::default(), 0);
    let mut ticks = 0;
    for step in 0..3000_u64 {
        let now = step * MS;
        let received = link.receive(&packet(step as f64 * 1e-3), now);
        assert_eq!((received.kind, received.reply), (PacketKind::State, Reply::Both));
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
    assert_eq!(received.kind, PacketKind::Resync { restarted: false });
    assert_eq!(received.reply, Reply::Servo);
    assert_eq!((received.sensors, received.ticks), (None, 0));
    let next = link.receive(&packet(1.601), now + 601 * MS);
    assert_eq!((next.kind, next.ticks, next.reply), (PacketKind::State, 1, Reply::Both));
}

#[test]
fn the_first_packet_of_all_is_a_resync_when_it_comes_late() {
    let mut link = FdmLink::new(FdmLinkConfig::default(), 0);
    assert_eq!(link.receive(&packet(7.0), 501 * MS).kind, PacketKind::Resync { restarted: false });
    let mut link = FdmLink::new(FdmLinkConfig::default(), 0);
    assert_eq!(link.receive(&packet(7.0), 499 * MS).kind, PacketKind::State);
}

#[test]
fn old_stamps_are_ignored_until_they_are_the_new_time() {
    let (mut link, now) = default_flow(1000);
    for step in 0..100_u32 {
        let received = link.receive(&packet(0.9 + f64::from(step) * 1e-6), now + u64::from(step) * 4 * MS);
        assert_eq!((received.kind, received.reply), (PacketKind::Old, Reply::Nothing));
        assert_eq!(received.sensors, None);
    }
    let received = link.receive(&packet(0.91), now + 502 * MS);
    assert_eq!(received.kind, PacketKind::Resync { restarted: true });
    assert_eq!(received.notices.as_slice(), [FdmNotice::Restarted]);
    assert_eq!(link.receive(&packet(0.911), now + 503 * MS).kind, PacketKind::State);
    assert_eq!(link.counters().old, 100);
}

#[test]
fn kicks_twice_a_second_until_the_first_packet() {
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
