//! The UDP doors: RC and simulator states in, motors out.

use std::io;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, UdpSocket as StdUdpSocket};
use std::sync::Arc;
use std::time::Instant;

use tokio::net::UdpSocket;

use super::client::SharedChannels;
use super::endpoint_stats::EndpointStats;
use super::proto::{fdm, rc, servo};
use super::request::Request;

/// What a UDP door takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Datagrams {
    Rc,
    Fdm,
}

/// More than any datagram that is looked at.
const BUFFER: usize = 2048;

/// Passes datagrams to the session until the doors close. The session is never waited for: what comes while its queue is
/// full is dropped and counted as an error.
#[allow(clippy::disallowed_methods, reason = "the age of RC counts in wall time from its arrival")]
pub(super) async fn receive(
    socket: UdpSocket,
    datagrams: Datagrams,
    channels: SharedChannels,
    stats: Arc<EndpointStats>,
) {
    let mut buffer = [0; BUFFER];
    loop {
        let received = tokio::select! {
            () = channels.shutdown.cancelled() => return,
            received = socket.recv_from(&mut buffer) => received,
        };
        let Ok((size, from)) = received else {
            stats.error();
            continue;
        };
        let at = Instant::now();
        stats.received(size);
        let datagram = &buffer[..size];
        let request = match datagrams {
            Datagrams::Rc => {
                rc::decode(datagram).map(|(stamp_s, frame)| Request::Rc { stamp_s, frame, from, at })
            }
            Datagrams::Fdm => (size >= fdm::SIZE).then(|| {
                // Its size tells the dialect.
                let datagram = datagram[..size.min(fdm::GZ_PLUGIN_SIZE + 1)].to_vec();
                Request::Fdm { datagram, from, at }
            }),
        };
        match request {
            Some(request) => {
                stats.packet(at);
                if channels.requests.try_send(request).is_err() {
                    stats.error();
                }
            }
            None => stats.wrong_size(),
        }
    }
}

/// Where motors are sent to: the simulator's socket for normalised values, and the one for pulses.
///
/// Nobody needs to listen there. The socket for the simulator is connected, so that the system tells when nobody does.
#[derive(Debug)]
pub struct MotorPort {
    servo: StdUdpSocket,
    raw: StdUdpSocket,
}

/// What became of a datagram.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sent {
    /// It is on its way.
    Sent,
    /// Nobody listens.
    Refused,
}

impl MotorPort {
    /// A port that sends to these addresses; it binds none of them.
    pub fn open(servo: SocketAddr, raw: SocketAddr) -> io::Result<Self> {
        Ok(Self { servo: connected(servo)?, raw: connected(raw)? })
    }

    /// Where the normalised values go.
    #[must_use]
    pub fn address(&self) -> Option<SocketAddr> {
        self.servo.peer_addr().ok()
    }

    /// Sends the normalised values of four motor pulses, µs.
    pub fn send_servo(&self, pulses_us: [f32; 4]) -> Sent {
        let datagram = servo::encode(pulses_us);
        // An error that is waiting here is that of an earlier datagram.
        let earlier_refused = self.take_refusal();
        let sent = self.servo.send(&datagram);
        // On this machine a refusal is known at once; from elsewhere with a later datagram.
        if self.take_refusal() || earlier_refused || sent.is_err() { Sent::Refused } else { Sent::Sent }
    }

    /// Sends motor pulses, µs. Nobody needs to take them.
    pub fn send_raw(&self, pulses_us: [f32; 4]) {
        let datagram = servo::encode_raw(pulses_us.len() as u16, &pulses_us);
        let _nobody_there = self.raw.send(&datagram);
        let _of_this_or_an_earlier = self.raw.take_error();
    }

    fn take_refusal(&self) -> bool {
        matches!(self.servo.take_error(), Ok(Some(_)) | Err(_))
    }
}

fn connected(to: SocketAddr) -> io::Result<StdUdpSocket> {
    let any = match to.ip() {
        IpAddr::V4(_) => IpAddr::V4(Ipv4Addr::UNSPECIFIED),
        IpAddr::V6(_) => IpAddr::V6(Ipv6Addr::UNSPECIFIED),
    };
    let socket = StdUdpSocket::bind((any, 0))?;
    socket.connect(to)?;
    // A full buffer must not hold up the flight.
    socket.set_nonblocking(true)?;
    Ok(socket)
}
