//! The core of betadeck: a simulated quadcopter with an embedded flight controller and autopilot, flight plans and their
//! tests. It has no clock, socket, thread or file, and gives the same bits on every machine.

#![forbid(unsafe_code)]
#![warn(missing_docs)]

#[doc(hidden)]
pub mod autopilot;
#[doc(hidden)]
pub mod blackbox;
#[doc(hidden)]
pub mod campaign;
pub mod design;
pub mod firmware;
pub mod flight;
#[doc(hidden)]
pub mod flight_log;
pub mod geo;
#[doc(hidden)]
pub mod math;
#[doc(hidden)]
pub mod msp;
pub mod pilot;
pub mod plan;
#[doc(hidden)]
pub mod recording;
#[doc(hidden)]
pub mod replay;
pub mod scenario;
pub mod signals;
pub mod sim;
pub mod telemetry;
pub mod terrain;
pub mod text;
#[doc(hidden)]
pub mod timeline;
pub mod vehicle;
