//! betadeck: a terminal ground station with an embedded flight controller, autopilot and quadcopter.
//!
//! `docs/architecture.md` draws the modules and lists the modules that each of them may use.

#![forbid(unsafe_code)]

pub mod app;
pub mod args;
pub mod autopilot;
pub mod fc;
pub mod firmware;
pub mod flight;
pub mod geo;
pub mod link;
pub mod msp;
pub mod pilot;
pub mod plan;
pub mod report;
pub mod scenario;
pub mod session;
pub mod signals;
pub mod sim;
pub mod storage;
pub mod telemetry;
pub mod text;
pub mod timeline;
pub mod ui;
pub mod vehicle;
