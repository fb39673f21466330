//! The waypoint autopilot: facts in, setpoints and typed events out, 100 times a second.

pub mod control;
pub mod engage;
pub mod fence;
pub mod guidance;
pub mod io;
pub mod land_detector;
pub mod machine;
pub mod navigator;
pub mod params;
pub mod rx_loss;

pub use navigator::{Navigator, Rescue};
pub use params::Params;
