//! A blackbox log as a table and as tracks.
//!
//! Times of tracks are UTC if the log has its date. Otherwise the craft counts as booted at the instant at which simulated
//! flights boot.

mod csv;
mod date;
mod number;
#[cfg(test)]
mod tests;
mod track;

pub use csv::{TableEnd, write_csv};
pub use track::{log_gpx, log_track};
