//! The firmware alone, as a drop-in for the SITL executable: same ports, same lines, driven by an external simulator.
//!
//! It is a normal session with external physics; `host` prints lines from its events and views.

mod host;
mod lines;

pub use host::{OutputLine, Sitl, SitlConfig, SitlEnd, SitlError, show_links};
pub use lines::SitlPorts;
