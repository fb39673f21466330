//! The endpoints at which other programs reach the craft, and their status.

use crate::telemetry::LinkState;

/// The purpose of an endpoint. `Display` gives its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display)]
pub enum EndpointKind {
    /// MSP and command line over a websocket.
    #[strum(to_string = "ws")]
    WebSocket,
    /// MSP and command line over TCP.
    #[strum(to_string = "tcp")]
    Tcp,
    /// States from a simulator.
    #[strum(to_string = "udp fdm")]
    Fdm,
    #[strum(to_string = "udp rc")]
    Rc,
    /// Motor commands to a simulator.
    #[strum(to_string = "udp motors")]
    Motors,
}

impl EndpointKind {
    /// Returns the underlying protocol.
    pub fn transport(self) -> Transport {
        match self {
            Self::WebSocket | Self::Tcp => Transport::Tcp,
            Self::Fdm | Self::Rc | Self::Motors => Transport::Udp,
        }
    }

    /// Returns the name without the transport, for narrow displays.
    pub fn short_name(self) -> &'static str {
        match self {
            Self::WebSocket => "ws",
            Self::Tcp => "tcp",
            Self::Fdm => "fdm",
            Self::Rc => "rc",
            Self::Motors => "motors",
        }
    }
}

/// The protocol that an endpoint uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display)]
#[strum(serialize_all = "UPPERCASE")]
pub enum Transport {
    Tcp,
    Udp,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EndpointStatus {
    /// The purpose of the endpoint.
    pub kind: EndpointKind,
    /// The address on which it listens or to which it sends.
    pub address: String,
    pub state: EndpointState,
}

/// The state of an endpoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EndpointState {
    /// Not open, because another program has the port.
    Busy,
    /// Not open for another reason.
    Closed,
    /// A server for clients that use MSP and the command line.
    Clients(ClientStats),
    /// A receiver of datagrams.
    Packets(PacketStats),
    /// The link to an external simulator, on the side that sends the motors.
    Simulator(SimulatorStats),
}

/// The counters of a server for clients.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ClientStats {
    /// The number of connected clients.
    pub clients: u32,
    /// The code of the newest MSP request.
    pub last_message: Option<u16>,
    pub received_bytes: u64,
    pub sent_bytes: u64,
    /// Clients that were refused or lost, and dropped frames.
    pub errors: u64,
}

/// The counters of a receiver of datagrams.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PacketStats {
    pub packets: u64,
    /// Valid packets per second; 0 once they stop.
    pub rate_hz: u32,
    /// The age of the newest valid packet, ms; `None` before the first.
    pub age_ms: Option<u64>,
    /// Packets of an unknown size.
    pub wrong_size: u64,
    /// Packets lost on this side.
    pub errors: u64,
}

/// The counters of the link to an external simulator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SimulatorStats {
    /// The state of the link.
    pub link: LinkState,
    /// The dialect, once known.
    pub dialect: Option<&'static str>,
    pub refused: u64,
    /// Packets that are older than the newest one.
    pub old: u64,
}

impl EndpointState {
    /// Returns `true` if no program uses the endpoint at present.
    pub fn is_idle(&self) -> bool {
        match self {
            Self::Busy | Self::Closed => true,
            Self::Clients(stats) => stats.clients == 0,
            Self::Packets(stats) => stats.rate_hz == 0,
            Self::Simulator(stats) => stats.link == LinkState::Waiting,
        }
    }
}

/// Unusable datagrams of scripts and simulators.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct BadPackets {
    /// Datagrams of an unknown size.
    pub wrong_size: u64,
    /// Datagrams that are long enough but have impossible values.
    pub senseless: u64,
}

impl BadPackets {
    /// Returns the sum over all endpoints.
    pub fn of(endpoints: &[EndpointStatus]) -> Self {
        endpoints.iter().fold(Self::default(), |sum, endpoint| match endpoint.state {
            EndpointState::Packets(stats) => Self { wrong_size: sum.wrong_size + stats.wrong_size, ..sum },
            EndpointState::Simulator(stats) => Self { senseless: sum.senseless + stats.refused, ..sum },
            EndpointState::Busy | EndpointState::Closed | EndpointState::Clients(_) => sum,
        })
    }

    /// Returns `true` if there are none.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

impl std::fmt::Display for BadPackets {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { wrong_size, senseless } = self;
        write!(f, "{} ({wrong_size} of a wrong size, {senseless} senseless)", wrong_size + senseless)
    }
}
