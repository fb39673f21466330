//! betadeck: a terminal ground station with an embedded flight controller, autopilot and quadcopter.
//!
//! Programs that embed a craft use the crate `betadeck-core`. This crate has the terminal, the links and the commands; it is
//! a library for the project's own tests and benchmarks only.
//!
//! `docs/architecture.md` draws all modules and lists the modules that each of them may use.

#[doc(hidden)]
pub use betadeck_core::{
    autopilot, blackbox, campaign, design, firmware, flight, flight_log, geo, math, msp, pilot, plan,
    recording, replay, scenario, signals, sim, telemetry, terrain, text, timeline, vehicle,
};

#[doc(hidden)]
pub use betadeck_mavlink as mavlink;

#[doc(hidden)]
pub mod app;
#[doc(hidden)]
pub mod args;
#[doc(hidden)]
pub mod events;
#[doc(hidden)]
pub mod fc;
#[doc(hidden)]
pub mod files;
#[doc(hidden)]
pub mod ground_station;
#[doc(hidden)]
pub mod headless;
#[doc(hidden)]
pub mod launch;
#[doc(hidden)]
pub mod link;
#[doc(hidden)]
pub mod lookahead;
#[doc(hidden)]
pub mod process;
#[doc(hidden)]
pub mod report;
#[doc(hidden)]
pub mod runner;
#[doc(hidden)]
pub mod screen_files;
#[doc(hidden)]
pub mod session;
#[doc(hidden)]
pub mod storage;
#[doc(hidden)]
pub mod ui;
