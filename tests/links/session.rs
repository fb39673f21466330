//! A session: its clients, its simulator, and its requests.

mod doors;
mod replay;
mod requests;
mod simulator;
