//! Reports of a flight: JSON lines, CSV rows, sentences, tracks.
//!
//! This module turns events and snapshots into text; the caller decides where the text goes.

pub mod campaign;
pub mod check;
pub mod compare;
pub mod conversion;
pub mod csv;
pub mod end;
pub mod gpx;
pub mod json;
pub mod log_export;
mod number;
pub mod sentence;
pub mod track;
pub mod truth;
mod xml;

pub use csv::CsvWriter;
pub use end::End;
pub use gpx::{GpxHeader, GpxPoint, GpxWriter, UtcSeconds};
pub use track::{Track, TrackPoint};
