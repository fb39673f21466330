//! The memory of the complete program while clients of every door send without end and never read. It must
//! keep the promise of `docs/links.md`.
#![cfg(target_os = "linux")]

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream, UdpSocket};
use std::time::Duration;

use super::msp;
use super::program::{PATIENCE, Serve, Sitl};

/// The most bytes that a client sends.
const FLOOD: usize = 16 << 20;
/// The number of clients of each kind.
const CLIENTS: usize = 4;
/// The limit of the memory for all clients together, KiB. It is a fraction of the bytes that one of them
/// sends.
const BOUND_KIB: u64 = 16 * 1024;

/// Returns the peak memory of a process, KiB.
pub(super) fn peak_kib(process: u32) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).unwrap();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap();
    peak.trim().trim_end_matches(" kB").parse().unwrap()
}

fn connect(door: SocketAddr) -> TcpStream {
    let stream = TcpStream::connect(door).unwrap();
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    stream
}

/// Sends this over and over, until the door takes no more.
fn flood(stream: &mut TcpStream, piece: &[u8]) {
    stream.set_write_timeout(Some(Duration::from_millis(500))).unwrap();
    let pieces = piece.repeat((1_usize << 16).div_ceil(piece.len()));
    let mut sent = 0;
    while sent < FLOOD && stream.write_all(&pieces).is_ok() {
        sent += pieces.len();
    }
}

fn websocket(door: SocketAddr) -> TcpStream {
    let mut stream = connect(door);
    let handshake = format!(
        "GET / HTTP/1.1\r\nHost: {door}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n\
         Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
    );
    stream.write_all(handshake.as_bytes()).unwrap();
    let mut answer = [0; 12];
    stream.read_exact(&mut answer).unwrap();
    assert_eq!(&answer, b"HTTP/1.1 101");
    stream
}

/// Returns a client's frame, masked with zeros.
fn frame(first: u8, payload: &[u8]) -> Vec<u8> {
    let length: Vec<u8> = match payload.len() {
        short @ 0..126 => vec![0x80 | short as u8],
        long => [[0x80 | 126].as_slice(), &(long as u16).to_be_bytes()].concat(),
    };
    [&[first], length.as_slice(), &[0; 4], payload].concat()
}

/// Returns clients that have sent all that their door takes and have read nothing.
fn deaf_clients(to_websocket: SocketAddr, to_tcp: SocketAddr, questions: &[u8]) -> Vec<TcpStream> {
    let mut deaf = Vec::new();
    for piece in [
        frame(0x89, &[b'x'; 125]),
        frame(0x82, questions),
        [frame(0x89, b"x"), frame(0x82, questions)].concat(),
        // A message that never ends.
        frame(0x00, &[b'x'; 60_000]),
    ] {
        let mut stream = websocket(to_websocket);
        if piece[0] == 0 {
            // The beginning of that message.
            stream.write_all(&frame(0x02, b"x")).unwrap();
        }
        flood(&mut stream, &piece);
        deaf.push(stream);
    }
    // A handshake that never ends.
    let mut stream = connect(to_websocket);
    stream.write_all(b"GET / HTTP/1.1\r\nHost: localhost\r\nX: ").unwrap();
    flood(&mut stream, b"x");
    deaf.push(stream);
    for (start, piece) in [
        (b"".as_slice(), questions),
        (b"", b"x"),
        (b"$M<", b"\xff"),
        (b"\x02", b"dump all\n"),
        (b"\x02", b"\t"),
        (b"#", b"help\n"),
    ] {
        let mut stream = connect(to_tcp);
        stream.write_all(start).unwrap();
        flood(&mut stream, piece);
        deaf.push(stream);
    }
    deaf
}

#[test]
fn clients_that_send_without_end_and_never_read_cost_little_memory_and_are_closed_with_a_notice() {
    let mut serve = Serve::start("1");
    let before = peak_kib(serve.id());
    let questions = msp::request(116, &[]).repeat(100);
    let mut deaf: Vec<TcpStream> = std::thread::scope(|scope| {
        let flooding: Vec<_> = (0..CLIENTS)
            .map(|_| scope.spawn(|| deaf_clients(serve.websocket, serve.tcp, &questions)))
            .collect();
        flooding.into_iter().flat_map(|clients| clients.join().unwrap()).collect()
    });
    // More clients than the door serves.
    deaf.extend((0..100).map(|_| connect(serve.tcp)));
    let rc = UdpSocket::bind("127.0.0.1:0").unwrap();
    for datagram in [[0; 40].as_slice(), &[0; 1400]] {
        (0..50_000).for_each(|_| drop(rc.send_to(datagram, serve.rc)));
    }
    let cost = peak_kib(serve.id()) - before;
    assert!(cost < BOUND_KIB, "{cost} KiB");
    // The notices come in any order.
    for _ in 0..2 {
        serve.wait("notice of a deaf client", |event| {
            event["text"].as_str().is_some_and(|text| text.contains("did not read its answers for 10 s"))
        });
    }
    let cost = peak_kib(serve.id()) - before;
    assert!(cost < BOUND_KIB, "{cost} KiB in the end");
}

#[test]
fn a_simulator_that_sends_without_end_costs_little_memory() {
    let [raw, motors] = [(); 2].map(|()| UdpSocket::bind("127.0.0.1:0").unwrap());
    let port = |socket: &UdpSocket| socket.local_addr().unwrap().port();
    let sitl = Sitl::start(port(&raw), port(&motors));
    let before = peak_kib(sitl.id());
    for datagram in [[0; 144].as_slice(), &[0; 1400]] {
        (0..100_000).for_each(|_| drop(raw.send_to(datagram, sitl.fdm)));
    }
    let cost = peak_kib(sitl.id()) - before;
    assert!(cost < BOUND_KIB, "{cost} KiB");
}
