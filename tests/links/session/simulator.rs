//! A session with a craft that an external simulator moves: its time, its pictures and its keys.

#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests may panic and wait")]

mod faults;
mod rig;
mod stalls;
mod time;
