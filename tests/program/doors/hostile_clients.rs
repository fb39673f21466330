//! Clients that break the protocols while a craft flies.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream, UdpSocket};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use super::app::App;
use super::scripts::{PATIENT_FAILSAFE, SWITCHES, THERE_AND_DOWN, prepared, sees_the_flight};
use super::transmitter::Script;

/// The pause between attempts to connect.
const SOON: Duration = Duration::from_millis(50);

/// A generator of pseudo-random bytes.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> u8 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 56) as u8
    }

    fn bytes(&mut self, count: usize) -> Vec<u8> {
        (0..count).map(|_| self.next()).collect()
    }
}

fn connect(door: SocketAddr) -> TcpStream {
    let stream = TcpStream::connect(door).unwrap();
    stream.set_read_timeout(Some(SOON)).unwrap();
    stream.set_write_timeout(Some(SOON)).unwrap();
    stream
}

/// Sends a handshake from a stranger's web page and returns the answer.
fn strangers_handshake(door: SocketAddr) -> String {
    let mut stream = TcpStream::connect(door).unwrap();
    stream.set_read_timeout(Some(super::program::PATIENCE)).unwrap();
    let request = format!(
        "GET / HTTP/1.1\r\nHost: {door}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n\
         Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nOrigin: https://evil.example\r\n\r\n"
    );
    stream.write_all(request.as_bytes()).unwrap();
    let mut answer = String::new();
    let _ended = stream.read_to_string(&mut answer);
    answer
}

/// Returns `true` if the door answers 403 to a stranger's web page. It does so once it has room for one more
/// client.
fn refuses_strangers(door: SocketAddr) -> bool {
    let answers = std::iter::repeat_with(|| strangers_handshake(door)).take(1000);
    answers.inspect(|_| thread::sleep(SOON)).any(|answer| answer.starts_with("HTTP/1.1 403 "))
}

/// Misbehaves for one round. The other side may or may not accept it, so errors are ignored.
fn misbehave(round: u64, tcp: SocketAddr, websocket: SocketAddr, rc: SocketAddr) {
    let mut noise = Noise(round);
    let door = if round.is_multiple_of(2) { tcp } else { websocket };
    let mut stream = connect(door);
    match round % 8 {
        // Sends noise and disconnects with unread answers.
        0 | 1 => drop(stream.write_all(&noise.bytes(20_000))),
        // Sends a frame that never ends, or half a handshake.
        2 => drop(stream.write_all(b"$X<\x00\x01\x00\xff\x00half")),
        3 => drop(stream.write_all(b"GET / HTTP/1.1\r\nHost: x\r\nUpgrade: webso")),
        // Sends megabytes without a line end.
        4 => {
            let chunk = vec![b'x'; 1 << 16];
            for _ in 0..160 {
                if stream.write_all(&chunk).is_err() {
                    break;
                }
            }
        }
        // Sends handshakes from strangers' web pages.
        5 => assert!(refuses_strangers(websocket)),
        // Sends many requests and reads no answer.
        6 => {
            let questions = super::msp::request(116, &[]).repeat(4000);
            drop(stream.write_all(&questions));
        }
        // Sends over a websocket data that no real client sends.
        _ => {
            let mut app = App::open(websocket);
            drop(app.try_send(noise.bytes(5000)));
            drop(app.try_send(Vec::new()));
            drop(app.try_send(vec![0; 300_000]));
        }
    }
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    for size in [0, 1, 39, 8] {
        socket.send_to(&noise.bytes(size), rc).unwrap();
    }
}

#[test]
fn rude_clients_do_not_disturb_a_flight() {
    let mut serve = prepared("4", &[SWITCHES, PATIENT_FAILSAFE, THERE_AND_DOWN]);
    let (tcp, websocket, rc) = (serve.tcp, serve.websocket, serve.rc);
    let done = &AtomicBool::new(false);
    let script = Script::udp(rc);
    thread::scope(|scope| {
        let rude = scope.spawn(move || {
            let mut round = 0;
            while round < 16 || !done.load(Ordering::Relaxed) {
                misbehave(round, tcp, websocket, rc);
                round += 1;
                thread::sleep(Duration::from_millis(5));
            }
        });
        let _content_at_the_end = Content(done);
        sees_the_flight(&mut serve);
        done.store(true, Ordering::Relaxed);
        rude.join().unwrap();
    });
    script.end();
    App::connect(websocket).poll();
    let reported = serve.notices("--allow-origin https://evil.example");
    assert_eq!(reported, 1, "a stranger's page is reported once");
}

/// Stops the hostile clients when dropped, even if the flight failed.
struct Content<'a>(&'a AtomicBool);

impl Drop for Content<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}
