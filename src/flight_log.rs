//! A blackbox log as a flight: values in SI units by name, modes, events, the track.
//!
//! Times are [`SimTime`](crate::signals::SimTime) on the craft's clock, since its boot. A log of a simulated craft so has the
//! times of the simulation. Places count from home, north and east. Roll is positive to the right, pitch with the nose up,
//! headings run clockwise from north.

mod boxes;
mod failsafe_phase;
mod mark;
mod place;
mod sample;
mod signal;

pub use boxes::{BoxFlags, BoxOrder, Version};
pub use failsafe_phase::FailsafePhase;
pub use mark::{LogMark, LogMarkKind};
pub use place::{LogHome, TrackFix};
pub use sample::{LogAttitude, LogSample, MAX_MOTORS};
pub use signal::{Extent, LogSignal, SignalFrame};
