//! The sockets beside a SITL executable: states and RC go to it, motors come from it.

use std::io;
use std::net::{IpAddr, SocketAddr, UdpSocket};
use std::time::{Duration, Instant};

use super::endpoint_stats::EndpointStats;
use super::proto::rc;
use super::proto::sitl_feed::{FeedConfig, FeedState, SitlFeed};
use crate::signals::fdm::Dialect;
use crate::signals::{MotorCommand, RcFrame, SensorFrame};
use crate::telemetry::{EndpointKind, EndpointState, EndpointStatus};

/// Longer than any motor packet.
const BUFFER: usize = 128;
/// Most packets that are taken from a socket in one go.
const QUEUED_MAX: usize = 4096;
/// Between two frames of the transmitter.
const RC_PERIOD: Duration = Duration::from_millis(20);
/// The link of the transmitter was up where its newest frame is no older, µs.
const RC_IS_UP_US: u64 = 60_000;
/// After its first motor packet an executable is certainly ready.
const BOOT: Duration = Duration::from_millis(500);

/// Where a SITL executable listens, and where it sends to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SitlPorts {
    pub ip: IpAddr,
    /// Motor pulses come to this port.
    pub raw: u16,
    /// Motor values come to this port.
    pub motors: u16,
    /// It takes states here.
    pub fdm: u16,
    /// It takes RC here.
    pub rc: u16,
}

/// A port that its motors are to come to is not free.
#[derive(Debug, thiserror::Error)]
#[error(
    "cannot take the motors of the firmware at UDP {address}: {error}; end what holds the port (a simulator such as Gazebo, \
     another betadeck), or name others with --udp-ports"
)]
pub struct MotorsInError {
    address: SocketAddr,
    error: io::Error,
}

/// The link to a SITL executable.
#[derive(Debug)]
pub struct SitlPeer {
    feed: SitlFeed,
    motors: UdpSocket,
    /// Bound so that nobody else's is taken for it; its pulses say what the values say.
    raw: UdpSocket,
    fdm: SocketAddr,
    rc: SocketAddr,
    started: Instant,
    /// It is up: states that come while it boots may crash it, or leave it deaf.
    is_up: bool,
    /// When its first motor packet came, which it sends shortly before it is ready.
    boots_since: Option<Instant>,
    /// The newest frame of the transmitter.
    newest_rc: Option<SentRc>,
    stats: EndpointStats,
}

/// A frame of the transmitter, when it was measured, and when it was sent last.
#[derive(Debug, Clone, Copy)]
struct SentRc {
    frame: RcFrame,
    measured: Instant,
    sent: Instant,
}

impl SitlPeer {
    /// Sockets for an executable, which gets nothing before [`Self::came_up`] tells that it has booted, or its first motor
    /// packet of half a second ago does.
    ///
    /// # Errors
    /// When a port for motors is not free.
    pub fn open(config: FeedConfig, ports: SitlPorts, now: Instant) -> Result<Self, MotorsInError> {
        Ok(Self {
            feed: SitlFeed::new(config),
            motors: bind(SocketAddr::new(ports.ip, ports.motors))?,
            raw: bind(SocketAddr::new(ports.ip, ports.raw))?,
            fdm: SocketAddr::new(ports.ip, ports.fdm),
            rc: SocketAddr::new(ports.ip, ports.rc),
            started: now,
            is_up: false,
            boots_since: None,
            newest_rc: None,
            stats: EndpointStats::new(now),
        })
    }

    /// The executable ended, or is about to: nothing is sent before it has booted again.
    pub fn went_down(&mut self) {
        // What it sent last is no sign of the next one's boot.
        discard(&self.motors);
        discard(&self.raw);
        self.feed.restart();
        self.is_up = false;
        self.boots_since = None;
    }

    /// The executable has booted.
    pub fn came_up(&mut self) {
        if !self.is_up {
            self.is_up = true;
            // The motors of its boot answered nothing.
            self.feed.restart();
        }
    }

    /// Sends what the sensors measured. Without an executable it is lost.
    pub fn send_state(&mut self, frame: &SensorFrame, now: Instant) {
        if self.boots_since.is_some_and(|since| now.saturating_duration_since(since) >= BOOT) {
            self.came_up();
        }
        self.feed.sense(frame);
        if self.is_up {
            let packet = self.feed.packet(self.micros(now));
            self.send(&packet.to_bytes(), self.fdm);
            self.feed.sent(self.micros(now));
        }
    }

