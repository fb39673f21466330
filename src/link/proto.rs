//! Protocols without sockets: bytes and times in, frames and bytes out. No I/O, no clock, bounded memory, no panic
//! on any input.

mod command_message;
pub mod conversation;
pub mod fdm;
pub mod fdm_link;
pub mod msp;
pub mod rc;
pub mod servo;
