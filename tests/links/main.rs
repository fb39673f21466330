//! The links: packets, streams and ports.

mod at_rest;
#[path = "../serial_support/cable.rs"]
mod cable;
mod codec;
mod doors;
mod fc_client;
mod fc_streams;
mod fdm;
mod sitl;
