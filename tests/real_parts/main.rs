//! A real firmware in place of the embedded one: its link judged by a stand-in that keeps the rules which were measured on
//! the public executable, and by that executable itself when `BETADECK_TEST_SITL` names one.
#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test may panic")]
#![allow(
    clippy::disallowed_methods,
    clippy::disallowed_types,
    reason = "other processes live by the wall clock"
)]

mod checks;
mod child;
mod drop_in;
mod feed;
mod headless;
mod lossy;
#[allow(dead_code, reason = "shared with the tests of the doors")]
#[path = "../doors/msp.rs"]
mod msp;
#[allow(dead_code, reason = "shared with the tests of the doors")]
#[path = "../doors/program.rs"]
mod program;
mod real;
mod rules;
mod served;
mod sockets;
mod stand_in;
mod wire;
