//! The core of betadeck: a simulated quadcopter with an embedded flight controller and autopilot, flight plans and their
//! tests. It has no clock, socket, thread or file, and gives the same bits on every machine.
//!
//! A [`Flight`] flies the plan of a [`Vehicle`] to its end and judges it. A [`Vehicle`] is a craft that a program steps
//! tick by tick, with sticks of its own if it likes. A clone of either is a branch: it flies on by itself.
//!
//! ```
//! use betadeck_core::flight::{Flight, FlightOptions, FlightResult, FlightSetup};
//! use betadeck_core::plan::builtin::BuiltinPlan;
//! use betadeck_core::sim::WorldCommand;
//! use betadeck_core::vehicle::VehicleCommand;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // Fly a plan: the file gives the plan, its home and its settings.
//! let file = BuiltinPlan::find("land").unwrap().read().unwrap();
//! let mut setup = FlightSetup { plan: file.clone(), ..FlightSetup::default() };
//! setup.stored.plan = file.plan;
//! setup.world.wind = "4@270".parse()?; // 4 m/s from the west
//! let (vehicle, _notices) = setup.build()?;
//! let mut flight = Flight::new(vehicle, &FlightOptions::default()).unwrap();
//!
//! // Step it tick by tick. Read the truth and the firmware's estimate of it, east and north of home, m.
//! while flight.vehicle().time().as_secs_f64() < 35.0 {
//!     flight.tick(|event| println!("{event:?}"));
//! }
//! let (truth, estimate) = (flight.vehicle().truth().unwrap(), flight.vehicle().estimate_view());
//! assert!((truth.pos_enu.x - estimate.e.unwrap()).abs() < 5.0);
//!
//! // Branch: one copy flies the plan to its end, the other gets a fault and sticks of the program.
//! let mut branch = flight.clone().into_vehicle();
//! let end = std::iter::repeat_with(|| flight.tick(|_| ())).flatten().next().unwrap();
//! assert_eq!(end.verdict.result, FlightResult::Complete);
//! branch.apply(&WorldCommand::parse("fault=gps-loss")?.into()).accepted()?;
//! branch.apply(&VehicleCommand::StopPilot);
//! let mut sticks = branch.transmitter().sticks(); // µs: roll, pitch, throttle, yaw, AUX1 …
//! sticks.channels[5] = 1000; // AUTOPILOT off
//! for second in 0..5 {
//!     sticks.channels[3] = 1500 + 40 * second;
//!     branch.apply(&VehicleCommand::Sticks(sticks));
//!     (0..1000).for_each(|_| branch.tick());
//! }
//! assert!(branch.controller().is_armed() && branch.truth().unwrap().pos_enu.z > 5.0);
//! # Ok(())
//! # }
//! ```
//!
//! | for | see |
//! | --- | --- |
//! | a flight from its set-up to its verdict | [`FlightSetup`], [`Flight`], [`FlightOptions`], [`FlightEnd`](flight::FlightEnd), [`FlightTruth`](telemetry::FlightTruth) |
//! | a craft, tick by tick | [`Vehicle`], [`VehicleCommand`](vehicle::VehicleCommand), [`Snapshot`](telemetry::Snapshot), [`Event`](telemetry::Event), [`SimTime`](signals::SimTime) |
//! | plans and their files | [`FlightPlan`](plan::FlightPlan), [`Waypoint`](plan::Waypoint), [`plan::format`], [`plan::generate`], [`plan::review`] |
//! | the craft, the air and what fails | [`WorldConfig`](sim::WorldConfig), [`Airframe`](sim::Airframe), [`Wind`](sim::Wind), [`Fault`](sim::Fault), [`WorldCommand`](sim::WorldCommand) |
//! | a wind of your own | [`Vehicle::set_added_wind`] |
//! | the settings and modes of the flight controller | [`Configuration`](firmware::config::Configuration), [`Settings`](firmware::settings::Settings) |
//! | sticks and switches | [`RcFrame`](signals::RcFrame), [`Switch`](telemetry::switch::Switch), [`pilot`] |
//! | the plant without a flight controller, by motor commands | [`World`](sim::World), [`MotorCommand`](signals::MotorCommand), [`SensorFrame`](signals::SensorFrame) |
//! | the flight controller without a plant | [`Firmware`](firmware::Firmware) |
//! | flights as tests | [`scenario`] |
//!
//! `examples/` flies a plan and prints its margins, flies a thousand flights on all processors, flies by a control law of its
//! own, and blows a wind of its own. Units and frames are in the names: SI and radians inside, world ENU (x east, y north,
//! z up), body FLU (x forward, y left, z up). Errors are values; no input makes the core panic.
//!
//! [`Flight`]: flight::Flight
//! [`FlightOptions`]: flight::FlightOptions
//! [`FlightSetup`]: flight::FlightSetup
//! [`Vehicle`]: vehicle::Vehicle
//! [`Vehicle::set_added_wind`]: vehicle::Vehicle::set_added_wind

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

/// Vectors and rotations in the public signatures of this crate.
pub use nalgebra;
