//! Modes: boxes, the conditions that switch them, and the rules for which flight mode is on when.

pub mod boxes;
pub mod conditions;
pub mod rules;

pub use boxes::{BoxId, BoxSet};
pub use conditions::evaluate;
pub use rules::{AfterAbort, ModeFacts, flight_modes};
