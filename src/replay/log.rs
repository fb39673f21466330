//! Blackbox logs as flights that are over.
//!
//! `file` is a file of logs, `flight` one of them, `about` describes it. `picture` shows a sample of a log as the firmware of its craft would report
//! it, `happenings` turns the marks of a log into events.

mod about;
mod file;
mod flight;
mod happenings;
mod picture;

pub use about::{log_assumptions, log_end_notices};
pub use file::LogFlights;
