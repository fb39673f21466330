//! Modes: boxes, the conditions that switch them, and the rules that decide the flight modes.

pub mod boxes;
pub mod conditions;
pub mod rules;

pub use boxes::{BoxId, BoxSet};
pub use conditions::evaluate;
pub use rules::{AfterAbort, ModeFacts, flight_modes};
