//! The MAVLink door: other ground stations see the craft, plan for it and command it.
//!
//! `task` joins three parts: the sockets of `sockets`, the protocol of the crate `betadeck-mavlink`, and the session, whose view it
//! reads and to which it sends commands. `state` makes telemetry of the view, `controls` makes commands of the requests,
//! `fences` converts both ways, `parameters` names the settings.

mod answers;
mod controls;
mod fences;
mod options;
mod parameters;
mod rc;
mod sockets;
mod state;
mod task;
mod texts;

pub use options::{GroundStationOptions, Place};
pub use parameters::alias;
pub use sockets::DoorError;
pub use task::{BoundDoor, Door};
