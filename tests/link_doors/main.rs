//! The doors over real sockets, with a craft behind them that answers as the session does. Ports come from the system.

#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests may panic and wait")]

mod browsers;
mod clients;
mod harness;
mod packets;
mod strangers;
