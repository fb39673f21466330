//! The state of a flight controller, as it reports it in messages and lines.

mod mission;
mod modes;
mod observation;
mod setting;

pub use mission::{Mission, MissionPhase, PlannedWaypoint};
pub use modes::mode_ranges;
pub use observation::{Observation, Origin};
pub use setting::{setting, settings};
