//! The firmware alone, as a drop-in for the SITL executable: same ports, same lines, driven by an external simulator.

mod host;
mod lines;

pub use host::{Said, Sitl, SitlConfig, SitlEnd, SitlError, show_links};
pub use lines::SitlPorts;
