//! The autopilot of Betaflight's master: legs that follow a carrot, corners by speed, and one position law for missions and
//! holds.

mod altitude;
mod corner;
mod hold;
mod injected;
mod landing;
mod leg;
mod line;
mod mission;
mod monitor;
mod navigator;
mod position;
mod report;
mod route;
mod yaw;

pub use hold::PATTERN_RPS;
pub use mission::Return;
pub use navigator::{Held, HoldOrders, MasterNavigator};
