//! Recordings of this program as flights that are over, shown by their pictures.
//!
//! `file` is a file with a recording, `flight` its flight. `bytes` reads the file from its beginning to its end.

mod bytes;
mod file;
mod flight;
#[cfg(test)]
mod tests;

pub use file::RecordedFlights;
