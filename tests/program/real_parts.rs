//! A real firmware in place of the embedded one. A stand-in that follows the rules measured on the public executable
//! judges its link, and so does that executable itself if `BETADECK_TEST_SITL` names it.
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
mod real;
mod rules;
mod served;
mod sockets;
mod stand_in;
mod wire;
