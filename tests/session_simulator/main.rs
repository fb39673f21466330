//! A session whose craft an external simulator moves: whose time it is, what the picture shows, what keys do.

#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests may panic and wait")]

mod faults;
mod rig;
mod stalls;
mod time;