    /// Takes in what the sensors measured in a step whose state is not sent, for a later one is.
    pub fn pass_over(&mut self, frame: &SensorFrame) {
        self.feed.sense(frame);
    }

    /// Sends a frame of the transmitter.
    pub fn send_rc(&mut self, frame: &RcFrame, now: Instant) {
        self.newest_rc = Some(SentRc { frame: *frame, measured: now, sent: now });
        self.send_rc_frame(frame, now);
    }

    /// While the craft waits, its transmitter does so too: its newest frame is sent again in the rhythm of RC, or the executable
    /// takes the link for lost as soon as it goes on.
    pub fn repeat_rc(&mut self, now: Instant) {
        let Some(SentRc { frame, measured, sent }) = self.newest_rc else { return };
        let Some(since_us) =
            self.feed.unanswered_since_us().filter(|_| self.feed.is_held_up(self.micros(now)))
        else {
            return;
        };
        // A link that was cut before stays so.
        let was_up = self.micros(measured) + RC_IS_UP_US >= since_us;
        if was_up && now.saturating_duration_since(sent) >= RC_PERIOD {
            self.newest_rc = Some(SentRc { frame, measured, sent: now });
            self.send_rc_frame(&frame, now);
        }
    }

    fn send_rc_frame(&self, frame: &RcFrame, now: Instant) {
        let stamp_s = self.micros(now) as f64 * 1e-6;
        self.send(&rc::encode(stamp_s, frame), self.rc);
    }

    /// The newest motor command that has come since, the older ones read and dropped.
    pub fn take_motors(&mut self, now: Instant) -> Option<MotorCommand> {
        let now_us = self.micros(now);
        let mut buffer = [0; BUFFER];
        let mut newest = None;
        for _ in 0..QUEUED_MAX {
            let size = match self.motors.recv(&mut buffer) {
                Ok(size) => size,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(_) => break,
            };
            self.stats.received(size);
            match self.feed.answered(&buffer[..size], now_us) {
                Some(motors) => {
                    self.stats.packet(now);
                    self.boots_since.get_or_insert(now);
                    newest = Some(motors);
                }
                None => self.stats.wrong_size(),
            }
        }
        discard(&self.raw);
        newest
    }

    /// Whether the executable answers.
    pub fn state(&self, now: Instant) -> FeedState {
        self.feed.state(self.micros(now))
    }

    /// Whether the craft is to wait for it: see [`SitlFeed::waits`].
    pub fn waits(&self, now: Instant) -> bool {
        self.feed.waits(self.micros(now))
    }

    /// What its packets mean.
    pub fn dialect(&self) -> Dialect {
        self.feed.dialect()
    }

    /// Its line among the endpoints.
    pub fn status(&self, now: Instant) -> EndpointStatus {
        EndpointStatus {
            kind: EndpointKind::Motors,
            address: self.motors.local_addr().map_or_else(|_| String::new(), |address| address.to_string()),
            state: EndpointState::Packets(self.stats.packet_stats(now)),
        }
    }

    fn send(&self, datagram: &[u8], to: SocketAddr) {
        match self.motors.send_to(datagram, to) {
            Ok(size) => self.stats.sent(size),
            // Nobody listens yet, or not any more: the other side's silence tells that.
            Err(_) => self.stats.error(),
        }
    }

    fn micros(&self, now: Instant) -> u64 {
        now.saturating_duration_since(self.started).as_micros() as u64
    }
}

/// Drops what waits in a socket.
fn discard(socket: &UdpSocket) {
    let mut buffer = [0; BUFFER];
    for _ in 0..QUEUED_MAX {
        if socket.recv(&mut buffer).is_err() {
            break;
        }
    }
}

fn bind(address: SocketAddr) -> Result<UdpSocket, MotorsInError> {
    let socket = UdpSocket::bind(address).and_then(|socket| {
        // The flight waits for nobody.
        socket.set_nonblocking(true)?;
        Ok(socket)
    });
    socket.map_err(|error| MotorsInError { address, error })
}
