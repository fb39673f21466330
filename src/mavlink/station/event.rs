//! The orders of a host, and the events for it.

use super::{OrderEnd, OrderId, PilotText, TransferEnd};

/// Something that happened.
#[derive(Debug, Clone, PartialEq)]
pub enum Event {
    /// A craft was found. Its heartbeat is in the report.
    Connected {
        /// The system of the craft.
        system: u8,
        /// The component of its autopilot.
        component: u8,
    },
    /// No heartbeat arrived for 3 s.
    LinkLost,
    /// Heartbeats arrive again.
    LinkRestored,
    /// The mode changed, or its name became known.
    Mode(String),
    /// The craft was armed or disarmed.
    Armed(bool),
    /// A text for the pilot.
    Text(PilotText),
    /// A mission item was reached, in numbers of the craft.
    ItemReached(u16),
    /// The transfer ended.
    Transfer(TransferEnd),
    /// An order ended.
    Order(OrderId, OrderEnd),
}

/// Something that a craft is ordered to do.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Order {
    /// Change the mode, by its name.
    SetMode(String),
    /// Fly the mission.
    StartMission,
    /// Interrupt the mission.
    Pause,
    /// Continue the mission.
    Continue,
    /// Return home.
    ReturnHome,
    /// Land here.
    Land,
    /// Continue with this mission item, in numbers of the craft.
    SetCurrent(u16),
}

/// Why an order or a transfer is not begun.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NotBegun {
    /// No craft is connected.
    NoCraft,
    /// Another transfer is in progress, or too many orders wait.
    Busy,
    /// The craft has no such mode.
    NoSuchMode,
    /// There are too many items.
    TooLong,
}
