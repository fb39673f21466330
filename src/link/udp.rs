//! The UDP doors: RC and simulator states in, motors out.

use std::io;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, UdpSocket as StdUdpSocket};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use tokio::io::Interest;
use tokio::net::UdpSocket;
use tokio::sync::mpsc;
use tokio_util::sync::CancellationToken;

use super::endpoint_stats::EndpointStats;
use super::proto::{fdm, rc, servo};
use super::request::Request;
use crate::signals::PerMotor;

/// The kind of datagrams that a UDP door accepts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Datagrams {
    Rc,
    Fdm,
}

/// A size above that of any accepted datagram.
const BUFFER: usize = 2048;
/// The maximum number of datagrams read from a socket at once.
const QUEUED_MAX: usize = 4096;

/// A socket whose datagrams become requests. Both the task that waits for them and the session may empty it.
#[derive(Debug)]
pub(super) struct DatagramPort {
    socket: UdpSocket,
    /// The same socket, read without waiting. It stays locked until the datagram is among the requests.
    queue: Mutex<StdUdpSocket>,
    datagrams: Datagrams,
    requests: mpsc::Sender<Request>,
    stats: Arc<EndpointStats>,
}

impl DatagramPort {
    /// Binds a port at this address. Returns the port and its actual address.
    pub(super) fn bind(
        address: SocketAddr,
        datagrams: Datagrams,
        requests: mpsc::Sender<Request>,
        stats: Arc<EndpointStats>,
    ) -> io::Result<(Self, SocketAddr)> {
        let queue = StdUdpSocket::bind(address)?;
        queue.set_nonblocking(true)?;
        let socket = UdpSocket::from_std(queue.try_clone()?)?;
        let place = queue.local_addr()?;
        Ok((Self { socket, queue: Mutex::new(queue), datagrams, requests, stats }, place))
    }

    /// Passes datagrams to the session until the doors close.
    pub(super) async fn receive(&self, shutdown: CancellationToken) {
        loop {
            tokio::select! {
                () = shutdown.cancelled() => return,
                // Fails when the runtime ends.
                ready = self.socket.readable() => if ready.is_err() { return },
            }
            let passed_on = self.socket.try_io(Interest::READABLE, || self.pass_one_on());
            if passed_on.is_err_and(|error| error.kind() != io::ErrorKind::WouldBlock) {
                self.stats.error();
            }
        }
    }

    /// Passes on all datagrams that have arrived by now, including those that have not woken the task yet.
    pub(super) fn pass_on_queued(&self) {
        for _ in 0..QUEUED_MAX {
            match self.pass_one_on() {
                Ok(()) => {}
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => return,
                Err(_) => self.stats.error(),
            }
        }
    }

    /// Passes on a datagram. Never waits for the session: while its queue is full, datagrams are dropped and
    /// counted as errors.
    #[allow(clippy::disallowed_methods, reason = "the age of RC counts in wall time from its arrival")]
    fn pass_one_on(&self) -> io::Result<()> {
        let mut buffer = [0; BUFFER];
        // Held until the datagram is among the requests, so that none is in between when the other side finds
        // the socket empty.
        let queue = self.queue.lock().unwrap_or_else(PoisonError::into_inner);
        let (size, from) = queue.recv_from(&mut buffer)?;
        let at = Instant::now();
        self.stats.received(size);
        let datagram = &buffer[..size];
        let request = match self.datagrams {
            Datagrams::Rc => rc::decode(datagram).map(|(stamp_s, frame)| Request::Rc { stamp_s, frame, at }),
            Datagrams::Fdm => (size >= fdm::SIZE).then(|| {
                // The size identifies the dialect.
                let datagram = datagram[..size.min(fdm::GZ_PLUGIN_SIZE + 1)].to_vec();
                Request::Fdm { datagram, from, at }
            }),
        };
        match request {
            Some(request) => {
                self.stats.packet(at);
                if self.requests.try_send(request).is_err() {
                    self.stats.error();
                }
            }
            None => self.stats.wrong_size(),
        }
        Ok(())
    }
}

/// The states of an external simulator on their way to the session.
#[derive(Debug, Clone)]
pub struct StateQueue(pub(super) Arc<DatagramPort>);

impl StateQueue {
    /// Turns everything that has arrived by now into requests.
    pub(super) fn pass_on(&self) {
        self.0.pass_on_queued();
    }
}

/// The port that sends motor values: to the simulator's socket for normalised values, and to the one for
/// pulses.
///
/// Nobody needs to listen there. The socket for the simulator is connected, so that the system reports when
/// nobody does.
#[derive(Debug)]
pub struct MotorPort {
    servo: StdUdpSocket,
    raw: StdUdpSocket,
}

/// The result of sending a datagram.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sent {
    /// It is on its way.
    Sent,
    Refused,
}

impl MotorPort {
    /// Opens a port that sends to these addresses. It binds neither of them.
    pub fn open(servo: SocketAddr, raw: SocketAddr) -> io::Result<Self> {
        Ok(Self { servo: connected(servo)?, raw: connected(raw)? })
    }

    /// Returns the address to which the normalised values are sent.
    pub fn address(&self) -> Option<SocketAddr> {
        self.servo.peer_addr().ok()
    }

    /// Sends the normalised values of four motor pulses, µs.
    pub fn send_servo(&self, pulses_us: PerMotor<f32>) -> Sent {
        let datagram = servo::encode(pulses_us);
        // A pending error belongs to an earlier datagram.
        let earlier_refused = self.take_refusal();
        let sent = self.servo.send(&datagram);
        // On this machine a refusal is known at once; from other machines it arrives with a later datagram.
        if self.take_refusal() || earlier_refused || sent.is_err() { Sent::Refused } else { Sent::Sent }
    }

    /// Sends motor pulses, µs. A receiver is optional.
    pub fn send_raw(&self, pulses_us: PerMotor<f32>) {
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
