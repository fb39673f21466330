//! The waypoint autopilot: facts in, setpoints and typed events out, 100 times a second.
//!
//! By the laws of the test guide: `machine` decides about states, `guidance` about the path, `control` about throttle, tilt and
//! yaw rate, `land_detector` about the ground, and `navigator` wires them. `master` has the laws of today's firmware, and
//! `profiles` the navigator in use. `params` are the settings of both.

pub mod control;
pub mod engage;
pub mod fence;
pub mod guidance;
pub mod io;
pub mod land_detector;
pub mod machine;
pub mod master;
pub mod navigator;
pub mod params;
pub mod profiles;
pub mod rx_loss;

pub use navigator::{Navigator, Rescue};
pub use params::Params;
pub use profiles::Autopilot;
