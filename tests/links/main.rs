//! Protocols, sockets, sessions and files in this process.

mod files;
mod fuzz_corpus;
mod protocols;
mod session;
