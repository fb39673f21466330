//! What a flight leaves behind: JSON lines, sentences, a GPX track.
//!
//! Everything here turns events and snapshots into text; where the text goes is the caller's affair.

pub mod check;
pub mod compare;
pub mod end;
pub mod gpx;
pub mod json;
mod number;
pub mod sentence;
pub mod truth;
mod xml;

pub use end::End;
pub use gpx::{GpxHeader, GpxPoint, GpxWriter, UtcSeconds};
