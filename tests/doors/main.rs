//! The executable as the programs around it see it: scripts, the App, simulators. Ports come from the system.

#![allow(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    clippy::disallowed_types,
    clippy::print_stdout,
    reason = "tests may panic and tell, and these play programs that live by the wall clock"
)]

mod app;
mod app_flow;
mod hostile_clients;
mod lost_time;
mod memory;
mod msp;
mod program;
mod scripts;
mod serial;
mod simulator;
mod transmitter;
mod two;
