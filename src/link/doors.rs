//! Opens the doors, shows their state, closes them.

#![allow(clippy::disallowed_methods, reason = "the state of a door shows the age of its newest packet")]

use std::io;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};
use std::sync::Arc;
use std::time::{Duration, Instant};

use tokio::net::{TcpListener, UdpSocket};
use tokio::sync::{mpsc, watch};
use tokio_util::sync::CancellationToken;
use tokio_util::task::TaskTracker;

use super::client::Reception;
use super::endpoint_stats::EndpointStats;
use super::listener::{self, Kind};
use super::request::Request;
use super::udp::{self, Datagrams};
use crate::telemetry::{EndpointState, EndpointStatus};

/// How long the doors may take to close.
const CLOSING: Duration = Duration::from_secs(1);

/// Which doors to open, and where. Port 0 lets the system choose; `None` leaves a door closed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DoorsConfig {
    /// Address to listen on; `None` = 127.0.0.1, for TCP and websocket ::1 as well.
    pub listen: Option<IpAddr>,
    /// MSP and command line over TCP.
    pub tcp_port: Option<u16>,
    /// MSP and command line over a websocket.
    pub ws_port: Option<u16>,
    /// RC from scripts, UDP.
    pub rc_port: Option<u16>,
    /// States from a simulator, UDP.
    pub fdm_port: Option<u16>,
    /// Web pages that are served besides the usual ones.
    pub allow_origin: Vec<String>,
}

impl Default for DoorsConfig {
    /// The usual doors of a craft whose physics is inside.
    fn default() -> Self {
        Self {
            listen: None,
            tcp_port: Some(5761),
            ws_port: Some(6761),
            rc_port: Some(9004),
            fdm_port: None,
            allow_origin: Vec::new(),
        }
    }
}

/// A door.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DoorKind {
    /// MSP and command line over a websocket.
    WebSocket,
    /// MSP and command line over TCP.
    Tcp,
    /// States from a simulator.
    Fdm,
    /// RC from scripts.
    Rc,
}

impl DoorKind {
    /// Its short name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::WebSocket => "ws",
            Self::Tcp => "tcp",
            Self::Fdm => "udp fdm",
            Self::Rc => "udp rc",
        }
    }

    fn transport(self) -> &'static str {
        match self {
            Self::WebSocket | Self::Tcp => "TCP",
            Self::Fdm | Self::Rc => "UDP",
        }
    }

    /// The option that moves it.
    fn option(self) -> &'static str {
        match self {
            Self::WebSocket => "--ws-port",
            Self::Tcp => "--tcp-port",
            Self::Fdm | Self::Rc => "--udp-ports",
        }
    }
}

/// Why a door is closed.
#[derive(Debug, thiserror::Error)]
pub enum DoorError {
    /// Something else has the port.
    #[error(
        "{} port {port} is in use: stop the program that has it, or choose another with {} (0 = any free one)",
        .door.transport(), .door.option()
    )]
    Busy {
        /// The door.
        door: DoorKind,
        /// The port.
        port: u16,
    },
    /// The system refused for another reason.
    #[error("cannot listen on {address} ({}): {error}; see --listen and {}", .door.transport(), .door.option())]
    Refused {
        /// The door.
        door: DoorKind,
        /// Where it was to listen.
        address: SocketAddr,
        /// What the system says.
        error: io::Error,
    },
}

/// One door.
#[derive(Debug)]
struct Door {
    kind: DoorKind,
    /// Where it listens, or why it does not.
    place: Result<SocketAddr, DoorError>,
    stats: Arc<EndpointStats>,
}

/// The open doors.
#[derive(Debug)]
pub struct Doors {
    doors: Vec<Door>,
    shutdown: CancellationToken,
    tasks: TaskTracker,
    restarts: watch::Sender<u64>,
}

impl Doors {
    /// Opens the doors. One that cannot be opened says why in its view; the others work.
    pub async fn open(config: &DoorsConfig, requests: mpsc::Sender<Request>) -> (Self, Vec<EndpointStatus>) {
        let (restarts, restarted) = watch::channel(0);
        let mut doors = Self {
            doors: Vec::new(),
            shutdown: CancellationToken::new(),
            tasks: TaskTracker::new(),
            restarts,
        };
        let reception = Reception { requests, shutdown: doors.shutdown.clone(), restarts: restarted };
        if let Some(port) = config.ws_port {
            let kind =
                Kind::WebSocket { allow_origin: config.allow_origin.clone().into(), told: Arc::default() };
            doors.open_stream(DoorKind::WebSocket, config.listen, port, &kind, &reception).await;
        }
        if let Some(port) = config.tcp_port {
            doors.open_stream(DoorKind::Tcp, config.listen, port, &Kind::Tcp, &reception).await;
        }
        if let Some(port) = config.fdm_port {
            doors.open_datagrams(DoorKind::Fdm, config.listen, port, Datagrams::Fdm, &reception).await;
        }
        if let Some(port) = config.rc_port {
            doors.open_datagrams(DoorKind::Rc, config.listen, port, Datagrams::Rc, &reception).await;
        }
        let views = doors.views();
        (doors, views)
    }

