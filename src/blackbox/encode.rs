//! Encoding of logs: the header's field lines, frames and events.
//!
//! [`LogLayout`] names the fields of a log. [`LogEncoder`] predicts their values from the frames before and writes the
//! differences into a [`LogBuffer`]. Nothing here allocates.

mod buffer;
mod event;
mod frame;
mod group;
mod layout;
mod tag;

pub use buffer::{CAPACITY, LogBuffer, LogWriter};
pub use frame::{FrameValues, LogEncoder};
pub use group::{Coding, FieldGroup, Rule};
pub use layout::{FieldLine, LogConstants, LogLayout, MAX_FIELDS};
