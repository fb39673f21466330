//! The firmware flown by a simulator in another process: `betadeck sitl` and `betadeck serve --physics external`
//! against the project's own plant, which sends the packets of Gazebo's plugin.
//!
//! The plant waits for the motors before it moves on, so that a flight is the same on a slow machine and on a fast one.

mod child;
mod failing_simulators;
#[cfg(unix)]
mod launch;
mod plant;
mod rates;
mod serve;
mod simulator;
mod square;
