//! Scenarios through the library: the built-in ones, that flights repeat, what the language promises, and that each of the
//! guide's scenarios fails when something is wrong with the craft.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may stop and say what it expects")]

mod faults;
mod language;
mod repeat;
mod rig;
