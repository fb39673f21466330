//! The links: packets, streams and ports.

mod at_rest;
mod cli_vectors;
mod codec;
mod doors;
mod environment;
mod fc_client;
mod fc_streams;
mod fdm;
mod sitl;
