//! The core alone: autopilot, firmware, world, whole flights, missions, logs, scenarios.

mod autopilot;
mod firmware;
mod flights;
mod kinematic_craft;
mod log_writer;
mod missions;
mod scenarios;
mod sim;
