//! Programs that send RC: the usual script over UDP, and a program that uses MSP.

use std::net::{SocketAddr, TcpStream, UdpSocket};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use super::msp;
use super::program::PATIENCE;

/// A script in a thread, until it is ended or dropped.
pub(crate) struct Script {
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Script {
    /// Arms for 2 s, raises the throttle for 4 s, switches the autopilot on and keeps sending, 50 times a
    /// second. The throttle is `low_us` while arming. A `patient` script sends its arm switch as off for 1 s
    /// before.
    fn run(patient: bool, low_us: u16, mut send: impl FnMut(&[u16; 16]) + Send + 'static) -> Self {
        let stop = Arc::new(AtomicBool::new(false));
        let stopped = Arc::clone(&stop);
        let thread = std::thread::spawn(move || {
            let mut channels = [1500; 16];
            channels[2] = low_us;
            let mut beats = |channels: &[u16; 16], count: u32| {
                for _ in 0..count {
                    if stopped.load(Ordering::Relaxed) {
                        return false;
                    }
                    send(channels);
                    std::thread::sleep(Duration::from_millis(20));
                }
                true
            };
            if patient {
                channels[4] = 1000;
                beats(&channels, 50);
            }
            channels[4] = 2000;
            beats(&channels, 100);
            channels[2] = 1500;
            beats(&channels, 200);
            channels[5] = 2000;
            while beats(&channels, 1) {}
        });
        Self { stop, thread: Some(thread) }
    }

    /// Starts the usual script: packets of a time stamp and sixteen channels.
    pub(crate) fn udp(door: SocketAddr) -> Self {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        Self::run(false, 1100, move |channels| {
            let stamp_s = SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_secs_f64();
            let words = channels.iter().flat_map(|channel| channel.to_le_bytes());
            let packet: Vec<u8> = stamp_s.to_le_bytes().into_iter().chain(words).collect();
            assert_eq!(packet.len(), 40);
            socket.send_to(&packet, door).unwrap();
        })
    }

    /// Sends SET_RAW_RC over TCP. Arming by MSP has strict rules: the switch must be off and the throttle low
    /// before.
    pub(crate) fn msp(door: SocketAddr) -> Self {
        let mut stream = TcpStream::connect(door).unwrap();
        stream.set_nodelay(true).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        Self::run(true, 1000, move |channels| {
            let payload: Vec<u8> = channels.iter().flat_map(|channel| channel.to_le_bytes()).collect();
            assert_eq!(msp::ask(&mut stream, 200, &payload), Some(Vec::new()));
        })
    }

    /// Stops sending.
    pub(crate) fn end(mut self) {
        self.stop.store(true, Ordering::Relaxed);
        self.thread.take().unwrap().join().unwrap();
    }
}

impl Drop for Script {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}
