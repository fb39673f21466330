//! A blackbox log as a flight: values in SI units by name, modes, events, the track.
//!
//! Times are [`SimTime`](crate::signals::SimTime) on the craft's clock, since its boot. A log of a simulated craft so has the
//! times of the simulation. Places count from home, north and east. Roll is positive to the right, pitch with the nose up,
//! headings run clockwise from north.

//!
//! [`Indexer`] reads a file once and gives its logs as [`LogFlight`]s. Each knows its signals, marks and track, the extents of
//! all signals in blocks, and where reading can begin, so that any instant is read at once ([`LogFlight::sample`]) and any
//! signal is drawn at once ([`LogFlight::series`]). `builder` collects these from the frames with `tracker`, which follows
//! the state of the craft; `fields` and `scale` find the fields and their units.

mod attitude;
mod block;
mod boxes;
mod builder;
mod cursor;
mod failsafe_phase;
mod fields;
mod flight;
mod index;
mod mark;
mod mark_log;
mod place;
mod rc;
mod sample;
mod scale;
mod signal;
#[cfg(test)]
mod tests;
mod track_log;
mod tracker;

pub use boxes::{BoxFlags, BoxOrder};
pub use cursor::FlightCursor;
pub use failsafe_phase::FailsafePhase;
pub use flight::{LogCounts, LogEnd, LogFlight};
pub use index::{IndexProgress, Indexer, LogFile, RefusedLog};
pub use mark::{LogMark, LogMarkKind};
pub use place::{LogHome, TrackFix};
pub use rc::{LogSticks, StickFrame};
pub use sample::{LogAttitude, LogSample, MAX_MOTORS};
pub use signal::{Extent, LogSignal, SignalFrame};
