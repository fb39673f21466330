//! The simulated world against the vectors, and its own rules.

mod vectors;
mod world;
