//! Protocols, sockets, sessions and files in this process.

mod files;
mod protocols;
mod session;
