//! The firmware alone, as a drop-in for the SITL executable: same ports, same lines, driven by an external simulator.
//!
//! It is a session like any other whose physics is external; `host` prints lines from its events and views.

mod host;
mod lines;

pub use host::{OutputLine, Sitl, SitlConfig, SitlEnd, SitlError, show_links};
pub use lines::SitlPorts;
