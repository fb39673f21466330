//! Reports of a flight: JSON lines, CSV rows, sentences, tracks, pages.
//!
//! This module turns events and snapshots into text; the caller decides where the text goes.
//!
//! * During a flight: `json` and `sentence` for events, `csv` for samples, `gpx` and `track` for places.
//! * After it: `record` keeps what a report needs, `flight` is all that it says about a flight as plain data, with its
//!   tables and pictures, and `html` makes pages of it. `plot` draws maps and charts as SVG.
//! * About several flights: `check` has the results of scenarios, `compare` those of two firmwares, `lab` those of a
//!   programme on them, `campaign` the lines
//!   and the answer of a campaign, `sweep` a flight with a fault at every second, `flights` the list of recordings.
//! * About files: `conversion` is the loss report of `convert`, `log_export` writes logs as CSV and tracks.

pub mod campaign;
pub mod check;
pub mod compare;
pub mod conversion;
pub mod csv;
pub mod end;
pub mod flight;
pub mod flights;
pub mod gpx;
pub mod html;
pub mod json;
pub mod lab;
pub mod log_export;
mod markdown;
mod number;
mod plot;
mod record;
pub mod route;
pub mod sentence;
pub mod sweep;
pub mod track;
pub mod truth;
mod xml;

pub use csv::CsvWriter;
pub use end::End;
pub use gpx::{GpxHeader, GpxPoint, GpxWriter, UtcSeconds};
pub use record::{Boot, FlightRecord, RecordedSample, Transition};
pub use track::{Track, TrackPoint};
