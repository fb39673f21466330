//! The drop-in as a process, under the same measurements as the public executable (L-4, L-5, L-7).

use std::io::ErrorKind;
use std::net::{TcpStream, UdpSocket};
use std::time::{Duration, Instant};

use super::wire;
use crate::doors::msp;
use crate::doors::program::{PATIENCE, Sitl};

/// The silence after which the drop-in sends motors without a state.
const SILENCE: Duration = Duration::from_millis(100);

/// The number of states in a row. A socket keeps the answers to so many.
const STATES: usize = 200;

/// A simulator's sockets, and the drop-in that sends to them.
struct Link {
    motors: UdpSocket,
    raw: UdpSocket,
    sitl: Sitl,
    steps: u32,
}

impl Link {
    fn open() -> Self {
        let socket = || UdpSocket::bind("127.0.0.1:0").unwrap();
        let (motors, raw) = (socket(), socket());
        let port = |socket: &UdpSocket| socket.local_addr().unwrap().port();
        let sitl = Sitl::start(port(&raw), port(&motors));
        motors.set_read_timeout(Some(PATIENCE)).unwrap();
        raw.set_nonblocking(true).unwrap();
        Self { motors, raw, sitl, steps: 0 }
    }

    /// Returns the reference packet of a craft at rest, stamped a millisecond after the one before.
    fn state(&mut self) -> Vec<u8> {
        self.steps += 1;
        let mut bytes = wire::bytes("W1", "sitl_gz");
        bytes[..8].copy_from_slice(&(f64::from(self.steps) * 1e-3).to_le_bytes());
        bytes
    }

    fn send(&mut self) {
        let state = self.state();
        self.motors.send_to(&state, self.sitl.fdm).unwrap();
    }

    /// Sends a state and waits for the motors.
    fn step(&mut self) {
        self.send();
        assert_eq!(self.motors.recv(&mut [0; 100]).expect("motors"), 16);
    }

    /// Makes `count` steps. Returns `false` if one of them took so long that the drop-in may have sent motors without a
    /// state, or withheld an answer in return.
    fn steps_in_time(&mut self, count: usize) -> bool {
        let mut last = Instant::now();
        (0..count).all(|_| {
            self.step();
            std::mem::replace(&mut last, Instant::now()).elapsed() < SILENCE / 4
        })
    }

    /// Returns `true` if each of many states is answered by one packet on each port in time, and nothing follows. A busy
    /// machine proves nothing.
    fn is_answered_once(&mut self) -> bool {
        self.settle();
        let is_in_time = self.steps_in_time(STATES);
        let end = Instant::now() + SILENCE;
        if !is_in_time || !self.steps_in_time(1) {
            return false;
        }
        assert!(!self.motors_until(end), "motors without a state");
        let pulses = self.pulses();
        assert!(pulses <= STATES + 1, "{pulses} packets of pulses");
        pulses == STATES + 1
    }

    /// Takes the pulse packets that have arrived and returns their number.
    fn pulses(&self) -> usize {
        std::iter::from_fn(|| self.raw.recv(&mut [0; 100]).ok()).count()
    }

    /// Returns `true` if a motor packet arrives before `end`.
    fn motors_until(&self, end: Instant) -> bool {
        let left = end.saturating_duration_since(Instant::now()).max(Duration::from_millis(1));
        self.motors.set_read_timeout(Some(left)).unwrap();
        let came = match self.motors.recv(&mut [0; 100]) {
            // If this test itself was held up, the packet may have been sent after `end`.
            Ok(_) => Instant::now() < end,
            Err(error) => {
                assert!(matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut), "{error}");
                false
            }
        };
        self.motors.set_read_timeout(Some(PATIENCE)).unwrap();
        came
    }

    /// Reads all packets that have arrived, and gets into step with the drop-in.
    fn settle(&mut self) {
        self.motors.set_nonblocking(true).unwrap();
        for _ in 0..50 {
            self.send();
            std::thread::sleep(Duration::from_millis(2));
            while self.motors.recv(&mut [0; 100]).is_ok() {}
        }
        self.motors.set_nonblocking(false).unwrap();
        // A drop-in that was late has caught up after some steps, and its late answers are here.
        (0..50).for_each(|_| self.step());
        std::thread::sleep(Duration::from_millis(20));
        self.motors.set_nonblocking(true).unwrap();
        while self.motors.recv(&mut [0; 100]).is_ok() {}
        self.pulses();
        self.motors.set_nonblocking(false).unwrap();
    }

    /// Returns the drop-in's own attitude: roll and pitch in tenths of a degree, heading in degrees.
    fn attitude(&self) -> [i16; 3] {
        let mut client = TcpStream::connect(self.sitl.tcp).unwrap();
        client.set_read_timeout(Some(PATIENCE)).unwrap();
        let answer = msp::ask(&mut client, 108, &[]).unwrap();
        [0, 2, 4].map(|at| i16::from_le_bytes([answer[at], answer[at + 1]]))
    }
}

#[test]
fn every_state_is_answered_by_one_packet_on_each_port_and_nothing_more() {
    let mut link = Link::open();
    let deadline = Instant::now() + PATIENCE;
    for round in 0..10 {
        while !link.is_answered_once() {
            assert!(Instant::now() < deadline, "round {round}");
        }
    }
}

#[test]
fn the_first_state_after_a_pause_is_not_looked_at() {
    let mut link = Link::open();
    link.settle();
    let level = link.attitude();
    std::thread::sleep(Duration::from_millis(600));
    link.pulses();
    let mut rolled = link.state();
    // 90° to the right: (z, y, x, w) of the quaternion that turns about the nose first.
    for (field, value) in [(7, 0.5), (8, 0.5), (9, 0.5), (10, 0.5_f64)] {
        rolled[8 * field..8 * field + 8].copy_from_slice(&value.to_le_bytes());
    }
    link.motors.send_to(&rolled, link.sitl.fdm).unwrap();
    assert_eq!(link.attitude(), level);
    // A second packet with the same attitude is used.
    rolled[..8].copy_from_slice(&(f64::from(link.steps) * 1e-3 + 1e-3).to_le_bytes());
    link.motors.send_to(&rolled, link.sitl.fdm).unwrap();
    let end = Instant::now() + PATIENCE;
    while (link.attitude()[0] - 900).abs() > 20 {
        assert!(Instant::now() < end, "{:?}", link.attitude());
    }
}

#[test]
fn until_a_simulator_speaks_the_same_motors_are_sent_again_and_nobody_there_is_no_error() {
    let mut link = Link::open();
    let receive = |socket: &UdpSocket| {
        let mut packet = [0; 100];
        let size = socket.recv(&mut packet).expect("motors");
        packet[..size].to_vec()
    };
    let first = receive(&link.motors);
    assert_eq!(first.len(), 16);
    assert!((0..4).all(|_| receive(&link.motors) == first));
    // The simulator's port is closed for a while.
    let place = link.motors.local_addr().unwrap();
    link.motors = UdpSocket::bind("127.0.0.1:0").unwrap();
    std::thread::sleep(Duration::from_millis(1200));
    link.motors = UdpSocket::bind(place).unwrap();
    link.motors.set_read_timeout(Some(PATIENCE)).unwrap();
    assert!((0..2).all(|_| receive(&link.motors) == first));
    let said = link.sitl.program.seen();
    assert!(said.iter().all(|line| !line.to_lowercase().contains("error")), "{said:#?}");
}
