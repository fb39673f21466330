//! Recorded flights as bytes: what is needed to fly one again, and pictures of it for any other version.
//!
//! ```text
//!   gzip members        ┌── header, setup ──┬── inputs ──┬── events, pictures, checks … ──┬── end ──┐
//!   lines of JSON       {"flight":…}        {"input":…}   {"picture":…}                    {"end":…}
//! ```
//!
//! A file is a sequence of gzip members with one JSON object a line, so that `zcat` shows it. Each kind of line is a
//! `Record`. A file that was cut short is readable up to its last whole line. [`Writer`] makes the bytes, [`Recording`] is
//! what a reader keeps of them within bounds, and [`Repeat`] flies it again: the same program, started the same way and
//! given the same inputs before the same ticks, flies the same to the last bit. A recording that flies differently, that
//! another version wrote, or whose firmware was remote, is shown by its pictures.
//!
//! Like the rest of the core, nothing here reads a file or a clock.

mod ending;
mod error;
mod event;
mod fingerprint;
mod input;
mod lines;
mod number;
mod picture;
mod read;
mod record;
mod recorder;
mod repeat;
mod setup;
mod summary;
#[cfg(test)]
mod tests;
mod write;

pub use ending::Ending;
pub use error::ReadError;
pub use event::{Happened, RecordedEvent};
pub use fingerprint::{Fingerprint, FlightPrint};
pub use lines::Rest;
pub use picture::{Cadence, Picture, Pictures, Seen};
pub use read::{Recording, read_setup};
pub use record::{End, FORMAT, Header};
pub use recorder::{Recorder, RecordingSink};
pub use repeat::Repeat;
pub use setup::Setup;
pub use summary::{Listed, Summary, TAIL, read_summary, seen_s};
pub use write::Writer;
