//! The sockets to a SITL executable: states and RC are sent to it, motor commands come from it.

use std::io;
use std::net::{IpAddr, SocketAddr, UdpSocket};
use std::time::{Duration, Instant};

use super::endpoint_stats::EndpointStats;
use super::proto::rc;
use super::proto::sitl_feed::{FeedConfig, FeedState, SitlFeed};
use crate::link::conventions::Dialect;
use crate::link::endpoint::{EndpointKind, EndpointState, EndpointStatus};
use crate::signals::{MotorCommand, RcFrame, SensorFrame};

/// A size above that of any motor packet.
const BUFFER: usize = 128;
/// The maximum number of packets read from a socket at once.
const QUEUED_MAX: usize = 4096;
/// The interval between two frames of the transmitter.
const RC_PERIOD: Duration = Duration::from_millis(20);
/// The greatest age at which the newest frame of the transmitter shows that its link was up, µs.
const RC_IS_UP_US: u64 = 60_000;
/// The time after its first motor packet after which an executable is certainly ready.
const BOOT: Duration = Duration::from_millis(500);

/// The ports at which a SITL executable receives, and those to which it sends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SitlPorts {
    pub ip: IpAddr,
    /// The executable sends motor pulses to this port.
    pub raw: u16,
    /// The executable sends motor values to this port.
    pub motors: u16,
    /// The executable receives states here.
    pub fdm: u16,
    /// The executable receives RC here.
    pub rc: u16,
}

/// A port for its motor packets is not free.
#[derive(Debug, thiserror::Error)]
#[error(
    "cannot receive the motors of the firmware at UDP {address}: {error}; stop the program that holds the port (a \
     simulator such as Gazebo, another betadeck), or name others with --udp-ports"
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
    /// Bound so that no other program takes the port. Its pulses repeat the motor values.
    raw: UdpSocket,
    fdm: SocketAddr,
    rc: SocketAddr,
    started: Instant,
    /// `true` once it is up. States that arrive while it boots may crash it or make it ignore all later ones.
    is_up: bool,
    /// The time of its first motor packet, which it sends shortly before it is ready.
    boots_since: Option<Instant>,
    /// The newest frame of the transmitter.
    newest_rc: Option<SentRc>,
    stats: EndpointStats,
}

/// A frame of the transmitter with the times of its measurement and of its last transmission.
#[derive(Debug, Clone, Copy)]
struct SentRc {
    frame: RcFrame,
    measured: Instant,
    sent: Instant,
}

impl SitlPeer {
    /// Opens the sockets for an executable. It gets nothing until it has booted: [`Self::came_up`] reports
    /// that, or half a second has passed since its first motor packet.
    ///
    /// # Errors
    /// Returns an error if a port for motors is not free.
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

    /// Records that the executable has ended or is about to. Nothing is sent before it has booted again.
    pub fn went_down(&mut self) {
        // Its last packets are no sign that the next one has booted.
        discard(&self.motors);
        discard(&self.raw);
        self.feed.restart();
        self.is_up = false;
        self.boots_since = None;
    }

    /// Records that the executable has booted.
    pub fn came_up(&mut self) {
        if !self.is_up {
            self.is_up = true;
            // The motor packets of its boot were no answers.
            self.feed.restart();
        }
    }

    /// Sends the sensors' measurements. Without an executable they are lost.
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

    /// Stores the measurements of a step whose state is not sent because a later one is.
    pub fn pass_over(&mut self, frame: &SensorFrame) {
        self.feed.sense(frame);
    }

    /// Sends a frame of the transmitter.
    pub fn send_rc(&mut self, frame: &RcFrame, now: Instant) {
        self.newest_rc = Some(SentRc { frame: *frame, measured: now, sent: now });
        self.send_rc_frame(frame, now);
    }

    /// Sends the newest frame of the transmitter again at the rate of RC while the craft waits. Otherwise the
    /// executable would detect a lost link as soon as it continues.
    pub fn repeat_rc(&mut self, now: Instant) {
        let Some(SentRc { frame, measured, sent }) = self.newest_rc else { return };
        let Some(since_us) =
            self.feed.unanswered_since_us().filter(|_| self.feed.is_held_up(self.micros(now)))
        else {
            return;
        };
        // A link that was cut before stays cut.
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

    /// Returns the newest motor command since the last call. Older ones are read and dropped.
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

    /// Returns the state of the answers from the executable.
    pub fn state(&self, now: Instant) -> FeedState {
        self.feed.state(self.micros(now))
    }

    /// Returns `true` while the craft must wait for the executable, see [`SitlFeed::waits`].
    pub fn waits(&self, now: Instant) -> bool {
        self.feed.waits(self.micros(now))
    }

    /// Returns the dialect of its packets.
    pub fn dialect(&self) -> Dialect {
        self.feed.config().dialect
    }

    /// Returns its status as an endpoint.
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
            // Nobody listens yet or any more. The silence of the other side shows that.
            Err(_) => self.stats.error(),
        }
    }

    fn micros(&self, now: Instant) -> u64 {
        now.saturating_duration_since(self.started).as_micros() as u64
    }
}

/// Drops the packets that wait in a socket.
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
        // The flight must never wait for a socket.
        socket.set_nonblocking(true)?;
        Ok(socket)
    });
    socket.map_err(|error| MotorsInError { address, error })
}
