//! Blackbox logs: the flight recordings of Betaflight, as bytes.
//!
//! `field` names the frames, their fields and how each field is predicted and encoded, `event` the events between frames.
//! A log begins with a header of text lines, which define the fields. Binary frames without separators follow. Several
//! logs may follow each other in one file. `encode` writes logs, `decode` reads them.
//!
//! Nothing here does I/O.

pub mod decode;
pub mod encode;

mod event;
mod field;

pub use event::{AdjustedValue, LogEvent};
pub use field::{Encoding, Field, FrameKind, Predictor};

/// The first line of every log, without its line feed.
pub const FIRST_LINE: &str = "H Product:Blackbox flight data recorder by Nicholas Sherlock";
