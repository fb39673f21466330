//! betadeck: a terminal ground station with an embedded flight controller, autopilot and quadcopter.
//!
//! The documentation shows the modules for programs that embed a craft: [`plan`] reads and checks flight plans, [`vehicle`]
//! is a flight controller and its physics, [`flight`] flies a plan to its verdict, and [`scenario`] tests it. [`signals`] and
//! [`telemetry`] are their data. The other modules are public for the project's own tests and benchmarks only.
//!
//! `docs/architecture.md` draws all modules and lists the modules that each of them may use.

#![forbid(unsafe_code)]

#[doc(hidden)]
pub mod app;
#[doc(hidden)]
pub mod args;
#[doc(hidden)]
pub mod autopilot;
#[doc(hidden)]
pub mod blackbox;
#[doc(hidden)]
pub mod campaign;
#[doc(hidden)]
pub mod design;
#[doc(hidden)]
pub mod fc;
#[doc(hidden)]
pub mod firmware;
pub mod flight;
#[doc(hidden)]
pub mod flight_log;
#[doc(hidden)]
pub mod geo;
#[doc(hidden)]
pub mod link;
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
#[doc(hidden)]
pub mod report;
pub mod scenario;
#[doc(hidden)]
pub mod session;
pub mod signals;
#[doc(hidden)]
pub mod sim;
#[doc(hidden)]
pub mod storage;
pub mod telemetry;
#[doc(hidden)]
pub mod terrain;
#[doc(hidden)]
pub mod text;
#[doc(hidden)]
pub mod timeline;
#[doc(hidden)]
pub mod ui;
pub mod vehicle;