    async fn open_stream(
        &mut self,
        door: DoorKind,
        listen: Option<IpAddr>,
        port: u16,
        kind: &Kind,
        reception: &Reception,
    ) {
        let stats = Arc::new(EndpointStats::new(Instant::now()));
        let address = SocketAddr::new(listen.unwrap_or(IpAddr::V4(Ipv4Addr::LOCALHOST)), port);
        let place = match bind_tcp(door, address).await {
            Ok((listener, place)) => {
                self.spawn_listener(listener, kind, reception, &stats);
                if listen.is_none() {
                    // A machine without IPv6 is no trouble.
                    let six = SocketAddr::new(IpAddr::V6(Ipv6Addr::LOCALHOST), place.port());
                    if let Ok((listener, _)) = bind_tcp(door, six).await {
                        self.spawn_listener(listener, kind, reception, &stats);
                    }
                }
                Ok(place)
            }
            Err(error) => Err(error),
        };
        self.doors.push(Door { kind: door, place, stats });
    }

    fn spawn_listener(
        &self,
        listener: TcpListener,
        kind: &Kind,
        reception: &Reception,
        stats: &Arc<EndpointStats>,
    ) {
        let (tasks, stats) = (self.tasks.clone(), Arc::clone(stats));
        self.tasks.spawn(listener::listen(listener, kind.clone(), reception.clone(), stats, tasks));
    }

    async fn open_datagrams(
        &mut self,
        door: DoorKind,
        listen: Option<IpAddr>,
        port: u16,
        datagrams: Datagrams,
        reception: &Reception,
    ) {
        let stats = Arc::new(EndpointStats::new(Instant::now()));
        let address = SocketAddr::new(listen.unwrap_or(IpAddr::V4(Ipv4Addr::LOCALHOST)), port);
        let bound = UdpSocket::bind(address).await.and_then(|socket| Ok((socket.local_addr()?, socket)));
        let place = match bound {
            Ok((place, socket)) => {
                self.tasks.spawn(udp::receive(socket, datagrams, reception.clone(), Arc::clone(&stats)));
                Ok(place)
            }
            Err(error) => Err(explain(door, address, error)),
        };
        self.doors.push(Door { kind: door, place, stats });
    }

    /// One line a door.
    #[must_use]
    pub fn views(&self) -> Vec<EndpointStatus> {
        let now = Instant::now();
        self.doors.iter().map(|door| door.view(now)).collect()
    }

    /// Why doors are closed, as sentences.
    pub fn problems(&self) -> impl Iterator<Item = &DoorError> {
        self.doors.iter().filter_map(|door| door.place.as_ref().err())
    }

    /// Where a door listens.
    #[must_use]
    pub fn address(&self, kind: DoorKind) -> Option<SocketAddr> {
        let door = self.doors.iter().find(|door| door.kind == kind)?;
        door.place.as_ref().ok().copied()
    }

    /// How many clients a door has.
    #[must_use]
    pub fn clients(&self, kind: DoorKind) -> u32 {
        self.doors.iter().find(|door| door.kind == kind).map_or(0, |door| door.stats.clients())
    }

    /// The bell that a restart of the firmware rings.
    #[must_use]
    pub fn restart_bell(&self) -> RestartBell {
        RestartBell(self.restarts.clone())
    }

    /// Closes all doors and waits for their clients to be told.
    pub async fn close(self) {
        self.shutdown.cancel();
        self.tasks.close();
        let _late_ones_are_dropped = tokio::time::timeout(CLOSING, self.tasks.wait()).await;
    }
}

impl Drop for Doors {
    fn drop(&mut self) {
        self.shutdown.cancel();
    }
}

/// Closes the links of all clients, as a restart of the firmware does; they may come back at once.
#[derive(Debug, Clone)]
pub struct RestartBell(watch::Sender<u64>);

impl RestartBell {
    /// The firmware started anew.
    pub fn ring(&self) {
        self.0.send_modify(|restarts| *restarts += 1);
    }
}

impl Door {
    fn view(&self, now: Instant) -> EndpointStatus {
        let (address, state) = match &self.place {
            Ok(place) => {
                let state = match self.kind {
                    DoorKind::WebSocket | DoorKind::Tcp => EndpointState::Clients(self.stats.client_stats()),
                    DoorKind::Fdm | DoorKind::Rc => EndpointState::Packets(self.stats.packet_stats(now)),
                };
                (place.to_string(), state)
            }
            Err(DoorError::Busy { port, .. }) => (port.to_string(), EndpointState::Busy),
            Err(DoorError::Refused { address, .. }) => (address.to_string(), EndpointState::Closed),
        };
        EndpointStatus { name: self.kind.name(), address, state }
    }
}

async fn bind_tcp(door: DoorKind, address: SocketAddr) -> Result<(TcpListener, SocketAddr), DoorError> {
    let bound = TcpListener::bind(address).await.and_then(|listener| Ok((listener.local_addr()?, listener)));
    bound.map(|(place, listener)| (listener, place)).map_err(|error| explain(door, address, error))
}

fn explain(door: DoorKind, address: SocketAddr, error: io::Error) -> DoorError {
    if error.kind() == io::ErrorKind::AddrInUse {
        DoorError::Busy { door, port: address.port() }
    } else {
        DoorError::Refused { door, address, error }
    }
}
