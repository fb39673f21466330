//! A simulator that follows the rules of Gazebo's plugin: each step reads one packet of motors, waits for it if there
//! is none, moves the craft and sends its state. The hand on the transmitter works by simulated time.

use std::net::{Ipv4Addr, UdpSocket};

use betadeck::link::conventions::Dialect;
use betadeck::link::proto::{rc, servo};
use betadeck::signals::RcFrame;

use crate::sitl_drive::child::NEVER;
use crate::sitl_drive::plant::Plant;
use crate::sitl_drive::square::Flown;

/// Interval of RC packets, ms.
const RC_MS: u64 = 20;
/// The time at which the transmitter switches ARM on, ms. By then the firmware has booted and has a fix.
const ARM_MS: u64 = 6000;
/// A motor value above this means that the craft is armed.
const IDLE: f32 = 0.03;
/// The longest time of a flight, ms. A flight that takes longer has gone wrong.
const MAX_MS: u64 = 400_000;

/// The state of the hand on the transmitter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Hand {
    /// Waits until the craft is ready.
    Waits,
    /// Holds ARM on until the motors turn.
    Arms,
    /// Has engaged the autopilot and watches.
    Watches,
    /// The craft has landed and disarmed by itself.
    Done,
}

/// The simulator, its sockets and the transmitter.
pub(crate) struct Simulator {
    /// The simulated craft.
    pub(crate) plant: Plant,
    /// The record of the flight.
    pub(crate) flown: Flown,
    /// The hand on the transmitter.
    pub(crate) hand: Hand,
    /// The share of the packets in both directions that is lost, 0…1.
    pub(crate) loss: f64,
    dice: u64,
    motors_in: UdpSocket,
    raw_in: UdpSocket,
    out: UdpSocket,
    fdm_port: u16,
    rc_port: u16,
    motors: [f32; 4],
    next_rc_ms: u64,
}

