//! The link to an executable over real sockets, with the stand-in at the other end (L-9).

use std::net::{IpAddr, Ipv4Addr, UdpSocket};
use std::time::{Duration, Instant};

use betadeck::link::conventions::{Dialect, MotorOrder, Stamps};
use betadeck::link::proto::sitl_feed::{FeedConfig, FeedState};
use betadeck::link::{SitlPeer, SitlPorts};
use betadeck::signals::{RcFrame, SensorFrame, SimTime};

use super::stand_in::program::{End, Ports};
use super::stand_in::{StandIn, free_ports};

const HOME: (f64, f64, f64) = (40.4635, -79.5182, 300.0);

fn open(ports: Ports, is_up: bool) -> SitlPeer {
    let config = FeedConfig {
        dialect: Dialect::SitlGz,
        stamps: Stamps::Constant,
        motor_order: MotorOrder::Native,
        home: HOME,
    };
    let Ports { raw, motors, fdm, rc, .. } = ports;
    let ports = SitlPorts { ip: IpAddr::V4(Ipv4Addr::LOCALHOST), raw, motors, fdm, rc };
    let mut peer = SitlPeer::open(config, ports, Instant::now()).unwrap();
    if is_up {
        peer.came_up();
    }
    peer
}

/// Feeds for `seconds`, at most a thousand states and fifty RC packets a second. Returns the number of states sent.
fn feed(peer: &mut SitlPeer, seconds: f64) -> u64 {
    let start = Instant::now();
    let mut sent = 0_u64;
    while start.elapsed().as_secs_f64() < seconds {
        let now = Instant::now();
        let at = SimTime((now - start).as_micros() as u64);
        peer.send_state(&SensorFrame { time: at, ..SensorFrame::default() }, now);
        if sent.is_multiple_of(20) {
            peer.send_rc(&RcFrame { channels: [1500; 16] }, now);
        }
        sent += 1;
        std::thread::sleep(Duration::from_millis(1));
        let _motors = peer.take_motors(Instant::now());
    }
    sent
}

/// The number of attempts, each of a tenth of a second or less, within which even a busy machine keeps up once.
const ROUNDS: u32 = 600;

#[test]
fn an_executable_is_answered_for_nearly_every_packet_and_its_clock_is_the_walls() {
    let Ports { raw, motors, .. } = free_ports();
    let stand_in = StandIn::start(raw, motors);
    let mut peer = open(stand_in.ports, true);
    let kept_up = (0..ROUNDS).any(|_| {
        let before = stand_in.seen();
        feed(&mut peer, 0.1);
        let seen = stand_in.seen();
        let (packets, answered) = (seen.packets - before.packets, seen.answered - before.answered);
        packets > 20 && answered as f64 >= 0.95 * packets as f64
    });
    let seen = stand_in.seen();
    assert!(kept_up, "{seen:?}");
    assert_eq!((seen.other_stamps, seen.moved_before_answer), (0, 0), "{seen:?}");
    assert!(stand_in.clock_error_us().abs() <= 50_000.0, "{}", stand_in.clock_error_us());
    assert_eq!(peer.state(Instant::now()), FeedState::Answering);
    assert_eq!(stand_in.stop(), [End::Stopped]);
}

#[test]
fn a_silent_executable_is_reported_and_found_again() {
    let Ports { raw, motors, .. } = free_ports();
    let stand_in = StandIn::start(raw, motors);
    let mut peer = open(stand_in.ports, true);
    let until = |peer: &mut SitlPeer, wanted: FeedState| {
        assert!((0..ROUNDS).any(|_| {
            feed(peer, 0.5);
            peer.state(Instant::now()) == wanted
        }));
    };
    until(&mut peer, FeedState::Answering);
    stand_in.hang(true);
    until(&mut peer, FeedState::Silent);
    stand_in.hang(false);
    until(&mut peer, FeedState::Answering);
}

#[test]
fn an_executable_that_is_down_gets_no_state_before_it_is_up_again() {
    let ports = free_ports();
    let mut peer = open(ports, false);
    let (fdm, rc) = (
        UdpSocket::bind(("127.0.0.1", ports.fdm)).unwrap(),
        UdpSocket::bind(("127.0.0.1", ports.rc)).unwrap(),
    );
    for socket in [&fdm, &rc] {
        socket.set_nonblocking(true).unwrap();
    }
    let count = |socket: &UdpSocket| std::iter::from_fn(|| socket.recv(&mut [0; 512]).ok()).count();
    assert!(feed(&mut peer, 0.1) > 1);
    assert_eq!(count(&fdm), 0, "it has not booted: a state now may be its end");
    assert!(count(&rc) > 0);
    peer.came_up();
    feed(&mut peer, 0.1);
    assert!(count(&fdm) > 1);
    // A late packet of the old executable does not count as the boot of the new one.
    fdm.send_to(&[0; 16], ("127.0.0.1", ports.motors)).unwrap();
    peer.went_down();
    feed(&mut peer, 0.1);
    assert_eq!(count(&fdm), 0);
    fdm.send_to(&[0; 16], ("127.0.0.1", ports.motors)).unwrap();
    // The first motor packet means that the executable will be ready soon.
    peer.take_motors(Instant::now());
    assert!((0..ROUNDS).any(|_| {
        feed(&mut peer, 0.1);
        count(&fdm) > 1
    }));
}

#[test]
fn an_executable_that_is_held_up_still_hears_the_transmitter_unless_that_was_cut() {
    for is_cut in [false, true] {
        let ports = free_ports();
        let mut peer = open(ports, true);
        let rc = UdpSocket::bind(("127.0.0.1", ports.rc)).unwrap();
        rc.set_nonblocking(true).unwrap();
        let heard = || std::iter::from_fn(|| rc.recv(&mut [0; 512]).ok()).count();
        let start = Instant::now();
        let at = |ms| start + Duration::from_millis(ms);
        peer.send_rc(&RcFrame::default(), at(0));
        // The executable answers once.
        rc.send_to(&[0; 16], ("127.0.0.1", ports.motors)).unwrap();
        while peer.take_motors(at(1)).is_none() {}
        let held_from = if is_cut { 200 } else { 10 };
        peer.send_state(&SensorFrame::default(), at(held_from));
        assert_eq!(heard(), 1);
        for ms in held_from..held_from + 100 {
            peer.repeat_rc(at(ms));
        }
        let repeated = heard();
        assert!(if is_cut { repeated == 0 } else { (3..=5).contains(&repeated) }, "{repeated}");
    }
}
