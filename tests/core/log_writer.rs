//! The logs that the flight controller writes, read by a decoder of these tests and by one of other people, against the
//! truth of each step.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod fields;
mod flown;
mod header;
mod judge;
mod order;
mod reader;
mod switches;
mod truth;
