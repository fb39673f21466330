//! The client of a flight controller's serial port against captured exchanges, this program's own server with the
//! embedded firmware behind it, and lines that lose and damage bytes.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod board;
mod captured;
mod damaged;
mod decoders;
mod lines;
mod telemetry;
