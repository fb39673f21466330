//! Protocols without sockets: bytes and times in, frames and bytes out. No I/O, no clock, bounded memory, no panic
//! on any input.

mod between_frames;
pub mod command_line;
pub mod command_message;
pub mod fdm;
pub mod fdm_link;
pub mod first_line;
pub mod line_editor;
pub mod rc;
pub mod serial_session;
pub mod servo;
pub mod sitl_feed;
