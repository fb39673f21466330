//! The stages of one firmware step. Each owns its part of the state and gets everything else as arguments. Only
//! [`Firmware`](super::Firmware) has access to all stages and passes results from one to the next.
//!
//! | stage | owns | returns |
//! | --- | --- | --- |
//! | [`Setup`] | configuration, boot choices, typed parameters, facts about build and storage | parameters |
//! | [`RcInput`] | queued frames, receiver, link monitor, boxes | sticks, switches, state of the link |
//! | [`Safety`] | arming, runaway and crash detection, home and heading at arming | armed, or the flags that block arming |
//! | [`Sensing`] | estimator, battery, fix | the estimate |
//! | [`Navigation`] | failsafe, orders, navigator, holds, impact detection | demands that replace the pilot's |
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
