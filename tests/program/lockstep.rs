//! An executable in simulated time: what it computes depends on its input only, however busy the machine is.
#![cfg(all(target_os = "linux", target_env = "gnu"))]
#![allow(clippy::unwrap_used, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "other processes live by the wall clock")]

mod child;
mod commands;
mod faults;
pub(crate) mod flying;
#[path = "../../src/link/sitl_child/lockstep/frames.rs"]
mod frames;
mod lab;
mod library;
mod serial_port;
mod served;
mod stand_in;
mod steps;