impl Simulator {
    /// Returns a simulator with open sockets whose firmware is not known yet.
    pub(crate) fn new(dialect: Dialect) -> Self {
        let socket = || {
            let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).expect("a socket");
            socket.set_read_timeout(Some(NEVER)).expect("a timeout");
            socket
        };
        let plant = Plant::new(dialect);
        Self {
            flown: Flown::new(plant.world.local_frame()),
            plant,
            hand: Hand::Waits,
            loss: 0.0,
            dice: 1,
            motors_in: socket(),
            raw_in: socket(),
            out: socket(),
            fdm_port: 0,
            rc_port: 0,
            motors: [0.0; 4],
            next_rc_ms: 0,
        }
    }

    /// Returns the ports where it reads motors: normalised and raw.
    pub(crate) fn ports(&self) -> (u16, u16) {
        let port = |socket: &UdpSocket| socket.local_addr().expect("an address").port();
        (port(&self.motors_in), port(&self.raw_in))
    }

    /// Connects to the firmware at these doors, and reads its first packet of motors.
    pub(crate) fn connect(&mut self, (fdm_port, rc_port): (u16, u16)) {
        (self.fdm_port, self.rc_port) = (fdm_port, rc_port);
        self.read_motors();
    }

    /// Moves on by `ms` with the newest motors, sends the state, and waits for the answer. It does not wait for a lost
    /// packet: the craft flies on with the last motors.
    pub(crate) fn step(&mut self, ms: u64) {
        self.advance(ms);
        if self.is_lost() {
            return;
        }
        self.send_state();
        let before = self.motors;
        self.read_motors();
        if self.is_lost() {
            self.motors = before;
        }
    }

    /// Moves the world on without sending its state.
    pub(crate) fn advance(&mut self, ms: u64) {
        self.plant.advance(ms, self.motors);
        assert_eq!(self.plant.crash(), None, "at {} ms: {:?}", self.plant.time_ms(), self.flown);
        assert!(self.plant.time_ms() < MAX_MS, "{:?}: {:?}", self.hand, self.flown);
        self.flown.look(self.plant.world.truth().pos_enu.xy(), self.plant.height_m());
        self.move_hand();
    }

    /// Flies on in steps of `ms` until the craft has landed and disarmed.
    pub(crate) fn fly(&mut self, ms: u64) {
        while self.hand != Hand::Done {
            self.step(ms);
        }
        self.flown.impact_mps = self.plant.impact_mps();
    }

    /// Flies on in steps of `ms` until the craft has reached this height.
    pub(crate) fn fly_up_to(&mut self, ms: u64, height_m: f64) {
        while self.plant.height_m() < height_m {
            self.step(ms);
        }
    }

    /// Sends a datagram to the door for states.
    pub(crate) fn send(&self, datagram: &[u8]) {
        self.out.send_to(datagram, (Ipv4Addr::LOCALHOST, self.fdm_port)).expect("it is sent");
    }

    /// Sends the state of the craft.
    pub(crate) fn send_state(&self) {
        self.send(&self.plant.packet());
    }

    /// Reads one packet of motors, waiting for it.
    pub(crate) fn read_motors(&mut self) {
        let mut bytes = [0; 64];
        let size = self.motors_in.recv(&mut bytes).expect("motors, long before");
        assert_eq!(size, servo::SIZE);
        self.motors = servo::decode(&bytes[..size]).expect("motors");
    }

    /// Returns the newest motors.
    pub(crate) fn motors(&self) -> [f32; 4] {
        self.motors
    }

    /// Restarts the transmitter's clock for a new world.
    pub(crate) fn restart_rc(&mut self) {
        self.next_rc_ms = 0;
    }

    /// Ends the simulator: closes its sockets and drops its world. Returns the ports to start it again.
    pub(crate) fn end(self) -> Ended {
        let (motors, raw) = self.ports();
        Ended { motors, raw, doors: (self.fdm_port, self.rc_port) }
    }

    /// Returns `true` if a packet gets lost. The same packets get lost in every run.
    fn is_lost(&mut self) -> bool {
        self.dice = self.dice.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.dice >> 33) as f64 / f64::from(1_u32 << 31)) < self.loss
    }

    fn move_hand(&mut self) {
        let turning = self.motors.iter().all(|motor| *motor > IDLE);
        let still = self.motors.iter().all(|motor| *motor == 0.0);
        let time_ms = self.plant.time_ms();
        self.hand = match self.hand {
            Hand::Waits if time_ms >= ARM_MS => Hand::Arms,
            Hand::Arms if turning => Hand::Watches,
            Hand::Watches if still => Hand::Done,
            same => same,
        };
        if self.plant.time_ms() >= self.next_rc_ms {
            self.next_rc_ms = self.plant.time_ms() + RC_MS;
            self.send_rc();
        }
    }

    fn send_rc(&mut self) {
        let mut frame = RcFrame::SAFE;
        match self.hand {
            Hand::Waits | Hand::Done => {}
            Hand::Arms => frame.channels[4] = 2000,
            Hand::Watches => {
                frame.channels[2] = 1500;
                frame.channels[4..7].fill(2000);
            }
        }
        if !self.is_lost() {
            let datagram = rc::encode(0.0, &frame);
            self.out.send_to(&datagram, (Ipv4Addr::LOCALHOST, self.rc_port)).expect("it is sent");
        }
    }
}

/// The ports of a simulator that has ended.
pub(crate) struct Ended {
    motors: u16,
    raw: u16,
    doors: (u16, u16),
}

impl Ended {
    /// Starts the simulator again: the craft is at home and time begins at zero. It reads motors as soon as they
    /// arrive.
    pub(crate) fn start(self, dialect: Dialect) -> Simulator {
        let again = |port| {
            // A child that another test starts at this moment holds the closed socket until it runs.
            let bind =
                || UdpSocket::bind((Ipv4Addr::LOCALHOST, port)).map_err(|_| std::thread::yield_now()).ok();
            let socket = (0..100_000).find_map(|_| bind()).expect("the port of before");
            socket.set_read_timeout(Some(NEVER)).expect("a timeout");
            socket
        };
        let mut simulator = Simulator::new(dialect);
        (simulator.motors_in, simulator.raw_in) = (again(self.motors), again(self.raw));
        simulator.connect(self.doors);
        simulator
    }
}
