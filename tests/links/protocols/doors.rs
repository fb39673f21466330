//! The doors over real sockets, with a craft that answers as the session does. The system chooses the ports.

#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests may panic and wait")]

mod browsers;
mod clients;
mod harness;
mod packets;
mod strangers;
