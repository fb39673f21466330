//! The ends at which other programs reach the craft, and how they are doing.

use super::LinkState;

/// One endpoint.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EndpointStatus {
    /// `ws`, `tcp`, `udp fdm`, `udp rc`, `udp motors`.
    pub name: &'static str,
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
    /// Bytes from clients.
    pub received_bytes: u64,
    /// Bytes to clients.
    pub sent_bytes: u64,
    /// Clients turned away or lost, frames given up.
    pub errors: u64,
}

/// What a receiver of datagrams has seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PacketStats {
    /// Good packets.
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
    /// Senseless packets.
    pub refused: u64,
    /// Packets from before the newest one.
    pub old: u64,
}

impl EndpointState {
    /// Whether nobody uses it at present.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        match self {
            Self::Busy | Self::Closed => true,
            Self::Clients(stats) => stats.clients == 0,
            Self::Packets(stats) => stats.rate_hz == 0,
            Self::Simulator(stats) => stats.link == LinkState::Waiting,
        }
    }
}
