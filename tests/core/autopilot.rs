//! The autopilot: its vectors, its state machine, and flights of it in a simple vehicle.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod docs;
mod flight;
mod flights;
mod hover;
mod navigator;
mod params;
mod states;
mod vectors;
mod vehicle;
