//! The listeners at which other programs reach the vehicle: opens them, reports their state, closes them.

#![allow(clippy::disallowed_methods, reason = "the state of a listener shows the age of its newest packet")]

use std::io;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};
use std::sync::Arc;
use std::time::{Duration, Instant};

use tokio::net::TcpListener;
use tokio::sync::{mpsc, watch};
use tokio_util::sync::CancellationToken;
use tokio_util::task::TaskTracker;

use super::client::SharedChannels;
use super::endpoint_stats::EndpointStats;
use super::listener::{self, ListenerKind, ListenerRules};
use super::notices::Notices;
use super::request::Request;
use super::seats::Seats;
use super::udp::{DatagramPort, Datagrams, StateQueue};
use crate::link::endpoint::{EndpointKind, EndpointState, EndpointStatus};

/// The longest time that the listeners may take to close.
const CLOSING: Duration = Duration::from_secs(1);

/// The endpoints to open and their ports. Port 0 lets the system choose; `None` leaves an endpoint closed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ListenConfig {
    /// The address to listen on; `None` = 127.0.0.1, for TCP and websocket ::1 as well.
    pub listen: Option<IpAddr>,
    /// MSP and command line over TCP.
    pub tcp_port: Option<u16>,
    /// MSP and command line over a websocket.
    pub ws_port: Option<u16>,
    /// RC from scripts, UDP.
    pub rc_port: Option<u16>,
    /// States of the craft from a simulator, UDP.
    pub fdm_port: Option<u16>,
    /// Web pages that are served in addition to the usual ones.
    pub allow_origin: Vec<String>,
}

impl Default for ListenConfig {
    /// Returns the usual endpoints of a craft with embedded physics.
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

/// Returns the option that sets the port of an endpoint.
fn option(kind: EndpointKind) -> &'static str {
    match kind {
        EndpointKind::WebSocket => "--ws-port",
        EndpointKind::Tcp => "--tcp-port",
        EndpointKind::Fdm | EndpointKind::Rc | EndpointKind::Motors => "--udp-ports",
    }
}

/// The reason why an endpoint is closed.
#[derive(Debug, thiserror::Error)]
pub enum ListenError {
    /// Another program has the port.
    #[error(
        "{} port {port} is in use: stop the program that uses it, or choose another with {} (0 = any free one)",
        .kind.transport(), option(*.kind)
    )]
    Busy {
        /// The endpoint that needs the port.
        kind: EndpointKind,
        port: u16,
    },
    /// The system refused for another reason.
    #[error("cannot listen on {address} ({}): {error}; see --listen and {}", .kind.transport(), option(*.kind))]
    Refused {
        /// The endpoint that needs the address.
        kind: EndpointKind,
        /// The requested address.
        address: SocketAddr,
        /// The system's error.
        error: io::Error,
    },
}

/// One endpoint that listens or should listen.
#[derive(Debug)]
struct Listener {
    kind: EndpointKind,
    /// The address, or the reason why it is closed.
    place: Result<SocketAddr, ListenError>,
    stats: Arc<EndpointStats>,
}

#[derive(Debug)]
pub struct Listeners {
    all: Vec<Listener>,
    shutdown: CancellationToken,
    tasks: TaskTracker,
    restarts: watch::Sender<u64>,
    /// The packets from an external simulator, if that endpoint is open.
    states: Option<StateQueue>,
}

impl Listeners {
    /// Opens the endpoints. An endpoint that cannot be opened has the reason in its status; the others work.
    pub async fn open(config: &ListenConfig, requests: mpsc::Sender<Request>) -> (Self, Vec<EndpointStatus>) {
        let (restarts, restarted) = watch::channel(0);
        let mut listeners = Self {
            all: Vec::new(),
            shutdown: CancellationToken::new(),
            tasks: TaskTracker::new(),
            restarts,
            states: None,
        };
        let channels = SharedChannels { requests, shutdown: listeners.shutdown.clone(), restarts: restarted };
        let allow_origin: Arc<[String]> = config.allow_origin.clone().into();
        let rules = |kind| ListenerRules { kind, allow_origin: Arc::clone(&allow_origin) };
        if let Some(port) = config.ws_port {
            let rules = rules(ListenerKind::WebSocket);
            listeners.open_stream(EndpointKind::WebSocket, config.listen, port, &rules, &channels).await;
        }
        if let Some(port) = config.tcp_port {
            let rules = rules(ListenerKind::Tcp);
            listeners.open_stream(EndpointKind::Tcp, config.listen, port, &rules, &channels).await;
        }
        if let Some(port) = config.fdm_port {
            listeners.open_datagrams(EndpointKind::Fdm, config.listen, port, Datagrams::Fdm, &channels);
        }
        if let Some(port) = config.rc_port {
            listeners.open_datagrams(EndpointKind::Rc, config.listen, port, Datagrams::Rc, &channels);
        }
        let status = listeners.status();
        (listeners, status)
    }

    async fn open_stream(
        &mut self,
        kind: EndpointKind,
        listen: Option<IpAddr>,
        port: u16,
        rules: &ListenerRules,
        channels: &SharedChannels,
    ) {
        let stats = Arc::new(EndpointStats::new(Instant::now()));
        let shared = (Notices::new(channels.requests.clone()), Seats::default(), Arc::clone(&stats));
        let address = SocketAddr::new(listen.unwrap_or(IpAddr::V4(Ipv4Addr::LOCALHOST)), port);
        let place = match bind_tcp(kind, address).await {
            Ok((listener, place)) => {
                self.spawn_listener(listener, rules, channels, &shared);
                if listen.is_none() {
                    // A machine without IPv6 has no such address.
                    let six = SocketAddr::new(IpAddr::V6(Ipv6Addr::LOCALHOST), place.port());
                    if let Ok((listener, _)) = bind_tcp(kind, six).await {
                        self.spawn_listener(listener, rules, channels, &shared);
                    }
                }
                Ok(place)
            }
            Err(error) => Err(error),
        };
        self.all.push(Listener { kind, place, stats });
    }

