//! Pages and files for others against the code.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may stop and say what it expects")]

mod deploy;
mod record_docs;
