//! The core of betadeck: a simulated quadcopter with an embedded flight controller and autopilot, flight plans and their
//! tests. It has no clock, socket, thread or file, and gives the same bits on every machine.

#![forbid(unsafe_code)]

#[doc(hidden)]
pub mod autopilot;
#[doc(hidden)]
pub mod blackbox;
#[doc(hidden)]
pub mod campaign;
#[doc(hidden)]
pub mod design;
#[doc(hidden)]
pub mod firmware;
pub mod flight;
#[doc(hidden)]
pub mod flight_log;
#[doc(hidden)]
pub mod geo;
#[doc(hidden)]
pub mod math;
#[doc(hidden)]
pub mod msp;
#[doc(hidden)]
pub mod pilot;
pub mod plan;
#[doc(hidden)]
pub mod recording;
#[doc(hidden)]
pub mod replay;
pub mod scenario;
pub mod signals;
#[doc(hidden)]
pub mod sim;
pub mod telemetry;
#[doc(hidden)]
pub mod terrain;
#[doc(hidden)]
pub mod text;
#[doc(hidden)]
pub mod timeline;
pub mod vehicle;
