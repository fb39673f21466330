//! The client of a flight controller's serial port, tested with captured exchanges, with this program's own
//! server and embedded firmware, and with lines that lose and damage bytes.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod board;
mod captured;
mod damaged;
mod decoders;
mod lines;
mod telemetry;