    fn spawn_listener(
        &self,
        listener: TcpListener,
        rules: &ListenerRules,
        channels: &SharedChannels,
        (notices, seats, stats): &(Notices, Seats, Arc<EndpointStats>),
    ) {
        let (notices, seats, stats) = (notices.clone(), seats.clone(), Arc::clone(stats));
        let (rules, channels, tasks) = (rules.clone(), channels.clone(), self.tasks.clone());
        self.tasks.spawn(listener::listen(listener, rules, channels, notices, stats, seats, tasks));
    }

    fn open_datagrams(
        &mut self,
        kind: EndpointKind,
        listen: Option<IpAddr>,
        port: u16,
        datagrams: Datagrams,
        channels: &SharedChannels,
    ) {
        let stats = Arc::new(EndpointStats::new(Instant::now()));
        let address = SocketAddr::new(listen.unwrap_or(IpAddr::V4(Ipv4Addr::LOCALHOST)), port);
        let bound = DatagramPort::bind(address, datagrams, channels.requests.clone(), Arc::clone(&stats));
        let place = match bound {
            Ok((port, place)) => {
                let (port, shutdown) = (Arc::new(port), channels.shutdown.clone());
                if datagrams == Datagrams::Fdm {
                    self.states = Some(StateQueue(Arc::clone(&port)));
                }
                self.tasks.spawn(async move { port.receive(shutdown).await });
                Ok(place)
            }
            Err(error) => Err(explain(kind, address, error)),
        };
        self.all.push(Listener { kind, place, stats });
    }

    /// Returns the status of each endpoint.
    pub fn status(&self) -> Vec<EndpointStatus> {
        let now = Instant::now();
        self.all.iter().map(|listener| listener.status(now)).collect()
    }

    /// Returns the reasons why endpoints are closed, as sentences.
    pub fn problems(&self) -> impl Iterator<Item = &ListenError> {
        self.all.iter().filter_map(|listener| listener.place.as_ref().err())
    }

    /// Returns the address at which an endpoint listens.
    pub fn address(&self, kind: EndpointKind) -> Option<SocketAddr> {
        let listener = self.all.iter().find(|listener| listener.kind == kind)?;
        listener.place.as_ref().ok().copied()
    }

    /// Returns the number of clients of an endpoint.
    pub fn clients(&self, kind: EndpointKind) -> u32 {
        self.all.iter().find(|listener| listener.kind == kind).map_or(0, |listener| listener.stats.clients())
    }

    /// Returns the queue of states from an external simulator, if that endpoint is open.
    pub fn states(&self) -> Option<StateQueue> {
        self.states.clone()
    }

    /// Returns the signal that a restart of the firmware sends.
    pub fn restart_signal(&self) -> RestartSignal {
        RestartSignal(self.restarts.clone())
    }

    /// Closes all endpoints and waits until their clients are closed.
    pub async fn close(self) {
        self.shutdown.cancel();
        self.tasks.close();
        let _late_ones_are_dropped = tokio::time::timeout(CLOSING, self.tasks.wait()).await;
    }
}

impl Drop for Listeners {
    fn drop(&mut self) {
        self.shutdown.cancel();
    }
}

/// Closes the links of all clients, as a restart of the firmware does. They may reconnect at once.
#[derive(Debug, Clone)]
pub struct RestartSignal(watch::Sender<u64>);

impl RestartSignal {
    /// Signals that the firmware has restarted.
    pub fn send(&self) {
        self.0.send_modify(|restarts| *restarts += 1);
    }
}

impl Listener {
    fn status(&self, now: Instant) -> EndpointStatus {
        let (address, state) = match &self.place {
            Ok(place) => {
                let state = match self.kind {
                    EndpointKind::WebSocket | EndpointKind::Tcp => {
                        EndpointState::Clients(self.stats.client_stats())
                    }
                    EndpointKind::Fdm | EndpointKind::Rc | EndpointKind::Motors => {
                        EndpointState::Packets(self.stats.packet_stats(now))
                    }
                };
                (place.to_string(), state)
            }
            Err(ListenError::Busy { port, .. }) => (port.to_string(), EndpointState::Busy),
            Err(ListenError::Refused { address, .. }) => (address.to_string(), EndpointState::Closed),
        };
        EndpointStatus { kind: self.kind, address, state }
    }
}

async fn bind_tcp(kind: EndpointKind, address: SocketAddr) -> Result<(TcpListener, SocketAddr), ListenError> {
    let bound = TcpListener::bind(address).await.and_then(|listener| Ok((listener.local_addr()?, listener)));
    bound.map(|(place, listener)| (listener, place)).map_err(|error| explain(kind, address, error))
}

fn explain(kind: EndpointKind, address: SocketAddr, error: io::Error) -> ListenError {
    if error.kind() == io::ErrorKind::AddrInUse {
        ListenError::Busy { kind, port: address.port() }
    } else {
        ListenError::Refused { kind, address, error }
    }
}
