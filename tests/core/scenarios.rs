//! Scenarios through the library: the built-in ones, the repeatability of flights and the guarantees of the language.
//! Each of the guide's scenarios must fail if something is wrong with the craft.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may stop and say what it expects")]

mod docs;
mod faults;
mod language;
mod master;
mod repeat;
mod rig;
mod texts;
