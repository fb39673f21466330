//! Ports for programs that open them later.

use std::net::{Ipv4Addr, TcpListener, UdpSocket};
use std::sync::atomic::{AtomicU16, Ordering};

/// The ports from which one is taken. They are below the range from which the system gives ports to sockets that name
/// none, so that no other socket takes a port between its choice and its use.
const FIRST: u16 = 10_000;
const COUNT: u16 = 20_000;

/// Returns a port that is free for UDP and TCP, another one at each call.
pub fn free_port() -> u16 {
    static CALLS: AtomicU16 = AtomicU16::new(0);
    // Programs that run side by side have neighbouring process IDs and begin far apart.
    let begin = (std::process::id().wrapping_mul(7919) % u32::from(COUNT)) as u16;
    (0..COUNT)
        .map(|_| FIRST + (begin + CALLS.fetch_add(1, Ordering::Relaxed) % COUNT) % COUNT)
        .find(|&port| {
            let here = (Ipv4Addr::LOCALHOST, port);
            UdpSocket::bind(here).is_ok() && TcpListener::bind(here).is_ok()
        })
        .expect("a free port")
}
