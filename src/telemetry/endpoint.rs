//! The ends at which other programs reach the craft, and how they are doing.

use super::LinkState;

/// What an endpoint is for. `Display` gives its name.
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
    /// The protocol below it.
    pub fn transport(self) -> Transport {
        match self {
            Self::WebSocket | Self::Tcp => Transport::Tcp,
            Self::Fdm | Self::Rc | Self::Motors => Transport::Udp,
        }
    }

    /// Its name without the transport, where there is little room.
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

/// The protocol below an endpoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display)]
#[strum(serialize_all = "UPPERCASE")]
pub enum Transport {
    Tcp,
    Udp,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EndpointStatus {
    /// What it is for.
    pub kind: EndpointKind,
    /// Address it listens on or sends to.
    pub address: String,
    /// How it is doing.
    pub state: EndpointState,
}

/// How an endpoint is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EndpointState {
    /// Not open: something else has the port.
    Busy,
    /// Not open for another reason.
    Closed,
    /// A server for clients that speak MSP and the command line.
    Clients(ClientStats),
    /// A receiver of datagrams.
    Packets(PacketStats),
    /// The link to an external simulator, seen from the side that sends the motors.
    Simulator(SimulatorStats),
}

/// What a server for clients has seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ClientStats {
    /// Clients that are connected.
    pub clients: u32,
    /// Code of the newest MSP request.
    pub last_message: Option<u16>,
    pub received_bytes: u64,
    pub sent_bytes: u64,
    /// Clients turned away or lost, frames given up.
    pub errors: u64,
}

/// What a receiver of datagrams has seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PacketStats {
    pub packets: u64,
    /// Good packets a second; 0 once they stay away.
    pub rate_hz: u32,
    /// Age of the newest good packet, ms; `None` before the first.
    pub age_ms: Option<u64>,
    /// Packets of a size that means nothing.
    pub wrong_size: u64,
    /// Packets lost on this side.
    pub errors: u64,
}

/// What the link to an external simulator has seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SimulatorStats {
    /// Whether it is there.
    pub link: LinkState,
    /// Its dialect, once known.
    pub dialect: Option<&'static str>,
    pub refused: u64,
    /// Packets from before the newest one.
    pub old: u64,
}

impl EndpointState {
    /// Whether nobody uses it at present.
    pub fn is_idle(&self) -> bool {
        match self {
            Self::Busy | Self::Closed => true,
            Self::Clients(stats) => stats.clients == 0,
            Self::Packets(stats) => stats.rate_hz == 0,
            Self::Simulator(stats) => stats.link == LinkState::Waiting,
        }
    }
}

/// Datagrams of scripts and simulators that were of no use.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct BadPackets {
    /// Of a size that means nothing.
    pub wrong_size: u64,
    /// Long enough, but with numbers that cannot be.
    pub senseless: u64,
}

impl BadPackets {
    /// What all endpoints have seen.
    pub fn of(endpoints: &[EndpointStatus]) -> Self {
        endpoints.iter().fold(Self::default(), |sum, endpoint| match endpoint.state {
            EndpointState::Packets(stats) => Self { wrong_size: sum.wrong_size + stats.wrong_size, ..sum },
            EndpointState::Simulator(stats) => Self { senseless: sum.senseless + stats.refused, ..sum },
            EndpointState::Busy | EndpointState::Closed | EndpointState::Clients(_) => sum,
        })
    }

    /// Whether there was none.
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
