//! What several test programs and benches use.

#![allow(clippy::disallowed_methods, reason = "a peer of the program waits by the clock")]

#[cfg(unix)]
mod bridge;
#[cfg(unix)]
mod cable;
mod free_port;
pub mod hex;
pub mod made_log;

use std::path::{Path, PathBuf};

#[cfg(unix)]
pub use bridge::Bridge;
#[cfg(unix)]
pub use cable::Cable;
pub use free_port::free_port;
pub use made_log::MadeLog;

/// Returns the bytes of an MSP frame.
pub fn msp_bytes(frame: &betadeck_core::msp::Frame) -> Vec<u8> {
    let mut bytes = Vec::new();
    frame.encode(&mut bytes);
    bytes
}

/// Returns the path of a file or folder of the project.
pub fn path(name: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join(name)
}

/// Returns the text of a file of the project.
///
/// # Panics
/// Panics if the file cannot be read.
#[track_caller]
pub fn text(name: &str) -> String {
    std::fs::read_to_string(path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}
