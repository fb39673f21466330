//! The executable as seen by the programs around it: scripts, the App, simulators. The system chooses the
//! ports.

#![allow(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    clippy::disallowed_types,
    clippy::print_stdout,
    reason = "tests may panic and tell, and these play programs that live by the wall clock"
)]

mod app;
mod app_flow;
mod ground_station;
mod hostile_clients;
mod hostile_stations;
mod judges;
mod logs;
mod lost_time;
mod memory;
pub(crate) mod msp;
pub(crate) mod program;
mod scripts;
mod serial;
mod simulator;
pub(crate) mod transmitter;
mod two;
