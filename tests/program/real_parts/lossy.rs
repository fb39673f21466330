//! A link to an executable that loses a tenth of the packets, both ways.

use std::net::{SocketAddr, UdpSocket};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU16, AtomicU64, Ordering};
use std::time::Duration;

/// Carries states to the executable and motors back, until it is dropped.
pub(crate) struct LossyLink {
    fdm: u16,
    motors: u16,
    state: Arc<State>,
}

#[derive(Default)]
struct State {
    lost: AtomicU64,
    to: AtomicU16,
    stop: AtomicBool,
}

impl LossyLink {
    /// Opens a link that forwards motors to this port.
    pub(crate) fn new(to: u16) -> Self {
        let socket = || {
            let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
            socket.set_read_timeout(Some(Duration::from_millis(50))).unwrap();
            socket
        };
        let (fdm, motors, state) = (socket(), socket(), Arc::new(State::default()));
        let port = |socket: &UdpSocket| socket.local_addr().unwrap().port();
        let link = Self { fdm: port(&fdm), motors: port(&motors), state: Arc::clone(&state) };
        let forward = Arc::clone(&state);
        std::thread::spawn(move || {
            carry(&fdm, &forward, 5, |state| state.to.load(Ordering::Relaxed));
        });
        std::thread::spawn(move || carry(&motors, &state, 11, |_| to));
        link
    }

    /// Forwards states to this port from now on.
    pub(crate) fn leads_to(&self, fdm: u16) {
        self.state.to.store(fdm, Ordering::Relaxed);
    }

    /// Returns the port to which the program sends states.
    pub(crate) fn fdm_port(&self) -> u16 {
        self.fdm
    }

    /// Returns the port to which the executable sends motors.
    pub(crate) fn motors_port(&self) -> u16 {
        self.motors
    }

    /// Returns the number of lost packets.
    pub(crate) fn lost(&self) -> u64 {
        self.state.lost.load(Ordering::Relaxed)
    }
}

impl Drop for LossyLink {
    fn drop(&mut self) {
        self.state.stop.store(true, Ordering::Relaxed);
    }
}

fn carry(socket: &UdpSocket, state: &State, seed: u64, to: impl Fn(&State) -> u16) {
    let (mut buffer, mut number) = ([0; 512], seed);
    while !state.stop.load(Ordering::Relaxed) {
        let Ok(size) = socket.recv(&mut buffer) else { continue };
        number = number.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        if (number >> 33).is_multiple_of(10) {
            state.lost.fetch_add(1, Ordering::Relaxed);
        } else {
            // The receiver may not be running.
            drop(socket.send_to(&buffer[..size], SocketAddr::from(([127, 0, 0, 1], to(state)))));
        }
    }
}
