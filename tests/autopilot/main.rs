//! The autopilot: its vectors, its state machine, and flights of it in a simple vehicle.

mod docs;
mod flight;
mod flights;
mod hover;
mod navigator;
mod params;
mod states;
mod vectors;
mod vehicle;
