//! The options of the door.

use std::fmt;

use crate::mavlink::craft::Identity;

/// A place where ground stations meet the craft.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// Sends to this port of the loopback, where a ground station listens, from a port of its own.
    Udp(u16),
    /// Listens on this port; 0 = any free one.
    Tcp(u16),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Udp(port) => write!(f, "udp:{port}"),
            Self::Tcp(port) => write!(f, "tcp:{port}"),
        }
    }
}

/// The options of the door.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GroundStationOptions {
    pub places: Vec<Place>,
    /// The autopilot that the craft claims to be.
    pub identity: Identity,
    /// `true` if sticks and channels of ground stations are a source of RC.
    pub takes_rc: bool,
    /// `true` in front of a real craft, which is only shown.
    pub is_read_only: bool,
}
