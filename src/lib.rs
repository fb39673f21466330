//! betadeck: a terminal ground station with an embedded flight controller, autopilot and quadcopter.
//!
//! `docs/architecture.md` draws the rooms; each module says what it may use.

#![forbid(unsafe_code)]

pub mod app;
pub mod args;
pub mod autopilot;
pub mod excerpt;
pub mod firmware;
pub mod flight;
pub mod geo;
pub mod link;
pub mod nearest;
pub mod pilot;
pub mod plan;
pub mod record;
pub mod session;
pub mod signals;
pub mod sim;
pub mod storage;
pub mod ui;
pub mod vehicle;
