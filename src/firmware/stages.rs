//! The stages of one firmware step. Each owns its part of the state and is told all else as arguments; only
//! [`Firmware`](super::Firmware) knows all of them and carries results from one to the next.
//!
//! | stage | owns | gives |
//! | --- | --- | --- |
//! | [`Setup`] | configuration, boot choices, typed parameters, what is known of build and storage | parameters |
//! | [`RcInput`] | queued frames, receiver, link monitor, boxes | sticks, switches, whether the link is up |
//! | [`Safety`] | arming, runaway, crash and impact detection, home and heading at arming | armed or why not |
//! | [`Sensing`] | estimator, battery, fix | the estimate |
//! | [`Navigation`] | failsafe, orders, navigator, holds | demands that take the place of the pilot's |
//! | [`FlightControl`] | the controller, the demands in force, the motor test | motor commands |

mod flight_control;
mod navigation;
mod rc_input;
mod safety;
mod sensing;
mod setup;

pub(super) use flight_control::{ControlStep, Demand, FlightControl};
pub(super) use navigation::{FailsafeRequest, Navigation};
pub(super) use rc_input::RcInput;
pub(super) use safety::{Safety, trusted_position};
pub(super) use sensing::Sensing;
pub(super) use setup::Setup;
